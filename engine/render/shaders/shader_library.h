#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string_view>

#include "engine/core/result.h"
#include "engine/gl/program.h"

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
    textured_terrain,
    relief_terrain,
    sky,
    average ///< of several pictures, in linear light
};

bool searches_for_surface(ShaderKind kind);

/// Preprocessor definitions of a shader variant.
enum ShaderFeature : std::uint32_t {
    feature_lit = 1U << 0U,
    feature_fog = 1U << 1U,
    feature_hit = 1U << 2U, ///< writes hits instead of colours
    // Relief search; linear steps without any of these.
    feature_exact = 1U << 3U,      ///< the true first hit
    feature_parallax = 1U << 4U,   ///< shifts by the height
    feature_bisect = 1U << 5U,     ///< steps, then bisection
    feature_secant = 1U << 6U,     ///< steps, then secants
    feature_limited = 1U << 7U,    ///< parallax with offset limiting
    feature_iterated = 1U << 8U,   ///< iterated parallax
    feature_view_steps = 1U << 9U, ///< the number of steps depends on the view angle
    // Relief options.
    feature_fade = 1U << 10U,         ///< reduces heights at grazing angles
    feature_hard_shadow = 1U << 11U,  ///< a binary shadow ray
    feature_soft_shadow = 1U << 12U,  ///< a shadow ray weighted by its depth below the surface
    feature_smooth_edges = 1U << 13U, ///< blends near misses
    feature_write_depth = 1U << 14U,  ///< writes the hit's depth instead of the box's
    feature_warped = 1U << 15U,       ///< shows prewarped places
    feature_cone = 1U << 16U,         ///< relief search: cone stepping
    // Lighting of a mesh with surface detail; the mesh's normals without any of these.
    feature_normal_map = 1U << 17U,
    feature_bump = 1U << 18U,
    feature_emboss = 1U << 19U,
    feature_wrap = 1U << 20U,   ///< the tile on a mesh repeats
    feature_beams = 1U << 21U,  ///< relief rays begin where their beam may hit
    feature_layers = 1U << 22U, ///< relief search: solids between layers
    feature_multisampled = 1U << 23U,
    feature_streamed = 1U << 24U, ///< relief over the tiles of a stream
    feature_curved = 1U << 25U,   ///< relief on the ellipsoid: view rays are bent
    feature_counting = 1U << 26U, ///< of a terrain: writes its work instead of colours
    feature_sliver = 1U << 27U,   ///< of a terrain: triangles from their corners (view::SliverView)
    feature_corner_depth = 1U << 28U, ///< of slivers: depth from their corners, too
    feature_overlay = 1U << 29U,      ///< of a terrain: grain and contours
    feature_facades = 1U << 30U,      ///< of an overlay
    feature_point_lights = 1U << 31U, ///< of terrains and meshes: scene::PointLight
};

struct ShaderVariant {
    ShaderKind kind = ShaderKind::terrain;
    std::uint32_t features = 0;

    friend auto operator<=>(const ShaderVariant&, const ShaderVariant&) = default;
};

/// The variant without features that have no effect. Hits have no light, fog, shadows, smooth edges
/// or samples. The sky has no fog. Sky and surface detail on terrains are never hit. A terrain's
/// light is in its map unless a relief casts shadows. Parallax follows no ray. Work is that of a
/// colour, whose air, depth and overlay cost no taps.
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
