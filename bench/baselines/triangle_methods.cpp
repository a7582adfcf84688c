#include "bench/baselines/triangle_methods.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include <glm/common.hpp>

#include "bench/baselines/greedy_triangulation.h"
#include "engine/core/check.h"
#include "engine/terrain/mesh/bisection_mesh.h"

namespace reljef::bench {
namespace {

constexpr int patch_cells = 16;

using terrain::SampleTriangle;

// The middle of a triangle's longest edge, between its last two corners.
glm::ivec2 middle_of(const SampleTriangle& triangle) {
    return (triangle[1] + triangle[2]) / 2;
}

bool is_smallest(const SampleTriangle& triangle) {
    const glm::ivec2 leg = glm::abs(triangle[1] - triangle[0]);
    return leg.x + leg.y <= 1;
}

std::array<SampleTriangle, 2> halves_of(const SampleTriangle& triangle) {
    const glm::ivec2 middle = middle_of(triangle);
    return {SampleTriangle{middle, triangle[0], triangle[1]},
            SampleTriangle{middle, triangle[2], triangle[0]}};
}

class Rtin {
public:
    explicit Rtin(const Grid<float>& heights)
        : heights_(heights), errors_(heights.cols(), heights.rows(), 0.0) {
        // What a triangle needs of a neighbour's halves is known a level later: coarser levels are
        // found from all of the finer ones.
        const int levels = 2 * std::countr_zero(static_cast<unsigned>(heights.cols() - 1));
        for (int level = levels - 1; level >= 0; --level) {
            for (const SampleTriangle& root : roots()) {
                add_errors(root, level);
            }
        }
    }

    [[nodiscard]] std::vector<SampleTriangle> triangles(double error) const {
        std::vector<SampleTriangle> all;
        for (const SampleTriangle& root : roots()) {
            add_triangles(root, error, all);
        }
        return all;
    }

private:
    [[nodiscard]] std::array<SampleTriangle, 2> roots() const {
        const glm::ivec2 last(heights_.cols() - 1, heights_.rows() - 1);
        return {SampleTriangle{{{0, last.y}, last, {0, 0}}},
                SampleTriangle{{{last.x, 0}, {0, 0}, last}}};
    }

    double& error_at(glm::ivec2 sample) { return errors_(sample.x, sample.y); }

    void add_errors(const SampleTriangle& triangle, int level) {
        const auto halves = halves_of(triangle);
        if (level > 0) {
            add_errors(halves[0], level - 1);
            add_errors(halves[1], level - 1);
            return;
        }
        const auto height = [&](glm::ivec2 sample) {
            return static_cast<double>(heights_(sample.x, sample.y));
        };
        const glm::ivec2 middle = middle_of(triangle);
        double error = std::abs(0.5 * (height(triangle[1]) + height(triangle[2])) - height(middle));
        for (const SampleTriangle& half : halves) {
            error = is_smallest(half) ? error : std::max(error, error_at(middle_of(half)));
        }
        error_at(middle) = std::max(error_at(middle), error);
    }

    void add_triangles(const SampleTriangle& triangle, double error,
                       std::vector<SampleTriangle>& all) const {
        const glm::ivec2 middle = middle_of(triangle);
        if (is_smallest(triangle) || errors_(middle.x, middle.y) <= error) {
            all.push_back(triangle);
            return;
        }
        for (const SampleTriangle& half : halves_of(triangle)) {
            add_triangles(half, error, all);
        }
    }

    const Grid<float>& heights_;
    Grid<double> errors_; // at the middles of longest edges
};

std::vector<SampleTriangle> patch_triangles(glm::ivec2 first, int step) {
    std::vector<SampleTriangle> triangles;
    for (int row = 0; row < patch_cells; row += step) {
        for (int col = 0; col < patch_cells; col += step) {
            const glm::ivec2 corner = first + glm::ivec2(col, row);
            const glm::ivec2 east = corner + glm::ivec2(step, 0);
            const glm::ivec2 south = corner + glm::ivec2(0, step);
            triangles.push_back({corner, south, corner + step});
            triangles.push_back({corner, corner + step, east});
        }
    }
    return triangles;
}

double worst_of(const Grid<float>& heights, const std::vector<SampleTriangle>& triangles) {
    double worst = 0.0;
    for (const SampleTriangle& triangle : triangles) {
        worst = std::max(worst, farthest_sample(heights.view(), triangle).error);
    }
    return worst;
}

MethodResult by_patches(const Grid<float>& heights, double error) {
    MethodResult result;
    for (int row = 0; row + patch_cells < heights.rows(); row += patch_cells) {
        for (int col = 0; col + patch_cells < heights.cols(); col += patch_cells) {
            for (int step = patch_cells; step >= 1; step /= 2) {
                const auto triangles = patch_triangles({col, row}, step);
                const double worst = worst_of(heights, triangles);
                if (worst <= error || step == 1) {
                    result.triangles += triangles.size();
                    result.worst = std::max(result.worst, worst);
                    break;
                }
            }
        }
    }
    return result;
}

// Triangles smaller than a cell have no sample but at their corners.
void add_at_samples(const terrain::Triangulation& part, std::vector<SampleTriangle>& all) {
    constexpr int steps = terrain::steps_per_sample;
    for (std::size_t i = 0; i < part.indices.size(); i += 3) {
        const SampleTriangle places{part.vertices[part.indices[i]],
                                    part.vertices[part.indices[i + 1]],
                                    part.vertices[part.indices[i + 2]]};
        if (std::all_of(places.begin(), places.end(),
                        [](glm::ivec2 place) { return place / steps * steps == place; })) {
            all.push_back({places[0] / steps, places[1] / steps, places[2] / steps});
        }
    }
}

MethodResult by_bisection(const Grid<float>& heights, double error) {
    terrain::Heightfield heightfield;
    heightfield.heights = heights;
    heightfield.range = terrain::height_range(heights, {});
    const auto placement =
        terrain::Placement::create(heightfield, terrain::PlacementKind::plane).value();
    const terrain::Bisection bisection(heightfield, placement);
    terrain::ErrorView view; // from the side, a pixel a metre, all in sight
    view.perspective = false;
    view.max_error = error;
    MethodResult result;
    for (const terrain::Tile& tile : terrain::tile_layout(heightfield, placement)) {
        for (const terrain::Triangulation& part : terrain::triangulate(bisection, tile, view)) {
            std::vector<SampleTriangle> at_samples;
            add_at_samples(part, at_samples);
            result.triangles += part.indices.size() / 3;
            result.worst = std::max(result.worst, worst_of(heights, at_samples));
        }
    }
    return result;
}

MethodResult result_of(const Grid<float>& heights, const std::vector<SampleTriangle>& triangles) {
    return {triangles.size(), worst_of(heights, triangles)};
}

} // namespace

std::string_view to_string(TriangleMethod method) {
    switch (method) {
    case TriangleMethod::bisection:
        return "bisection";
    case TriangleMethod::rtin:
        return "rtin";
    case TriangleMethod::patches:
        return "patches";
    default:
        return "greedy";
    }
}

MethodResult triangulate_by(TriangleMethod method, const Grid<float>& heights, double error) {
    check(heights.cols() == heights.rows() && heights.cols() > patch_cells &&
              std::has_single_bit(static_cast<unsigned>(heights.cols() - 1)),
          "heights of 2^n+1 x 2^n+1");
    switch (method) {
    case TriangleMethod::bisection:
        return by_bisection(heights, error);
    case TriangleMethod::rtin:
        return result_of(heights, Rtin(heights).triangles(error));
    case TriangleMethod::patches:
        return by_patches(heights, error);
    default:
        return result_of(heights, greedy_triangulation(heights.view(), error));
    }
}

} // namespace reljef::bench
