#include "engine/render/terrain_maps.h"

#include <algorithm>
#include <cmath>

#include <glm/packing.hpp>

#include "engine/core/worker_pool.h"
#include "engine/terrain/gradient.h"
#include "engine/terrain/sun_visibility.h"
#include "engine/terrain/tint.h"

namespace reljef::render {
namespace {

// Every k-th sample, the last ones kept, so that no side is longer than `largest`.
template <class T> Grid<T> thinned(Grid<T> grid, int largest) {
    const int cols = std::min(grid.cols(), largest);
    const int rows = std::min(grid.rows(), largest);
    if (cols == grid.cols() && rows == grid.rows()) {
        return grid;
    }
    const auto place = [](int index, int from, int to) {
        return from > 1 ? static_cast<int>(
                              std::lround(static_cast<double>(index) * (to - 1) / (from - 1)))
                        : 0;
    };
    Grid<T> thin(cols, rows);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            thin(col, row) = grid(place(col, cols, grid.cols()), place(row, rows, grid.rows()));
        }
    }
    return thin;
}

void put_into_alpha(Image& image, const Grid<std::uint8_t>& visibility) {
    parallel_for(image.rows(), [&](int row) {
        for (int col = 0; col < image.cols(); ++col) {
            image(col, row).a =
                terrain::resampled(visibility, col, row, {image.cols(), image.rows()});
        }
    });
}

} // namespace

Image color_map(const scene::TerrainSurface& surface, const std::optional<glm::dvec3>& to_sun,
                int largest_side) {
    const terrain::Terrain& terrain = surface.terrain();
    const terrain::Heightfield& heightfield = terrain.heightfield;
    const bool opaque = !terrain.color.empty() &&
                        std::all_of(terrain.color.samples().begin(), terrain.color.samples().end(),
                                    [](Rgba8 pixel) { return pixel.a == 255; });
    Image image =
        thinned(opaque ? terrain.color
                       : terrain::composite(terrain.color, terrain::hypsometric_tint(heightfield)),
                largest_side);
    if (to_sun) {
        put_into_alpha(image,
                       terrain::sun_visibility(heightfield.heights.view(), heightfield.spacing,
                                               surface.placement().exaggeration(), *to_sun));
    }
    return image;
}

Grid<std::uint32_t> gradient_map(const scene::TerrainSurface& surface, int largest_side) {
    const Grid<glm::vec2> gradients =
        terrain::scene_gradients(surface.heightfield(), surface.placement());
    // The largest half float: cliffs steeper than that are upright to within a thousandth of a
    // degree.
    constexpr float steepest = 65504.0F;
    Grid<std::uint32_t> packed(gradients.cols(), gradients.rows());
    std::transform(gradients.samples().begin(), gradients.samples().end(), packed.samples().begin(),
                   [](glm::vec2 gradient) {
                       return glm::packHalf2x16(
                           glm::clamp(gradient, glm::vec2(-steepest), glm::vec2(steepest)));
                   });
    return thinned(std::move(packed), largest_side);
}

} // namespace reljef::render
