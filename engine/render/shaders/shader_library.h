#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/result.h"
#include "engine/gl/program.h"
#include "engine/scene/graph/surface_shader.h"

namespace reljef::render {

struct EmbeddedShader {
    std::string_view name;
    std::string_view text;
};
std::span<const EmbeddedShader> embedded_shaders();

enum class ShaderKind {
    terrain,
    relief,
    beams, ///< free height of a relief's rays, per block of pixels
    mesh,  ///< of one colour
    textured_mesh,
    relief_mesh, ///< with a relief search per pixel
    relief_hull, ///< the same in a hull around the mesh
    sun_depth,   ///< of a mesh, as the sun sees it
    textured_terrain,
    relief_terrain,
    sky,
    average ///< of several pictures, in linear light
};

bool searches_for_surface(ShaderKind kind);

/// Preprocessor definitions of a shader variant, as a sum of those below.
using ShaderFeatures = std::uint64_t;

inline constexpr ShaderFeatures feature_lit = 1ULL << 0U;
inline constexpr ShaderFeatures feature_fog = 1ULL << 1U;
inline constexpr ShaderFeatures feature_hit = 1ULL << 2U; ///< writes hits instead of colours
// Relief search; linear steps without any of these.
inline constexpr ShaderFeatures feature_exact = 1ULL << 3U;    ///< the true first hit
inline constexpr ShaderFeatures feature_parallax = 1ULL << 4U; ///< shifts by the height
inline constexpr ShaderFeatures feature_bisect = 1ULL << 5U;   ///< steps, then bisection
inline constexpr ShaderFeatures feature_secant = 1ULL << 6U;   ///< steps, then secants
inline constexpr ShaderFeatures feature_limited = 1ULL << 7U;  ///< parallax with offset limiting
inline constexpr ShaderFeatures feature_iterated = 1ULL << 8U; ///< iterated parallax
/// The number of steps depends on the view angle.
inline constexpr ShaderFeatures feature_view_steps = 1ULL << 9U;
// Relief options.
inline constexpr ShaderFeatures feature_fade = 1ULL << 10U; ///< reduces heights at grazing angles
inline constexpr ShaderFeatures feature_hard_shadow = 1ULL << 11U; ///< a binary shadow ray
/// A shadow ray weighted by its depth below the surface.
inline constexpr ShaderFeatures feature_soft_shadow = 1ULL << 12U;
inline constexpr ShaderFeatures feature_smooth_edges = 1ULL << 13U; ///< blends near misses
/// Writes the hit's depth instead of the box's.
inline constexpr ShaderFeatures feature_write_depth = 1ULL << 14U;
inline constexpr ShaderFeatures feature_warped = 1ULL << 15U; ///< shows prewarped places
inline constexpr ShaderFeatures feature_cone = 1ULL << 16U;   ///< relief search: cone stepping
// Lighting of a mesh with surface detail; the mesh's normals without any of these.
inline constexpr ShaderFeatures feature_normal_map = 1ULL << 17U;
inline constexpr ShaderFeatures feature_bump = 1ULL << 18U;
inline constexpr ShaderFeatures feature_emboss = 1ULL << 19U;
inline constexpr ShaderFeatures feature_wrap = 1ULL << 20U; ///< the tile on a mesh repeats
/// Relief rays begin where their beam may hit.
inline constexpr ShaderFeatures feature_beams = 1ULL << 21U;
/// Relief search: solids between layers.
inline constexpr ShaderFeatures feature_layers = 1ULL << 22U;
inline constexpr ShaderFeatures feature_multisampled = 1ULL << 23U;
/// Relief over the tiles of a stream.
inline constexpr ShaderFeatures feature_streamed = 1ULL << 24U;
/// Relief on the ellipsoid: view rays are bent.
inline constexpr ShaderFeatures feature_curved = 1ULL << 25U;
/// Of a terrain: writes its work instead of colours.
inline constexpr ShaderFeatures feature_counting = 1ULL << 26U;
/// Of a terrain: triangles from their corners (view::SliverView).
inline constexpr ShaderFeatures feature_sliver = 1ULL << 27U;
/// Of slivers: depth from their corners, too.
inline constexpr ShaderFeatures feature_corner_depth = 1ULL << 28U;
inline constexpr ShaderFeatures feature_overlay = 1ULL << 29U; ///< of a terrain: grain and contours
inline constexpr ShaderFeatures feature_facades = 1ULL << 30U; ///< of an overlay
/// Of terrains and meshes: scene::PointLight.
inline constexpr ShaderFeatures feature_point_lights = 1ULL << 31U;
/// Of meshes, and of terrains that cast shadows: meshes hide the sun (render::SunMap). It has a map
/// of its own on triangles, and ground hides it from them and from meshes (render::GroundShadow).
inline constexpr ShaderFeatures feature_mesh_shadows = 1ULL << 32U;
inline constexpr ShaderFeatures feature_sky_picture = 1ULL << 33U; ///< the sky is a picture
/// Of bent view rays: polynomials of degree 4 instead of 3 (view::RayCourse::needs_quartic).
inline constexpr ShaderFeatures feature_quartic = 1ULL << 34U;
/// Of bent rays: places are mapped one by one, without beams (view::DegreeCourse).
inline constexpr ShaderFeatures feature_degrees = 1ULL << 35U;

struct ShaderVariant {
    ShaderKind kind = ShaderKind::terrain;
    ShaderFeatures features = 0;
    std::shared_ptr<const scene::SurfaceShader> surface = {}; ///< of a material, for colours
    std::string constants = {}; ///< names of those that the material sets: others keep their values

    friend auto operator<=>(const ShaderVariant&, const ShaderVariant&) = default;
};

/// The variant without features that have no effect. Hits have no light, fog, shadows, smooth edges
/// or samples. The sky has no fog. Sky and surface detail on terrains are never hit. A terrain's
/// light is in its map unless a relief casts shadows. Parallax follows no ray. Work is that of a
/// colour, whose air, depth and overlay cost no taps. Only colours have surface shaders.
ShaderVariant canonical_variant(ShaderVariant variant);

/// Programs by variant, compiled on first use. Needs a current context.
class ShaderLibrary {
public:
    /// Files in `folder` override the built-in ones; the path may be empty.
    explicit ShaderLibrary(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}

    /// Valid as long as the library. Fails with file and line when the program does not compile,
    /// and on a missing file.
    Result<gl::Program*> program(ShaderVariant variant);

private:
    std::filesystem::path folder_;
    std::map<ShaderVariant, gl::Program> programs_;
};

} // namespace reljef::render
