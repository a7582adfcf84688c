#include "engine/scene/graph/terrain_node.h"

#include <fmt/format.h>

#include "engine/scene/streaming/tile_stream.h"

namespace reljef::scene {
namespace {

Error for_meshes_only(TechniqueId id) {
    const bool moves = id == TechniqueId::displacement || searches_layers(id);
    return Error{fmt::format("technique {}: a terrain found, a mesh with a detail texture was "
                             "expected; {} {} a terrain by its heights",
                             technique_info(id).name,
                             searches_layers(id) ? "exact" : (moves ? "polygons" : "texture"),
                             moves ? "shapes" : "lights")};
}

// The option or placement that excludes a terrain, and why; empty if there is none.
std::string_view reason_against_terrain(const Technique& technique, const TerrainSurface& surface) {
    if (technique.options.two_sided) {
        return "sides=two found, sides=one was expected: a terrain is not seen from beneath, "
               "detail tiles are";
    }
    if (technique.options.true_silhouettes) {
        return "silhouettes=true found, none was expected: a terrain has its own, detail tiles on "
               "meshes have not";
    }
    if (technique.options.border) {
        return "option 'border' found, none was expected: a terrain ends at its border, detail "
               "tiles go on";
    }
    const bool is_bent = surface.placement().kind() != terrain::PlacementKind::plane;
    return needs_plane(technique.id()) && is_bent
               ? "placement ellipsoid found, plane was expected; relief draws both"
               : std::string_view();
}

bool shows_detail(TechniqueId id) {
    return !draws_triangles(id) && id != TechniqueId::displacement && id != TechniqueId::prewarp &&
           !searches_layers(id);
}

bool has_foreign_options(const TechniqueOptions& options) {
    TechniqueOptions allowed;
    allowed.steps = options.steps;
    allowed.shadow = options.shadow;
    return options != allowed;
}

} // namespace

SurfaceDetail visible_detail(const Material& material) {
    SurfaceDetail detail = material.detail;
    detail.border = material.technique.options.border.value_or(detail.border);
    return detail;
}

bool is_seen_from_behind(const Material& material) {
    return material.detail.set != nullptr && is_two_sided(material.technique);
}

double triangle_bound(const TerrainNode& terrain, const Technique& technique) {
    const auto* const polygons = std::get_if<Polygons>(&technique.parameters);
    const bool draws_all = polygons != nullptr && polygons->error == 0.0 &&
                           polygons->max_levels == 1 && terrain.stream == nullptr;
    return draws_all && terrain.surface->heightfield().heights.size() > terrain.max_vertices
               ? bound_for_many_samples
               : error_bound(technique);
}

bool shows_heights(const Technique& technique) {
    const TechniqueId id = technique.id();
    return (draws_triangles(id) || searches_surface(id)) && !technique.options.fade &&
           id != TechniqueId::parallax && id != TechniqueId::parallax_limited &&
           id != TechniqueId::parallax_iterated;
}

bool draws_tiles(const Technique& technique) {
    const auto* const polygons = std::get_if<Polygons>(&technique.parameters);
    return std::holds_alternative<Texture>(technique.parameters) ||
           technique.id() == TechniqueId::automatic || searches_surface(technique.id()) ||
           (polygons != nullptr && polygons->max_levels == 1);
}

Result<void> check_technique(const Technique& technique, const TerrainSurface& surface) {
    if (!draws_terrain(technique.id())) {
        return for_meshes_only(technique.id());
    }
    const std::string_view reason = reason_against_terrain(technique, surface);
    return reason.empty() ? Result<void>()
                          : Error{fmt::format("technique {}: {}",
                                              technique_info(technique.id()).name, reason)};
}

Result<void> check_terrain_detail_technique(const Technique& technique) {
    if (!shows_detail(technique.id())) {
        return Error{fmt::format("technique {}: a detail texture on a terrain found, a mesh was "
                                 "expected; normal, relief and exact show both",
                                 technique_info(technique.id()).name)};
    }
    if (has_foreign_options(technique.options)) {
        return Error{fmt::format("technique {}: a detail texture on a terrain found with an option "
                                 "that only meshes have, none beside steps and shadow was expected",
                                 to_string(technique))};
    }
    return {};
}

std::optional<double> height_at(const TerrainNode& terrain, double x, double y) {
    auto z = terrain.surface->height_at(x, y);
    constexpr int rounds = 3; // see TerrainSurface::height_at
    for (int i = 0; z && terrain.stream != nullptr && i < rounds; ++i) {
        const terrain::Placement& placement = terrain.surface->placement();
        const auto sample = placement.sample_from_world({x, y, *z});
        const auto found = sample ? terrain.stream->finest_at(glm::dvec2(*sample)) : std::nullopt;
        if (!found) {
            return z;
        }
        const double height =
            terrain::bilinear_height(found->tile->heightfield.heights.view(), found->place);
        z = placement.world_from_sample({sample->x, sample->y, height}).z;
    }
    return z;
}

} // namespace reljef::scene
