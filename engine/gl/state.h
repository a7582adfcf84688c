#pragma once

#include <glm/vec2.hpp>

namespace reljef::gl {

/// With reversed depth the nearer fragment has the greater depth.
enum class DepthTest { off, greater, greater_or_equal };
enum class Culling { none, back, front };
enum class PolygonMode { fill, line };

/// Clip depth runs from 1 (near) to 0 (far): glClipControl(lower left, 0..1), cleared to 0, tested
/// with DepthTest::greater, written.
void set_reversed_depth();

/// Off also turns depth writing off, as GL does.
void set_depth_test(DepthTest test);
void set_depth_writing(bool on);
/// Front faces are counter-clockwise on the screen.
void set_culling(Culling culling);
void set_polygon_mode(PolygonMode mode);
/// Moves filled polygons away from the eye (reversed depth), so that lines drawn over them show;
/// 0, 0 turns it off.
void set_polygon_offset(float slope_factor, float units);
/// Straight alpha over what is there.
void set_blending(bool on);
/// Runs the fragment shader for each sample of a pixel, its inputs taken there, instead of once for
/// the pixel. Changes nothing where a pixel has one sample.
void set_sample_shading(bool on);
/// Pixels, the origin at the lower left.
void set_viewport(glm::ivec2 origin, glm::ivec2 size);

} // namespace reljef::gl
