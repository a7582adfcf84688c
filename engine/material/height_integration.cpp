#include "engine/material/height_integration.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace reljef::material {
namespace {

constexpr double reduction = 1e-8;
constexpr int max_rounds = 200;

// Weights of the links from each sample to the next column and row; the last sample links to the
// first. The energy is the sum of weight · (difference of heights)².
struct Links {
    Grid<double> east;
    Grid<double> south;

    [[nodiscard]] int cols() const { return east.cols(); }
    [[nodiscard]] int rows() const { return east.rows(); }
    [[nodiscard]] int next_col(int col) const { return col + 1 < cols() ? col + 1 : 0; }
    [[nodiscard]] int next_row(int row) const { return row + 1 < rows() ? row + 1 : 0; }
};

Links first_links(int cols, int rows, WrapMode border) {
    Links links{Grid<double>(cols, rows, 1.0), Grid<double>(cols, rows, 1.0)};
    const double across = border == WrapMode::wrap ? 1.0 : 0.0;
    for (int row = 0; row < rows; ++row) {
        links.east(cols - 1, row) = cols > 1 ? across : 0.0;
    }
    for (int col = 0; col < cols; ++col) {
        links.south(col, rows - 1) = rows > 1 ? across : 0.0;
    }
    return links;
}

// The links between blocks of 2×2 samples of constant height.
Links block_links(const Links& fine) {
    Links coarse{Grid<double>((fine.cols() + 1) / 2, (fine.rows() + 1) / 2),
                 Grid<double>((fine.cols() + 1) / 2, (fine.rows() + 1) / 2)};
    for (int row = 0; row < fine.rows(); ++row) {
        for (int col = 0; col < fine.cols(); ++col) {
            if (fine.next_col(col) / 2 != col / 2) {
                coarse.east(col / 2, row / 2) += fine.east(col, row);
            }
            if (fine.next_row(row) / 2 != row / 2) {
                coarse.south(col / 2, row / 2) += fine.south(col, row);
            }
        }
    }
    return coarse;
}

// Sums over a sample's links: weight, and weight · neighbour's height.
struct Pull {
    double weight = 0.0;
    double height = 0.0;

    void add(double link, double neighbour) {
        weight += link;
        height += link * neighbour;
    }
};

Pull pull_at(const Links& links, const Grid<double>& heights, int col, int row) {
    const int west = col > 0 ? col - 1 : links.cols() - 1;
    const int north = row > 0 ? row - 1 : links.rows() - 1;
    Pull pull;
    pull.add(links.east(col, row), heights(links.next_col(col), row));
    pull.add(links.east(west, row), heights(west, row));
    pull.add(links.south(col, row), heights(col, links.next_row(row)));
    pull.add(links.south(col, north), heights(col, north));
    return pull;
}

void apply_links(const Links& links, const Grid<double>& heights, Grid<double>& result) {
    for (int row = 0; row < links.rows(); ++row) {
        for (int col = 0; col < links.cols(); ++col) {
            const Pull pull = pull_at(links, heights, col, row);
            result(col, row) = pull.weight * heights(col, row) - pull.height;
        }
    }
}

void settle(const Links& links, const Grid<double>& desired, Grid<double>& heights, int col,
            int row) {
    const Pull pull = pull_at(links, heights, col, row);
    if (pull.weight > 0.0) {
        heights(col, row) = (desired(col, row) + pull.height) / pull.weight;
    }
}

// Gauss-Seidel; the backward sweep is the transpose of the forward sweep.
void sweep_forwards(const Links& links, const Grid<double>& desired, Grid<double>& heights) {
    for (int row = 0; row < links.rows(); ++row) {
        for (int col = 0; col < links.cols(); ++col) {
            settle(links, desired, heights, col, row);
        }
    }
}
void sweep_backwards(const Links& links, const Grid<double>& desired, Grid<double>& heights) {
    for (int row = links.rows() - 1; row >= 0; --row) {
        for (int col = links.cols() - 1; col >= 0; --col) {
            settle(links, desired, heights, col, row);
        }
    }
}

// Blocks of constant height are stiffer than a smooth surface: their correction is too small, by a
// factor of 2 on a linear surface.
constexpr double correction_scale = 1.8;

class Multigrid {
public:
    explicit Multigrid(Links links) {
        levels_.push_back(std::move(links));
        while (levels_.back().east.size() > 1) {
            levels_.push_back(block_links(levels_.back()));
        }
    }

    [[nodiscard]] const Links& links() const { return levels_.front(); }

    // Approximate heights whose gradient over the links is `desired`.
    [[nodiscard]] Grid<double> approximate(const Grid<double>& desired,
                                           std::size_t level = 0) const {
        const Links& links = levels_[level];
        Grid<double> heights(links.cols(), links.rows());
        if (level + 1 == levels_.size()) {
            return heights; // the height of a single block is free
        }
        sweep_forwards(links, desired, heights);
        Grid<double> reached(links.cols(), links.rows());
        apply_links(links, heights, reached);
        Grid<double> sums((links.cols() + 1) / 2, (links.rows() + 1) / 2);
        for (int row = 0; row < links.rows(); ++row) {
            for (int col = 0; col < links.cols(); ++col) {
                sums(col / 2, row / 2) += desired(col, row) - reached(col, row);
            }
        }
        const Grid<double> blocks = approximate(sums, level + 1);
        for (int row = 0; row < links.rows(); ++row) {
            for (int col = 0; col < links.cols(); ++col) {
                heights(col, row) += correction_scale * blocks(col / 2, row / 2);
            }
        }
        sweep_backwards(links, desired, heights);
        return heights;
    }

private:
    std::vector<Links> levels_;
};

double product(const Grid<double>& a, const Grid<double>& b) {
    return std::inner_product(a.samples().begin(), a.samples().end(), b.samples().begin(), 0.0);
}

// a += scale · b
void add_scaled(Grid<double>& a, double scale, const Grid<double>& b) {
    std::transform(a.samples().begin(), a.samples().end(), b.samples().begin(), a.samples().begin(),
                   [scale](double x, double y) { return x + scale * y; });
}

void subtract_mean(Grid<double>& values) {
    const auto samples = values.samples();
    const double mean =
        std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(values.size());
    for (double& value : samples) {
        value -= mean;
    }
}

// Rise from one sample to the next along an axis.
double rise_along(glm::vec3 normal, glm::dvec2 spacing, bool south) {
    if (!(normal.z > 0.0F)) {
        return 0.0;
    }
    const double rise = south ? spacing.y * normal.y / normal.z : -spacing.x * normal.x / normal.z;
    return std::isfinite(rise) ? rise : 0.0;
}

// The negative gradient of ½ Σ (difference − rise)² at heights 0.
Grid<double> target_gradient(GridView<const glm::vec3> normals, const Links& links,
                             glm::dvec2 spacing) {
    Grid<double> desired(links.cols(), links.rows());
    const auto add_rise = [&](int col, int row, int next_col, int next_row, double weight,
                              bool south) {
        const double rise = 0.5 * weight *
                            (rise_along(normals(col, row), spacing, south) +
                             rise_along(normals(next_col, next_row), spacing, south));
        desired(next_col, next_row) += rise;
        desired(col, row) -= rise;
    };
    for (int row = 0; row < links.rows(); ++row) {
        for (int col = 0; col < links.cols(); ++col) {
            add_rise(col, row, links.next_col(col), row, links.east(col, row), false);
            add_rise(col, row, col, links.next_row(row), links.south(col, row), true);
        }
    }
    return desired;
}

Grid<float> floats_of(const Grid<double>& values) {
    Grid<float> floats(values.cols(), values.rows());
    std::transform(values.samples().begin(), values.samples().end(), floats.samples().begin(),
                   [](double value) { return static_cast<float>(value); });
    return floats;
}

} // namespace

IntegratedHeights heights_from_normals(GridView<const glm::vec3> normals,
                                       const IntegrationOptions& options) {
    check(!normals.empty(), "heights from no normals");
    check(options.spacing.x > 0.0 && options.spacing.y > 0.0, "heights without a spacing");
    const Multigrid grid(first_links(normals.cols(), normals.rows(), options.border));
    Grid<double> heights(normals.cols(), normals.rows());
    Grid<double> residual = target_gradient(normals, grid.links(), options.spacing);
    const double first = std::sqrt(product(residual, residual));
    IntegratedHeights result{{}, first > 0.0 ? 1.0 : 0.0, 0};
    Grid<double> direction = grid.approximate(residual);
    Grid<double> image(normals.cols(), normals.rows());
    double gain = product(residual, direction);
    while (result.remaining > reduction && result.rounds < max_rounds &&
           !options.stop.stop_requested() && gain > 0.0) {
        apply_links(grid.links(), direction, image);
        const double length = gain / product(direction, image);
        add_scaled(heights, length, direction);
        add_scaled(residual, -length, image);
        Grid<double> next = grid.approximate(residual);
        const double next_gain = product(residual, next);
        add_scaled(next, next_gain / gain, direction);
        direction = std::move(next);
        gain = next_gain;
        result.remaining = std::sqrt(product(residual, residual)) / first;
        ++result.rounds;
    }
    subtract_mean(heights);
    result.heights = floats_of(heights);
    return result;
}

} // namespace reljef::material
