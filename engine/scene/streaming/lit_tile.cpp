#include <algorithm>
#include <functional>

#include <glm/common.hpp>

#include "engine/core/bilinear.h"
#include "engine/core/parallel_for.h"
#include "engine/scene/streaming/tile_builder.h"

namespace reljef::scene {
namespace {

// Metres: over larger tiles the vertical turns by more than a degree.
constexpr double max_side_with_one_up = 100e3;

glm::vec3 up_at(const TileBuilder& builder, const TerrainTile& tile, glm::ivec2 vertex) {
    const glm::dvec3 size = tile.bounds.size();
    return std::max({size.x, size.y, size.z}) <= max_side_with_one_up
               ? tile.up
               : glm::vec3(builder.overview().placement().up(tile.place(vertex)));
}

// `light`: at the vertices, linear.
Image reflected(const TerrainTile& tile, const Grid<glm::vec3>& light, unsigned threads) {
    Image lit(tile.albedo.cols(), tile.albedo.rows());
    const auto reflect_row = [&](int row) {
        for (int col = 0; col < lit.cols(); ++col) {
            lit(col, row) =
                rgba8_from_linear(linear_from_rgba8(tile.albedo(col, row)) *
                                  bilinear(light, tile.vertex_of({col, row}), std::identity()));
        }
    };
    parallel_for(lit.rows(), reflect_row, {threads, {}, {}});
    return lit;
}

} // namespace

Image lit_tile(const TileBuilder& builder, const TerrainTile& tile,
               const TerrainIrradiance& irradiance, unsigned threads) {
    const Grid<float>& overview = builder.overview().heightfield().heights;
    const glm::dvec2 last(overview.cols() - 1, overview.rows() - 1);
    Grid<glm::vec3> light(tile.cells.x + 1, tile.cells.y + 1);
    for (int row = 0; row < light.rows(); ++row) {
        for (int col = 0; col < light.cols(); ++col) {
            const glm::dvec2 sample =
                builder.around_overview(builder.on_overview(builder.sample(tile.id, {col, row})));
            const glm::dvec2 inside = glm::clamp(sample, glm::dvec2(0.0), last);
            light(col, row) =
                irradiance.at(tile.normals(col, row), up_at(builder, tile, {col, row}),
                              irradiance.visibility(inside), irradiance.openness(inside));
        }
    }
    return reflected(tile, light, threads);
}

LitTileParts lit_tile_parts(const TileBuilder& builder, const TerrainTile& tile,
                            const TerrainIrradiance& irradiance, unsigned threads) {
    const Grid<float>& overview = builder.overview().heightfield().heights;
    const glm::dvec2 last(overview.cols() - 1, overview.rows() - 1);
    Grid<glm::vec3> sky(tile.cells.x + 1, tile.cells.y + 1);
    Grid<glm::vec3> sun(tile.cells.x + 1, tile.cells.y + 1);
    for (int row = 0; row < sky.rows(); ++row) {
        for (int col = 0; col < sky.cols(); ++col) {
            const glm::dvec2 sample =
                builder.around_overview(builder.on_overview(builder.sample(tile.id, {col, row})));
            const IrradianceParts parts =
                irradiance.parts_at(tile.normals(col, row), up_at(builder, tile, {col, row}),
                                    irradiance.openness(glm::clamp(sample, glm::dvec2(0.0), last)));
            sky(col, row) = parts.sky;
            sun(col, row) = parts.sun;
        }
    }
    return {reflected(tile, sky, threads), reflected(tile, sun, threads)};
}

} // namespace reljef::scene
