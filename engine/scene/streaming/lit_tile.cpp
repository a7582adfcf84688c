#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/common.hpp>

#include "engine/core/parallel_for.h"
#include "engine/scene/streaming/tile_builder.h"

namespace reljef::scene {
namespace {

// Metres: over larger tiles the vertical turns by more than a degree.
constexpr double max_side_with_one_up = 100e3;

// A place between two lines of a grid, along one axis.
struct Between {
    int near = 0;
    int far = 0;
    float part = 0.0F; // of the way to `far`

    Between(double place, int count)
        : near(std::min(static_cast<int>(place), count - 1)), far(std::min(near + 1, count - 1)),
          part(static_cast<float>(place - near)) {}
};

template <class T> T interpolated(const Grid<T>& grid, const Between& col, const Between& row) {
    if (col.part == 0.0F && row.part == 0.0F) {
        return grid(col.near, row.near);
    }
    const T north = glm::mix(grid(col.near, row.near), grid(col.far, row.near), col.part);
    const T south = glm::mix(grid(col.near, row.far), grid(col.far, row.far), col.part);
    return glm::mix(north, south, row.part);
}

// Where the vertices of a tile take values of the overview from, along one axis.
struct OverviewAxis {
    std::vector<double> places;    // samples of the overview
    std::vector<Between> vertices; // among them

    // At the overview's samples if the vertices are closer, otherwise at the vertices.
    explicit OverviewAxis(const std::vector<double>& vertex_samples) {
        const auto [low, high] = std::minmax_element(vertex_samples.begin(), vertex_samples.end());
        const double first = std::floor(*low);
        const auto count = static_cast<std::size_t>(std::ceil(*high) - first) + 1;
        const bool is_finer = count < vertex_samples.size();
        for (std::size_t i = 0; is_finer && i < count; ++i) {
            places.push_back(first + static_cast<double>(i));
        }
        places = is_finer ? places : vertex_samples;
        for (std::size_t i = 0; i < vertex_samples.size(); ++i) {
            const double place = is_finer ? vertex_samples[i] - first : static_cast<double>(i);
            vertices.emplace_back(place, static_cast<int>(places.size()));
        }
    }
};

// The light at the vertices of a tile, whose shadows are the overview's.
class VertexLight {
public:
    VertexLight(const TileBuilder& builder, const TerrainTile& tile,
                const TerrainIrradiance& irradiance)
        : builder_(builder), tile_(tile), irradiance_(irradiance), cols_(samples_along(0)),
          rows_(samples_along(1)), shares_(read_shares()), up_(irradiance.in_world(tile.up)) {}

    [[nodiscard]] glm::vec3 at(glm::ivec2 vertex) const {
        const glm::vec2 shares = shares_at(vertex);
        return irradiance_.at(normal(vertex), up(vertex), shares.x, shares.y);
    }
    [[nodiscard]] IrradianceParts parts_at(glm::ivec2 vertex) const {
        return irradiance_.parts_at(normal(vertex), up(vertex), shares_at(vertex).y);
    }

private:
    [[nodiscard]] std::vector<double> samples_along(int axis) const {
        std::vector<double> samples;
        for (int i = 0; i <= tile_.cells[axis]; ++i) {
            glm::ivec2 vertex(0);
            vertex[axis] = i;
            samples.push_back(builder_.on_overview(builder_.sample(tile_.id, vertex))[axis]);
        }
        return samples;
    }
    // The visible shares of the sun and of the sky.
    [[nodiscard]] Grid<glm::vec2> read_shares() const {
        const Grid<float>& overview = builder_.overview().heightfield().heights;
        const glm::dvec2 last(overview.cols() - 1, overview.rows() - 1);
        Grid<glm::vec2> shares(static_cast<int>(cols_.places.size()),
                               static_cast<int>(rows_.places.size()));
        for (int row = 0; row < shares.rows(); ++row) {
            for (int col = 0; col < shares.cols(); ++col) {
                const glm::dvec2 place(cols_.places[static_cast<std::size_t>(col)],
                                       rows_.places[static_cast<std::size_t>(row)]);
                const glm::dvec2 inside =
                    glm::clamp(builder_.around_overview(place), glm::dvec2(0.0), last);
                shares(col, row) = {irradiance_.visibility(inside), irradiance_.openness(inside)};
            }
        }
        return shares;
    }
    [[nodiscard]] glm::vec2 shares_at(glm::ivec2 vertex) const {
        return interpolated(shares_, cols_.vertices[static_cast<std::size_t>(vertex.x)],
                            rows_.vertices[static_cast<std::size_t>(vertex.y)]);
    }
    [[nodiscard]] glm::vec3 normal(glm::ivec2 vertex) const {
        return irradiance_.in_world(tile_.normals(vertex.x, vertex.y));
    }
    [[nodiscard]] glm::vec3 up(glm::ivec2 vertex) const {
        return has_one_up_ ? up_
                           : irradiance_.in_world(glm::vec3(
                                 builder_.overview().placement().up(tile_.place(vertex))));
    }
    [[nodiscard]] bool has_one_up() const {
        const glm::dvec3 size = tile_.bounds.size();
        return std::max({size.x, size.y, size.z}) <= max_side_with_one_up;
    }

    const TileBuilder& builder_;
    const TerrainTile& tile_;
    const TerrainIrradiance& irradiance_;
    OverviewAxis cols_;
    OverviewAxis rows_;
    Grid<glm::vec2> shares_;
    glm::vec3 up_;
    bool has_one_up_ = has_one_up();
};

// `light`: at the vertices, linear.
Image reflected(const TerrainTile& tile, const Grid<glm::vec3>& light, unsigned threads) {
    Image lit(tile.albedo.cols(), tile.albedo.rows());
    std::vector<Between> cols;
    cols.reserve(static_cast<std::size_t>(lit.cols()));
    for (int col = 0; col < lit.cols(); ++col) {
        cols.emplace_back(tile.vertex_of({col, 0}).x, light.cols());
    }
    const auto reflect_row = [&](int row) {
        const Between between(tile.vertex_of({0, row}).y, light.rows());
        for (int col = 0; col < lit.cols(); ++col) {
            lit(col, row) = rgba8_from_linear(
                linear_from_rgba8(tile.albedo(col, row)) *
                interpolated(light, cols[static_cast<std::size_t>(col)], between));
        }
    };
    parallel_for(lit.rows(), reflect_row, {threads, {}, {}});
    return lit;
}

} // namespace

Image lit_tile(const TileBuilder& builder, const TerrainTile& tile,
               const TerrainIrradiance& irradiance, unsigned threads) {
    const VertexLight vertices(builder, tile, irradiance);
    Grid<glm::vec3> light(tile.cells.x + 1, tile.cells.y + 1);
    for (int row = 0; row < light.rows(); ++row) {
        for (int col = 0; col < light.cols(); ++col) {
            light(col, row) = vertices.at({col, row});
        }
    }
    return reflected(tile, light, threads);
}

LitTileParts lit_tile_parts(const TileBuilder& builder, const TerrainTile& tile,
                            const TerrainIrradiance& irradiance, unsigned threads) {
    const VertexLight vertices(builder, tile, irradiance);
    Grid<glm::vec3> sky(tile.cells.x + 1, tile.cells.y + 1);
    Grid<glm::vec3> sun(tile.cells.x + 1, tile.cells.y + 1);
    for (int row = 0; row < sky.rows(); ++row) {
        for (int col = 0; col < sky.cols(); ++col) {
            const IrradianceParts parts = vertices.parts_at({col, row});
            sky(col, row) = parts.sky;
            sun(col, row) = parts.sun;
        }
    }
    return {reflected(tile, sky, threads), reflected(tile, sun, threads)};
}

} // namespace reljef::scene
