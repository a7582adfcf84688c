#include "engine/io/raster/placed_heightfield.h"

#include <algorithm>
#include <utility>

#include "engine/io/raster/globe.h"

namespace reljef::io {
namespace {

template <class T> void flip(Grid<T>& grid, const Place& place) {
    if (place.flipped_rows) {
        for (int row = 0; row < grid.rows() / 2; ++row) {
            std::swap_ranges(grid.row(row).begin(), grid.row(row).end(),
                             grid.row(grid.rows() - 1 - row).begin());
        }
    }
    for (int row = 0; place.flipped_cols && row < grid.rows(); ++row) {
        std::reverse(grid.row(row).begin(), grid.row(row).end());
    }
}

} // namespace

terrain::Heightfield heightfield_of(Samples samples, Place& place) {
    flip(samples.heights, place);
    flip(samples.void_mask, place);
    terrain::Heightfield result;
    result.range = terrain::height_range(samples.heights, samples.void_mask);
    terrain::fill_voids(samples.heights, samples.void_mask);
    close_samples(samples.heights, samples.void_mask, place.closing);
    result.heights = std::move(samples.heights);
    result.void_mask = std::move(samples.void_mask);
    result.void_count = static_cast<std::size_t>(std::count(
        result.void_mask.samples().begin(), result.void_mask.samples().end(), std::uint8_t{1}));
    result.spacing = place.spacing;
    result.georeference = std::move(place.georeference);
    return result;
}

} // namespace reljef::io
