#include "engine/scene/streaming/terrain_surface.h"

#include "engine/core/check.h"
#include "engine/terrain/mesh/tile_layout.h"

namespace reljef::scene {
namespace {

std::shared_ptr<const TerrainTile> borrowing_tile(const terrain::TileCells& cells,
                                                  const Box& bounds, bool is_proven) {
    TerrainTile tile;
    tile.is_proven = is_proven;
    const glm::ivec2 place = cells.first / terrain::tile_cells;
    tile.id = {0, place.x, place.y};
    tile.bounds = bounds;
    tile.first = cells.first;
    tile.cells = cells.count;
    tile.borrows = true;
    return std::make_shared<const TerrainTile>(std::move(tile));
}

} // namespace

TerrainSurface::TerrainSurface(std::shared_ptr<const terrain::Terrain> terrain,
                               terrain::Placement placement, const TerrainOptions& options)
    : terrain_(std::move(terrain)), placement_(std::move(placement)), ramp_(options.ramp),
      imagery_share_(options.imagery_share), overlay_(options.overlay),
      pyramid_(terrain_->heightfield.heights.view()) {
    const terrain::Heightfield& heightfield = terrain_->heightfield;
    const double flat = terrain::reference_height(heightfield);
    const glm::ivec2 last(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1);
    for (const terrain::TileCells& cells : terrain::tile_layout(last)) {
        const auto bounds_at = [&](terrain::HeightRange range) {
            return terrain::placed_bounds(placement_, glm::dvec2(cells.first),
                                          glm::dvec2(cells.last()), range);
        };
        const terrain::MinMax range = pyramid_.bounds(cells.first, cells.last() - 1);
        const Box bounds = bounds_at({range.low, range.high});
        tiles_.push_back(borrowing_tile(cells, bounds, has_all_samples()));
        bounds_.add(bounds);
        flat_bounds_.push_back(bounds_at({flat, flat}));
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
    return TerrainSurface(std::move(terrain), std::move(*placement), options);
}

Result<TerrainSurface> TerrainSurface::exaggerated(double factor) const {
    TerrainOptions other = options();
    other.exaggeration = factor;
    return changed(other);
}

TerrainOptions TerrainSurface::options() const {
    return {placement_.kind(), placement_.exaggeration(), ramp_, imagery_share_, overlay_};
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
