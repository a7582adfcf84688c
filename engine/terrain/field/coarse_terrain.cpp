#include "engine/terrain/field/coarse_terrain.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "engine/core/check.h"

namespace reljef::terrain {
namespace {

int coarse_side(int side, double shrink) {
    return std::clamp(static_cast<int>(side * shrink), 2, side);
}

geo::Georeference resampled(geo::Georeference georeference, glm::dvec2 factor) {
    geo::PixelAffine& affine = georeference.crs_from_pixel;
    affine.x_col *= factor.x;
    affine.y_col *= factor.x;
    affine.x_row *= factor.y;
    affine.y_row *= factor.y;
    georeference.geodetic = georeference.geodetic.resampled(factor);
    return georeference;
}

} // namespace

Terrain coarse_terrain(const Terrain& terrain, std::size_t max_samples) {
    const Heightfield& fine = terrain.heightfield;
    const glm::ivec2 size(fine.heights.cols(), fine.heights.rows());
    check(std::min(size.x, size.y) >= 2, "a coarse terrain needs 2 samples a side");
    const double shrink = std::min(1.0, std::sqrt(static_cast<double>(max_samples) /
                                                  static_cast<double>(fine.heights.size())));
    const glm::ivec2 coarse_size(coarse_side(size.x, shrink), coarse_side(size.y, shrink));
    const glm::dvec2 factor = glm::dvec2(size - 1) / glm::dvec2(coarse_size - 1);
    Terrain made;
    made.name = terrain.name;
    made.color = terrain.color;
    made.errors = terrain.errors;
    Heightfield& coarse = made.heightfield;
    coarse.heights = Grid<float>(coarse_size.x, coarse_size.y);
    coarse.void_mask = fine.void_mask.empty() ? Grid<std::uint8_t>()
                                              : Grid<std::uint8_t>(coarse_size.x, coarse_size.y);
    for (int row = 0; row < coarse_size.y; ++row) {
        for (int col = 0; col < coarse_size.x; ++col) {
            const glm::dvec2 place = glm::min(glm::dvec2(col, row) * factor, glm::dvec2(size - 1));
            coarse.heights(col, row) =
                static_cast<float>(bilinear_height(fine.heights.view(), place));
            if (!fine.void_mask.empty()) {
                const glm::ivec2 nearest(glm::round(place));
                coarse.void_mask(col, row) = fine.void_mask(nearest.x, nearest.y);
            }
        }
    }
    coarse.void_count = static_cast<std::size_t>(std::count(
        coarse.void_mask.samples().begin(), coarse.void_mask.samples().end(), std::uint8_t{1}));
    coarse.range = fine.range;
    coarse.spacing = fine.spacing * factor;
    coarse.reduction = fine.reduction * std::max(factor.x, factor.y);
    coarse.to_middle = fine.to_middle / factor;
    if (fine.georeference) {
        coarse.georeference = resampled(*fine.georeference, factor);
    }
    return made;
}

} // namespace reljef::terrain
