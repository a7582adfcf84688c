#pragma once

namespace reljef::gl {

/// With reversed depth the nearer fragment has the greater depth.
enum class DepthTest { off, greater, greater_or_equal, always };
enum class Culling { none, back, front };
enum class PolygonMode { fill, line };

/// Sets clip depth from 1 (near) to 0 (far), clear depth 0, DepthTest::greater and depth writing.
void set_reversed_depth();

/// DepthTest::off also turns depth writing off, as GL does.
void set_depth_test(DepthTest test);
void set_depth_writing(bool on);
/// Front faces are counter-clockwise on the screen.
void set_culling(Culling culling);
void set_polygon_mode(PolygonMode mode);
/// Runs the fragment shader once per sample, with its inputs at the sample, instead of once per
/// pixel. No effect on a target with one sample per pixel.
void set_sample_shading(bool on);
/// Whether fragments add to the colours that are there instead of replacing them.
void set_adding(bool on);

} // namespace reljef::gl
