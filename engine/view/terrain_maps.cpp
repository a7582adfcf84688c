#include "engine/view/terrain_maps.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/bilinear.h"
#include "engine/core/parallel_for.h"
#include "engine/terrain/field/gradient.h"

namespace reljef::view {
namespace {

// Nearest samples, including the border, with sides up to `largest`.
template <class T> Grid<T> subsampled(Grid<T> grid, int largest) {
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

// The position of a texel on a grid with the same corners.
glm::dvec2 place_on(glm::ivec2 texel, glm::ivec2 texels, glm::ivec2 grid) {
    const glm::dvec2 steps(glm::max(texels - 1, glm::ivec2(1)));
    return glm::dvec2(texel) * glm::dvec2(grid - 1) / steps;
}

template <class T> glm::ivec2 size_of(const Grid<T>& grid) {
    return {grid.cols(), grid.rows()};
}

// Calls `visit(texel, sample, linear albedo)` for every texel of a map.
template <class Visit>
void for_each_texel(const scene::TerrainSurface& surface, const Image& albedo, glm::ivec2 size,
                    const Visit& visit) {
    const glm::ivec2 samples = size_of(surface.heightfield().heights);
    parallel_for(size.y, [&](int row) {
        for (int col = 0; col < size.x; ++col) {
            const glm::dvec2 texel = place_on({col, row}, size, size_of(albedo));
            visit(glm::ivec2(col, row), place_on({col, row}, size, samples),
                  bilinear(albedo, texel, linear_from_rgba8));
        }
    });
}

glm::ivec2 map_size(const scene::TerrainSurface& surface, const Image& albedo, int largest_side) {
    return glm::min(glm::max(size_of(albedo), size_of(surface.heightfield().heights)),
                    glm::ivec2(largest_side));
}

} // namespace

Image lit_map(const scene::TerrainSurface& surface, const std::optional<scene::TerrainLight>& light,
              int largest_side) {
    if (!light) {
        return subsampled(scene::albedo_map(surface), largest_side);
    }
    const scene::TerrainIrradiance irradiance(surface, *light);
    const Image albedo = subsampled(scene::albedo_map(surface), largest_side);
    const glm::ivec2 size = map_size(surface, albedo, largest_side);
    Image lit(size.x, size.y);
    for_each_texel(surface, albedo, size,
                   [&](glm::ivec2 texel, glm::dvec2 sample, glm::vec3 reflected) {
                       lit(texel.x, texel.y) = rgba8_from_linear(reflected * irradiance.at(sample));
                   });
    return lit;
}

LightParts light_parts(const scene::TerrainSurface& surface, const scene::TerrainLight& light,
                       int largest_side) {
    const scene::TerrainIrradiance irradiance(surface, light);
    const Image albedo = subsampled(scene::albedo_map(surface), largest_side);
    const glm::ivec2 size = map_size(surface, albedo, largest_side);
    LightParts parts{Image(size.x, size.y), Image(size.x, size.y)};
    for_each_texel(surface, albedo, size,
                   [&](glm::ivec2 texel, glm::dvec2 sample, glm::vec3 reflected) {
                       const scene::IrradianceParts found = irradiance.parts_at(sample);
                       parts.sky(texel.x, texel.y) = rgba8_from_linear(reflected * found.sky);
                       parts.sun(texel.x, texel.y) = rgba8_from_linear(reflected * found.sun);
                   });
    return parts;
}

PreparedLight prepare_light(LightRequest request) {
    const scene::TerrainSurface& surface = *request.surface;
    PreparedLight made;
    if (request.stream != nullptr) {
        made.irradiance = std::make_shared<const scene::TerrainIrradiance>(surface, request.light);
    } else if (request.in_parts) {
        LightParts parts = light_parts(surface, request.light, request.largest_side);
        made.lit = std::move(parts.sky);
        made.sun = std::move(parts.sun);
    } else {
        made.lit = lit_map(surface, request.light, request.largest_side);
    }
    made.request = std::move(request);
    return made;
}

GroundMap ground_map(const scene::TerrainSurface& surface,
                     const std::optional<scene::TerrainLight>& light, int largest_side) {
    const Image albedo = subsampled(scene::albedo_map(surface), largest_side);
    const Grid<glm::vec2> gradients =
        terrain::surface_gradients(surface.heightfield(), surface.placement());
    std::optional<scene::TerrainIrradiance> irradiance;
    if (light) {
        irradiance.emplace(surface, *light);
    }
    const glm::ivec2 size = map_size(surface, albedo, largest_side);
    GroundMap map{Image(size.x, size.y), Grid<glm::vec4>(size.x, size.y)};
    for_each_texel(surface, albedo, size,
                   [&](glm::ivec2 texel, glm::dvec2 sample, glm::vec3 reflected) {
                       const glm::vec2 gradient = bilinear(gradients, sample, std::identity());
                       const glm::vec3 normal = glm::normalize(glm::vec3(-gradient, 1.0F));
                       const float sun = irradiance ? irradiance->visibility(sample) : 1.0F;
                       map.albedo(texel.x, texel.y) = rgba8_from_linear(reflected);
                       map.surface(texel.x, texel.y) = glm::vec4(normal, sun);
                   });
    return map;
}

GroundMap ground_of_tile(const scene::TileBuilder& builder, const scene::TerrainTile& tile,
                         const scene::TerrainIrradiance* irradiance) {
    const Grid<float>& overview = builder.overview().heightfield().heights;
    const glm::dvec2 last(overview.cols() - 1, overview.rows() - 1);
    const glm::dvec2 first = builder.first(tile.id);
    const double step = builder.step(tile.id);
    GroundMap map{tile.albedo, Grid<glm::vec4>(tile.albedo.cols(), tile.albedo.rows())};
    for (int row = 0; row < map.surface.rows(); ++row) {
        for (int col = 0; col < map.surface.cols(); ++col) {
            const glm::dvec2 vertex = tile.vertex_of({col, row});
            const glm::dvec2 sample = builder.on_overview(first + step * vertex);
            const glm::dvec2 inside = glm::clamp(sample, glm::dvec2(0.0), last);
            const float sun = irradiance != nullptr ? irradiance->visibility(inside) : 1.0F;
            map.surface(col, row) = glm::vec4(tile.normal_at(vertex), sun);
        }
    }
    return map;
}

glm::vec4 texture_from_sample(glm::ivec2 samples, glm::ivec2 texels) {
    const glm::vec2 scale = glm::vec2(texels - 1) / (glm::vec2(samples - 1) * glm::vec2(texels));
    return {scale, 0.5F / glm::vec2(texels)};
}

} // namespace reljef::view
