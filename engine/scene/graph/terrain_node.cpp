#include "engine/scene/graph/terrain_node.h"

#include <fmt/format.h>

#include "engine/terrain/mesh/tile_layout.h"

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

std::shared_ptr<const TerrainTile> borrowing_tile(const terrain::Tile& samples) {
    TerrainTile tile;
    tile.id = {0, samples.col / terrain::tile_cells, samples.row / terrain::tile_cells};
    tile.bounds = samples.bounds;
    tile.cells = {samples.cols, samples.rows};
    tile.borrows = true;
    return std::make_shared<const TerrainTile>(std::move(tile));
}

bool shows_detail(TechniqueId id) {
    return id != TechniqueId::polygons && id != TechniqueId::displacement &&
           id != TechniqueId::prewarp && !searches_layers(id);
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

TerrainSurface::TerrainSurface(std::shared_ptr<const terrain::Terrain> terrain,
                               terrain::Placement placement)
    : terrain_(std::move(terrain)), placement_(std::move(placement)),
      pyramid_(terrain_->heightfield.heights.view()) {
    const terrain::Heightfield& heightfield = terrain_->heightfield;
    for (const terrain::Tile& tile : terrain::tile_layout(heightfield, placement_)) {
        tiles_.push_back(borrowing_tile(tile));
        bounds_.add(tile.bounds);
    }
    const double height = terrain::reference_height(heightfield);
    for (const terrain::Tile& tile : terrain::flat_tile_layout(heightfield, placement_, height)) {
        flat_bounds_.push_back(tile.bounds);
    }
}

Result<TerrainSurface> TerrainSurface::create(std::shared_ptr<const terrain::Terrain> terrain,
                                              const TerrainOptions& options) {
    check(terrain != nullptr && terrain->heightfield.heights.cols() >= 2 &&
              terrain->heightfield.heights.rows() >= 2,
          "a terrain surface needs at least 2x2 heights");
    const terrain::Heightfield& heightfield = terrain->heightfield;
    const auto by_data = heightfield.georeference ? terrain::PlacementKind::ellipsoid
                                                  : terrain::PlacementKind::plane;
    auto placement = terrain::Placement::create(heightfield, options.placement.value_or(by_data),
                                                options.exaggeration);
    if (!placement) {
        return placement.error();
    }
    return TerrainSurface(std::move(terrain), std::move(*placement));
}

std::optional<double> TerrainSurface::height_at(double x, double y) const {
    const Grid<float>& heights = heightfield().heights;
    // On a curved Earth the vertical through (x, y) is not parallel to z. Each round looks up the
    // ground below the last guess, which divides the error by more than 100 within 100 km.
    const int rounds = placement_.kind() == terrain::PlacementKind::plane ? 1 : 8;
    double z = 0.0;
    for (int i = 0; i < rounds; ++i) {
        const auto sample = placement_.sample_from_world({x, y, z});
        if (!sample) {
            return std::nullopt;
        }
        const double height = terrain::bilinear_height(heights.view(), glm::dvec2(*sample));
        z = placement_.world_from_sample({sample->x, sample->y, height}).z;
    }
    // Whether the place is inside depends on the height of the ground.
    const auto sample = placement_.sample_from_world({x, y, z});
    if (!sample || sample->x < 0.0 || sample->y < 0.0 || sample->x > heights.cols() - 1 ||
        sample->y > heights.rows() - 1) {
        return std::nullopt;
    }
    return z;
}

std::optional<terrain::SurfaceHit> TerrainSurface::pick(const Ray& ray) const {
    return terrain::pick(heightfield().heights.view(), pyramid_, placement_, ray);
}

bool draws_tiles(const Technique& technique) {
    const auto* const polygons = std::get_if<Polygons>(&technique.parameters);
    return std::holds_alternative<Texture>(technique.parameters) ||
           searches_surface(technique.id()) || (polygons != nullptr && polygons->max_levels == 1);
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

} // namespace reljef::scene
