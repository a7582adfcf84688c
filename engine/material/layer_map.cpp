#include "engine/material/layer_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/vec2.hpp>

namespace reljef::material {
namespace {

constexpr float middle_height = 0.5F;

std::optional<std::string> error_of(const glm::vec4& heights) {
    for (int i = 0; i < 4; ++i) {
        if (!(heights[i] >= 0.0F && heights[i] <= 1.0F)) {
            return fmt::format("a height of {} found in layer {}, heights in [0, 1] were expected",
                               heights[i], i + 1);
        }
        if (i > 0 && heights[i] > heights[i - 1]) {
            return fmt::format(
                "layer {} at {} above layer {} at {} found, each layer below the one "
                "before it was expected",
                i + 1, heights[i], i, heights[i - 1]);
        }
    }
    return std::nullopt;
}

template <class Heights>
Result<LayerMap> make_layers(int cols, int rows, const Heights& heights_at) {
    Grid<glm::vec4> heights(cols, rows);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            heights(col, row) = heights_at(col, row);
        }
    }
    return LayerMap::create(std::move(heights));
}

// Height of a triangle above a place. An edge belongs to the triangle on one side of it only.
std::optional<double> height_on(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                                glm::dvec2 place) {
    const auto side = [&](const glm::dvec3& from, const glm::dvec3& to) {
        // The same value for both directions of an edge.
        const bool swapped = std::pair(to.x, to.y) < std::pair(from.x, from.y);
        const glm::dvec3& p = swapped ? to : from;
        const glm::dvec3& q = swapped ? from : to;
        const double area = (q.x - p.x) * (place.y - p.y) - (q.y - p.y) * (place.x - p.x);
        return std::pair(swapped ? -area : area, swapped);
    };
    const std::array sides{side(b, c), side(c, a), side(a, b)};
    const double sum = sides[0].first + sides[1].first + sides[2].first;
    if (sum == 0.0) {
        return std::nullopt;
    }
    for (const auto& [area, swapped] : sides) {
        const bool is_inside = area == 0.0 ? swapped == (sum > 0.0) : (area > 0.0) == (sum > 0.0);
        if (!is_inside) {
            return std::nullopt;
        }
    }
    return (sides[0].first * a.z + sides[1].first * b.z + sides[2].first * c.z) / sum;
}

Result<void> check_positions(const TileMesh& mesh) {
    constexpr float max_copies = 64.0F;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3& place = mesh.positions[i];
        const float max_coordinate = std::max(std::abs(place.x), std::abs(place.y));
        if (!(max_coordinate <= max_copies) || !std::isfinite(place.z)) {
            return Error{
                fmt::format("vertex {} of the mesh lies at {}, {}, {}; a place within {} copies "
                            "of the tile was expected",
                            i, place.x, place.y, place.z, max_copies)};
        }
    }
    return {};
}

struct Crossing {
    double height = 0.0;
    int turn = 0; // 1: into the solid, from above
};
using Column = std::vector<Crossing>;

struct Solid {
    double top = 0.0;
    double bottom = 0.0;
};

void add_crossings(Grid<Column>& columns, const TileMesh& mesh, std::size_t first) {
    const glm::dvec2 size(columns.cols(), columns.rows());
    const glm::dvec3 to_texels(size, 1.0);
    std::array<glm::dvec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = glm::dvec3(mesh.positions[mesh.indices[first + k]]) * to_texels;
    }
    const auto& [a, b, c] = corners;
    // Rows run down, so a triangle that faces up has a negative area.
    const double turned = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    const glm::ivec2 low(glm::floor(glm::min(glm::min(a, b), c) - 0.5));
    const glm::ivec2 high(glm::ceil(glm::max(glm::max(a, b), c) - 0.5));
    const glm::ivec2 count(columns.cols(), columns.rows());
    for (int row = low.y; row <= high.y; ++row) {
        for (int col = low.x; col <= high.x; ++col) {
            if (const auto height = height_on(a, b, c, glm::dvec2(col, row) + 0.5)) {
                const glm::ivec2 texel = ((glm::ivec2(col, row) % count) + count) % count;
                columns(texel.x, texel.y).push_back({*height, turned < 0.0 ? 1 : -1});
            }
        }
    }
}

// The solids along a vertical line, from above.
std::vector<Solid> solids_of(Column column) {
    std::sort(column.begin(), column.end(), [](const Crossing& one, const Crossing& other) {
        return one.height != other.height ? one.height > other.height : one.turn > other.turn;
    });
    std::vector<Solid> solids;
    int depth = 0;
    for (const Crossing& crossing : column) {
        if (depth == 0 && crossing.turn > 0) {
            solids.push_back({crossing.height, crossing.height});
        }
        depth += crossing.turn;
        if (depth == 0 && crossing.turn < 0 && !solids.empty()) {
            solids.back().bottom = crossing.height;
        }
    }
    std::erase_if(solids, [](const Solid& solid) { return !(solid.top > solid.bottom); });
    return solids;
}

// The mean of the neighbours with a value; wraps.
std::optional<float> mean_around(const Grid<std::optional<float>>& values, int col, int row) {
    constexpr std::array<glm::ivec2, 4> directions{glm::ivec2(1, 0), glm::ivec2(-1, 0),
                                                   glm::ivec2(0, 1), glm::ivec2(0, -1)};
    float sum = 0.0F;
    int count = 0;
    for (const glm::ivec2 direction : directions) {
        const auto& other = values(index_beyond(col + direction.x, values.cols(), WrapMode::wrap),
                                   index_beyond(row + direction.y, values.rows(), WrapMode::wrap));
        sum += other.value_or(0.0F);
        count += other ? 1 : 0;
    }
    return count > 0 ? std::optional(sum / static_cast<float>(count)) : std::nullopt;
}

// Fills texels beside a texel with a value. Returns whether there were any.
bool fill_one_ring(Grid<std::optional<float>>& values) {
    const Grid<std::optional<float>> before = values;
    bool is_changed = false;
    for (int row = 0; row < values.rows(); ++row) {
        for (int col = 0; col < values.cols(); ++col) {
            if (!before(col, row)) {
                values(col, row) = mean_around(before, col, row);
                is_changed = is_changed || values(col, row);
            }
        }
    }
    return is_changed;
}

// One of the two solids per texel, and its middle, also in holes.
struct Halves {
    Grid<std::optional<Solid>> solids;
    Grid<std::optional<float>> middles;

    Halves(int cols, int rows) : solids(cols, rows), middles(cols, rows) {}
    void set(int col, int row, const Solid& solid) {
        solids(col, row) = solid;
        middles(col, row) = static_cast<float>(0.5 * (solid.top + solid.bottom));
    }
    [[nodiscard]] glm::vec2 at(int col, int row) const {
        if (const auto& solid = solids(col, row)) {
            return {solid->top, solid->bottom};
        }
        return glm::vec2(middles(col, row).value_or(middle_height));
    }
};

// The uppermost and the lowest solids.
struct BothHalves {
    Halves upper;
    Halves lower;
    std::size_t too_many = 0;
};

BothHalves halves_of(Grid<Column>& columns) {
    BothHalves both{{columns.cols(), columns.rows()}, {columns.cols(), columns.rows()}, 0};
    for (int row = 0; row < columns.rows(); ++row) {
        for (int col = 0; col < columns.cols(); ++col) {
            const std::vector<Solid> solids = solids_of(std::move(columns(col, row)));
            both.too_many += solids.size() > 2 ? 1U : 0U;
            if (!solids.empty()) {
                both.upper.set(col, row, solids.front());
            }
            if (solids.size() > 1) {
                both.lower.set(col, row, solids.back());
            }
        }
    }
    for (auto* middles : {&both.upper.middles, &both.lower.middles}) {
        while (fill_one_ring(*middles)) {
        }
    }
    return both;
}

// A hole of the lower solid lies below the upper solid.
glm::vec4 layers_at(const BothHalves& both, int col, int row) {
    const glm::vec2 high = both.upper.at(col, row);
    const glm::vec2 low = both.lower.at(col, row);
    const bool is_hole = !both.lower.solids(col, row).has_value();
    return {high, is_hole ? glm::vec2(std::min(low.x, high.y)) : low};
}

} // namespace

Result<LayerMap> LayerMap::create(Grid<glm::vec4> heights) {
    if (heights.empty()) {
        return Error{"layer map: it has no texels, at least one was expected"};
    }
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            if (const auto error = error_of(heights(col, row))) {
                return Error{fmt::format("layer map: at column {}, row {} {}", col, row, *error)};
            }
        }
    }
    LayerMap map;
    map.heights_ = std::move(heights);
    return map;
}

LayerMap symmetric_layers(GridView<const float> heights) {
    const auto heights_at = [&](int col, int row) {
        const float half = 0.5F * heights(col, row);
        return glm::vec4(middle_height + half, middle_height - half, glm::vec2(0.0F));
    };
    return make_layers(heights.cols(), heights.rows(), heights_at).value();
}

Result<LayerMap> dual_layers(GridView<const float> front, GridView<const float> back) {
    if (front.cols() != back.cols() || front.rows() != back.rows()) {
        return Error{
            fmt::format("layer map: a front of {} x {} and a back of {} x {} texels found, "
                        "one size was expected",
                        front.cols(), front.rows(), back.cols(), back.rows())};
    }
    return make_layers(front.cols(), front.rows(), [&](int col, int row) {
        return glm::vec4(middle_height + 0.5F * front(col, row),
                         middle_height - 0.5F * back(col, row), 0.0F, 0.0F);
    });
}

LayerMap filled_layers(GridView<const float> heights) {
    const auto heights_at = [&](int col, int row) {
        return glm::vec4(heights(col, row), glm::vec3(0.0F));
    };
    return make_layers(heights.cols(), heights.rows(), heights_at).value();
}

Grid<float> top_heights(const LayerMap& layers) {
    const Grid<glm::vec4>& heights = layers.heights();
    Grid<float> tops(heights.cols(), heights.rows());
    for (std::size_t i = 0; i < tops.size(); ++i) {
        const glm::vec4& at = heights.samples()[i];
        tops.samples()[i] = at.x > at.y ? at.x : (at.z > at.w ? at.z : 0.0F);
    }
    return tops;
}

LayerMap seen_from_behind(const LayerMap& layers) {
    const Grid<glm::vec4>& from = layers.heights();
    const auto heights_at = [&](int col, int row) {
        const glm::vec4& heights = from(col, row);
        return 1.0F - glm::vec4(heights.w, heights.z, heights.y, heights.x);
    };
    return make_layers(from.cols(), from.rows(), heights_at).value();
}

LayerNormals layer_normals(const LayerMap& layers, float scale, WrapMode border) {
    const Grid<glm::vec4>& heights = layers.heights();
    const int cols = heights.cols();
    const int rows = heights.rows();
    LayerNormals normals{Grid<glm::vec4>(cols, rows), Grid<glm::vec4>(cols, rows)};
    const glm::vec4 outward(1.0F, -1.0F, 1.0F, -1.0F);
    const glm::vec2 per_width = 0.5F * scale * glm::vec2(cols, rows);
    for (int row = 0; row < rows; ++row) {
        const int above = index_beyond(row - 1, rows, border);
        const int below = index_beyond(row + 1, rows, border);
        for (int col = 0; col < cols; ++col) {
            const int before = index_beyond(col - 1, cols, border);
            const int behind = index_beyond(col + 1, cols, border);
            const glm::vec4 rise_u = per_width.x * (heights(behind, row) - heights(before, row));
            const glm::vec4 rise_v = per_width.y * (heights(col, below) - heights(col, above));
            const glm::vec4 share = outward / glm::sqrt(1.0F + rise_u * rise_u + rise_v * rise_v);
            normals.along_u(col, row) = -rise_u * share;
            normals.along_v(col, row) = -rise_v * share;
        }
    }
    return normals;
}

Result<MeshLayers> layers_of_mesh(const TileMesh& mesh, int cols, int rows) {
    if (auto good = check_positions(mesh); !good) {
        return good.error();
    }
    Grid<Column> columns(cols, rows);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        add_crossings(columns, mesh, i);
    }
    const BothHalves both = halves_of(columns);
    auto layers =
        make_layers(cols, rows, [&](int col, int row) { return layers_at(both, col, row); });
    if (!layers) {
        return layers.error();
    }
    return MeshLayers{std::move(*layers), both.too_many};
}

} // namespace reljef::material
