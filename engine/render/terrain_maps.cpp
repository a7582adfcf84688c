#include "engine/render/terrain_maps.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>

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

// Where a texel lies on a grid that covers the same ground, corner on corner.
glm::vec2 place_on(glm::ivec2 texel, glm::ivec2 texels, glm::ivec2 grid) {
    const glm::vec2 steps(glm::max(texels - 1, glm::ivec2(1)));
    return glm::vec2(texel) * glm::vec2(grid - 1) / steps;
}

template <class T> glm::ivec2 size_of(const Grid<T>& grid) {
    return {grid.cols(), grid.rows()};
}

// Bilinear; `value` makes something that can be mixed out of a sample.
template <class T, class Value> auto sampled(const Grid<T>& grid, glm::vec2 place, Value value) {
    const glm::ivec2 first = glm::min(glm::ivec2(place), size_of(grid) - 1);
    const glm::ivec2 last = glm::min(first + 1, size_of(grid) - 1);
    const glm::vec2 part = place - glm::vec2(first);
    const auto north =
        glm::mix(value(grid(first.x, first.y)), value(grid(last.x, first.y)), part.x);
    const auto south = glm::mix(value(grid(first.x, last.y)), value(grid(last.x, last.y)), part.x);
    return glm::mix(north, south, part.y);
}

Image albedo_map(const scene::TerrainSurface& surface, int largest_side) {
    const terrain::Terrain& terrain = surface.terrain();
    const bool opaque = !terrain.color.empty() &&
                        std::all_of(terrain.color.samples().begin(), terrain.color.samples().end(),
                                    [](Rgba8 pixel) { return pixel.a == 255; });
    return thinned(
        opaque ? terrain.color
               : terrain::composite(terrain.color, terrain::hypsometric_tint(terrain.heightfield)),
        largest_side);
}

// The light's part of lit_map: what a place reflects at albedo 1, by its slope.
class Shading {
public:
    explicit Shading(const TerrainLight& light)
        : world_from_normal_(glm::inverseTranspose(light.world_from_local)),
          to_sun_(scene::to_light(light.sun)), sun_(light.sun.color), sky_(light.sun.ambient) {}

    [[nodiscard]] glm::vec3 at(glm::vec2 gradient, float visibility) const {
        const glm::vec3 normal =
            glm::normalize(world_from_normal_ * glm::vec3(-gradient.x, -gradient.y, 1.0F));
        const float sun = std::max(glm::dot(normal, to_sun_), 0.0F) * visibility;
        return sun_ * sun + sky_ * (0.5F + 0.5F * normal.z);
    }

private:
    glm::mat3 world_from_normal_;
    glm::vec3 to_sun_;
    glm::vec3 sun_;
    glm::vec3 sky_;
};

} // namespace

Image lit_map(const scene::TerrainSurface& surface, const std::optional<TerrainLight>& light,
              int largest_side) {
    Image albedo = albedo_map(surface, largest_side);
    if (!light) {
        return albedo;
    }
    const terrain::Heightfield& heightfield = surface.heightfield();
    const Grid<glm::vec2> gradients = terrain::scene_gradients(heightfield, surface.placement());
    const glm::dvec2 middle = 0.5 * glm::dvec2(size_of(gradients) - 1);
    // How far the sun lies along each axis of the grid (a vector times a matrix: its columns).
    const glm::dvec3 to_sun = glm::inverse(light->world_from_local) * scene::to_light(light->sun) *
                              terrain::grid_axes(heightfield, surface.placement(), middle);
    const Grid<std::uint8_t> visibility =
        terrain::sun_visibility(heightfield.heights.view(), heightfield.spacing,
                                surface.placement().exaggeration(), to_sun);
    const Shading shading(*light);
    const glm::ivec2 samples = size_of(gradients);
    const glm::ivec2 size = glm::min(glm::max(size_of(albedo), samples), glm::ivec2(largest_side));
    Image lit(size.x, size.y);
    parallel_for(size.y, [&](int row) {
        for (int col = 0; col < size.x; ++col) {
            const glm::vec2 sample = place_on({col, row}, size, samples);
            const glm::vec2 gradient = sampled(gradients, sample, std::identity());
            const float seen =
                sampled(visibility, sample, [](std::uint8_t share) { return share / 255.0F; });
            const glm::vec3 reflected =
                sampled(albedo, place_on({col, row}, size, size_of(albedo)), linear_from_rgba8);
            lit(col, row) = rgba8_from_linear(reflected * shading.at(gradient, seen));
        }
    });
    return lit;
}

} // namespace reljef::render
