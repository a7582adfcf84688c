#include "engine/render/shaders/technique_support.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>

#include <fmt/format.h>

#include "engine/render/shaders/bindings.h"

namespace reljef::render {
namespace {

struct GlVersion {
    int major = 0;
    int minor = 0;
    friend auto operator<=>(const GlVersion&, const GlVersion&) = default;
};
constexpr GlVersion shader_version{4, 5};

// Of "4.5 (Core Profile) Mesa 22.3.6"; 0.0 if it has no such form.
GlVersion version_of(const std::string& text) {
    GlVersion version;
    const char* const end = text.data() + text.size();
    const auto major = std::from_chars(text.data(), end, version.major);
    if (major.ptr != end && *major.ptr == '.') {
        std::from_chars(major.ptr + 1, end, version.minor);
    }
    return version;
}

// The highest unit in its shaders: relief*.glsl, tile_light.glsl, terrain.frag.
unsigned int last_texture_unit(scene::TechniqueId id, bool is_mesh) {
    if (id == scene::TechniqueId::prewarp) {
        return is_mesh ? bindings::warped_map_unit : bindings::warped_places_unit;
    }
    if (id == scene::TechniqueId::cone) {
        return is_mesh ? bindings::cone_map_unit : bindings::relief_cone_map_unit;
    }
    if (scene::searches_layers(id)) {
        return bindings::normal_map_v_unit;
    }
    if (is_mesh) {
        const bool is_plain =
            id == scene::TechniqueId::texture || id == scene::TechniqueId::polygons;
        return is_plain ? bindings::height_map_unit : bindings::normal_map_unit;
    }
    if (id == scene::TechniqueId::exact) {
        return bindings::clear_heights_unit;
    }
    return scene::geometry_of(id) == scene::Geometry::box ? bindings::sun_map_unit
                                                          : bindings::lit_map_unit;
}

// Longest side of the maps with the heights, which cannot be reduced; 0 for triangles.
int max_map_side(scene::TechniqueId id, const DrawnSurface& surface) {
    const bool has_map = surface.is_mesh || scene::geometry_of(id) == scene::Geometry::box ||
                         id == scene::TechniqueId::prewarp;
    const int side = has_map ? std::max(surface.samples.x, surface.samples.y) : 0;
    return id == scene::TechniqueId::exact
               ? static_cast<int>(std::bit_ceil(static_cast<unsigned>(side)))
               : side;
}

bool draws(scene::TechniqueId id, bool is_mesh) {
    return is_mesh ? scene::draws_any_mesh(id) : scene::draws_terrain(id);
}

Result<void> check_surface(const scene::Technique& technique, const DrawnSurface& surface,
                           const gl::Limits& limits) {
    const auto lack = missing_support(technique.id(), surface, limits);
    if (!lack) {
        return {};
    }
    const auto nearest = nearest_technique(technique.id(), surface, limits);
    return Error{
        fmt::format("technique {}: {}; {}", scene::technique_info(technique.id()).name, *lack,
                    nearest ? fmt::format("{} works here", scene::technique_info(*nearest).name)
                            : std::string("no technique works here"))};
}

DrawnSurface surface_of(const scene::TerrainNode& terrain) {
    const Grid<float>& heights = terrain.surface->heightfield().heights;
    return {false, {heights.cols(), heights.rows()}};
}

} // namespace

std::optional<std::string> missing_support(scene::TechniqueId id, const DrawnSurface& surface,
                                           const gl::Limits& limits) {
    if (version_of(limits.version) < shader_version) {
        return fmt::format("OpenGL {} found, 4.5 was expected", limits.version);
    }
    const int units = static_cast<int>(last_texture_unit(id, surface.is_mesh)) + 1;
    const int max_units = std::min(limits.max_texture_units, limits.max_fragment_texture_units);
    if (units > max_units) {
        return fmt::format("{} texture units found, {} were expected", max_units, units);
    }
    const int side = max_map_side(id, surface);
    if (side > limits.max_texture_size) {
        return fmt::format("heights of {} x {} samples found, which take a texture {} wide, at "
                           "most {} was expected",
                           surface.samples.x, surface.samples.y, side, limits.max_texture_size);
    }
    return std::nullopt;
}

std::optional<scene::TechniqueId>
nearest_technique(scene::TechniqueId id, const DrawnSurface& surface, const gl::Limits& limits) {
    const auto catalogue = scene::technique_catalogue();
    const auto own = std::find_if(catalogue.begin(), catalogue.end(),
                                  [&](const scene::TechniqueInfo& info) { return info.id == id; }) -
                     catalogue.begin();
    const auto count = static_cast<std::ptrdiff_t>(catalogue.size());
    for (std::ptrdiff_t away = 1; away < count; ++away) {
        for (const std::ptrdiff_t place : {own - away, own + away}) {
            if (place < 0 || place >= count) {
                continue;
            }
            const scene::TechniqueId other = catalogue[static_cast<std::size_t>(place)].id;
            if (draws(other, surface.is_mesh) && !missing_support(other, surface, limits)) {
                return other;
            }
        }
    }
    return std::nullopt;
}

Result<void> check_support(const view::DrawList& list, const gl::Limits& limits) {
    Result<void> good;
    for (const view::TerrainDraw& draw : list.terrains) {
        const DrawnSurface surface = surface_of(*draw.terrain);
        good = good ? check_surface(draw.terrain->material.technique, surface, limits) : good;
        good = good && draw.search ? check_surface(draw.search->technique, surface, limits) : good;
    }
    for (const view::MeshDraw& draw : list.meshes) {
        const scene::Material& material = draw.mesh->material;
        if (good && material.detail.set != nullptr) {
            const Grid<float>& heights = material.detail.set->heights;
            good =
                check_surface(material.technique, {true, {heights.cols(), heights.rows()}}, limits);
        }
    }
    return good;
}

} // namespace reljef::render
