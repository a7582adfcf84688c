#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/gl/program.h"

namespace reljef::render {

/// One file of shaders/ as built into the program.
struct EmbeddedShader {
    std::string_view name;
    std::string_view text;
};
std::span<const EmbeddedShader> embedded_shaders();

/// What is drawn.
enum class ShaderKind {
    terrain,
    relief,
    beams,            ///< how far a relief's rays meet nothing, by blocks of pixels
    mesh,             ///< of one colour
    textured_mesh,    ///< with a tile of detail on it
    relief_mesh,      ///< each pixel looks for the tile's surface
    relief_hull,      ///< the same in a hull around the mesh
    textured_terrain, ///< a terrain with a tile of detail on it
    relief_terrain,   ///< each pixel looks for the tile's surface
    sky,
    average ///< of several pictures, in linear light
};

/// Whether each pixel looks for the surface that it shows along a ray.
bool searches_for_surface(ShaderKind kind);

/// What a variant of a shader is compiled with; a scene that lacks it never pays for it.
enum ShaderFeature : std::uint32_t {
    feature_lit = 1U << 0U, ///< there is a sun
    feature_fog = 1U << 1U, ///< there is air
    feature_hit = 1U << 2U, ///< writes the hit instead of the colour
    // How a relief looks for its surface; steps alone where none of these is there.
    feature_exact = 1U << 3U,      ///< the true first hit
    feature_parallax = 1U << 4U,   ///< shifted by the height
    feature_bisect = 1U << 5U,     ///< steps, then halving
    feature_secant = 1U << 6U,     ///< steps, then chords
    feature_limited = 1U << 7U,    ///< parallax: by no more than the height
    feature_iterated = 1U << 8U,   ///< parallax: looked at again
    feature_view_steps = 1U << 9U, ///< equal steps: as many as the angle of view asks for
    // What a relief does beside.
    feature_fade = 1U << 10U,         ///< less height at flat angles of view
    feature_hard_shadow = 1U << 11U,  ///< a ray to the sun: lit or not
    feature_soft_shadow = 1U << 12U,  ///< a ray to the sun: lit by how deep it goes
    feature_smooth_edges = 1U << 13U, ///< near misses are blended in
    feature_write_depth = 1U << 14U,  ///< the depth of the hit, not of the box
    feature_warped = 1U << 15U,       ///< shows the places that were warped onto it
    feature_cone = 1U << 16U,         ///< how a relief looks: from cone to cone
    // How a mesh with a tile of detail is lit; by its own normals where none of the three is there.
    feature_normal_map = 1U << 17U,
    feature_bump = 1U << 18U,
    feature_emboss = 1U << 19U,
    feature_wrap = 1U << 20U,         ///< a mesh: the tile goes on in copies of itself
    feature_beams = 1U << 21U,        ///< a relief: rays begin where their beam may meet something
    feature_layers = 1U << 22U,       ///< how a mesh's relief looks: for solids between layers
    feature_multisampled = 1U << 23U, ///< pixels have several samples
};

struct ShaderVariant {
    ShaderKind kind = ShaderKind::terrain;
    std::uint32_t features = 0;

    friend auto operator<=>(const ShaderVariant&, const ShaderVariant&) = default;
};

/// The variant without the features that mean nothing to it: a hit has neither light nor fog, the
/// sky is not seen through air, it and tiles of detail on terrains are never hit, a terrain's light
/// is in its map unless a relief casts shadows; parallax follows no ray, and a hit has neither
/// shadow nor smooth edges, and is that of a pixel's middle.
ShaderVariant without_meaningless(ShaderVariant variant);

/// Every variant that means something, each once.
std::vector<ShaderVariant> all_variants();

/// Programs by variant, compiled when first asked for. Needs a current context.
class ShaderLibrary {
public:
    /// Files in `folder` come before the embedded ones; an empty path: only those.
    explicit ShaderLibrary(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}

    /// The program of a variant. Fails with the file and line where it does not compile, or when a
    /// file is missing. Valid as long as the library.
    Result<gl::Program*> program(ShaderVariant variant);

private:
    std::filesystem::path folder_;
    std::map<ShaderVariant, gl::Program> programs_;
};

} // namespace reljef::render
