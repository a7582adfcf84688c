#include "engine/scene/streaming/terrain_surface.h"

#include "engine/core/check.h"
#include "engine/terrain/mesh/tile_layout.h"

namespace reljef::scene {
namespace {

std::shared_ptr<const TerrainTile> borrowing_tile(const terrain::Tile& samples) {
    TerrainTile tile;
    tile.id = {0, samples.col / terrain::tile_cells, samples.row / terrain::tile_cells};
    tile.bounds = samples.bounds;
    tile.cells = {samples.cols, samples.rows};
    tile.borrows = true;
    return std::make_shared<const TerrainTile>(std::move(tile));
}

} // namespace

TerrainSurface::TerrainSurface(std::shared_ptr<const terrain::Terrain> terrain,
                               terrain::Placement placement, terrain::ColorRamp ramp)
    : terrain_(std::move(terrain)), placement_(std::move(placement)), ramp_(std::move(ramp)),
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
    return TerrainSurface(std::move(terrain), std::move(*placement), options.ramp);
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

} // namespace reljef::scene
