#include "engine/scene/streaming/certain_sun.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include "engine/core/check.h"

namespace reljef::scene {
namespace {

constexpr double none = -std::numeric_limits<double>::infinity();

// The cells as seen from the sun: `along` counts away from it, so that rays lead from high numbers
// to 0; `across` counts the lines of cells that rays cross less often.
class SunwardCells {
public:
    SunwardCells(GridView<const float> heights, glm::dvec3 to_sun)
        : heights_(heights), cells_(heights.cols() - 1, heights.rows() - 1),
          main_(std::abs(to_sun.x) >= std::abs(to_sun.y) ? 0 : 1), to_sun_(to_sun) {}

    [[nodiscard]] int along() const { return cells_[main_]; }
    [[nodiscard]] int across() const { return cells_[1 - main_]; }
    // Lines across that a ray moves on its way over one cell along.
    [[nodiscard]] double drift() const {
        const double step = std::abs(to_sun_[main_]);
        return step > 0.0 ? to_sun_[1 - main_] / step : 0.0;
    }
    // Metres that a ray rises on the same way.
    [[nodiscard]] double rise() const {
        const double step = std::abs(to_sun_[main_]);
        return step > 0.0 ? to_sun_.z / step : std::numeric_limits<double>::infinity();
    }

    [[nodiscard]] glm::ivec2 cell(int from_sun, int line) const {
        glm::ivec2 cell(0);
        cell[main_] = to_sun_[main_] >= 0.0 ? cells_[main_] - 1 - from_sun : from_sun;
        cell[1 - main_] = line;
        return cell;
    }

    struct Corners {
        double h00, h10, h01, h11;

        [[nodiscard]] double high() const { return std::max({h00, h10, h01, h11}); }
        [[nodiscard]] double low() const { return std::min({h00, h10, h01, h11}); }
    };
    [[nodiscard]] Corners corners(int from_sun, int line) const {
        const glm::ivec2 at = cell(from_sun, line);
        return {heights_(at.x, at.y), heights_(at.x + 1, at.y), heights_(at.x, at.y + 1),
                heights_(at.x + 1, at.y + 1)};
    }

    // Whether the surface of a cell rises less than the rays everywhere.
    [[nodiscard]] bool falls_behind(int from_sun, int line) const {
        const Corners h = corners(from_sun, line);
        const double cols = std::max(to_sun_.x * (h.h10 - h.h00), to_sun_.x * (h.h11 - h.h01));
        const double rows = std::max(to_sun_.y * (h.h01 - h.h00), to_sun_.y * (h.h11 - h.h10));
        return cols + rows < to_sun_.z;
    }

private:
    GridView<const float> heights_;
    glm::ivec2 cells_;
    int main_; // axis
    glm::dvec3 to_sun_;
};

struct Lines {
    int first = 0;
    int last = 0;
};

// Those with places in [low, high], and those that rounded rays touch instead.
Lines lines_between(double low, double high) {
    constexpr double rounding = 0x1p-10; // cells
    return {static_cast<int>(std::floor(low - rounding)),
            static_cast<int>(std::floor(high + rounding))};
}

// Strip q covers the places q + drift · (cells from the sun's side) to q + 1 + …: rays stay in it.
class Sweep {
public:
    Sweep(const SunwardCells& cells, const SunRays& rays)
        : cells_(cells), lift_(rays.max_lift), max_variation_(rays.max_variation),
          first_strip_(static_cast<int>(std::floor(-std::abs(cells.drift()) * cells.along())) - 2),
          strips_(cells.across() - 2 * first_strip_) {
        const auto count = static_cast<std::size_t>(strips_);
        for (Bounds& bounds : ahead_) {
            bounds = {std::vector<double>(count, none), std::vector<double>(count, none)};
        }
    }

    Grid<CertainSun> run(GridView<const float> heights) {
        Grid<CertainSun> known(heights.cols() - 1, heights.rows() - 1, CertainSun::unknown);
        for (int from_sun = 0; from_sun < cells_.along(); ++from_sun) {
            for (int line = 0; line < cells_.across(); ++line) {
                const glm::ivec2 cell = cells_.cell(from_sun, line);
                known(cell.x, cell.y) = known_of(from_sun, line);
            }
            add_row(from_sun);
        }
        return known;
    }

private:
    // Heights that rays of each strip pass, from a line of cells on, less what they rise from it.
    struct Bounds {
        std::vector<double> high; // no ray passes a higher one
        std::vector<double> low;  // each ray passes one that is as high
    };

    // The place across of the near side of a line of cells in strip 0. Rays move by the drift as
    // `from_sun` falls.
    [[nodiscard]] double place_of(int from_sun) const { return -cells_.drift() * from_sun; }

    [[nodiscard]] std::size_t index_of(int strip) const {
        return static_cast<std::size_t>(std::clamp(strip - first_strip_, 0, strips_ - 1));
    }

    // The lines of cells that a strip's rays pass on their way over the cells `from_sun`.
    [[nodiscard]] Lines lines_of(int strip, int from_sun) const {
        const double begin = strip + place_of(from_sun + 1);
        const double end = strip + place_of(from_sun);
        return lines_between(std::min(begin, end), std::max(begin, end) + 1.0);
    }

    // The strips of the rays through a cell.
    [[nodiscard]] Lines strips_of(int from_sun, int line) const {
        const double begin = place_of(from_sun + 1);
        const double end = place_of(from_sun);
        return lines_between(line - std::max(begin, end), line + 1.0 - std::min(begin, end));
    }

    void add_row(int from_sun) {
        std::swap(ahead_[0], ahead_[1]); // [1] begins a cell nearer to the sun
        for (int i = 0; i < strips_; ++i) {
            const Lines lines = lines_of(first_strip_ + i, from_sun);
            double high = none;
            double low = std::numeric_limits<double>::infinity();
            for (int line = lines.first; line <= lines.last; ++line) {
                const bool is_inside = line >= 0 && line < cells_.across();
                const auto corners = is_inside ? cells_.corners(from_sun, line)
                                               : SunwardCells::Corners{none, none, none, none};
                high = std::max(high, corners.high());
                low = std::min(low, corners.low());
            }
            const auto at = static_cast<std::size_t>(i);
            ahead_[0].high[at] = std::max(high, ahead_[1].high[at] - cells_.rise());
            ahead_[0].low[at] = std::max(low, ahead_[1].low[at] - cells_.rise());
        }
    }

    // ahead_[0] begins at the next cells, ahead_[1] behind them.
    [[nodiscard]] CertainSun known_of(int from_sun, int line) const {
        if (variation_around(from_sun, line) > max_variation_) {
            return CertainSun::unknown;
        }
        const SunwardCells::Corners corners = cells_.corners(from_sun, line);
        const Lines strips = strips_of(from_sun, line);
        double high = none;
        double low = std::numeric_limits<double>::infinity();
        for (int strip = strips.first; strip <= strips.last; ++strip) {
            high = std::max(high, ahead_[1].high[index_of(strip)]);
            low = std::min(low, ahead_[0].low[index_of(strip)]);
        }
        // A ray is at the next cells after at most two, and behind them after at least one.
        if (low - 2.0 * cells_.rise() > corners.high() + lift_) {
            return CertainSun::dark;
        }
        const bool is_under = high - cells_.rise() < corners.low();
        return is_under && is_open_nearby(from_sun, line) ? CertainSun::lit : CertainSun::unknown;
    }

    // The largest difference of heights within a cell or one of its neighbours, metres.
    [[nodiscard]] double variation_around(int from_sun, int line) const {
        double largest = 0.0;
        for (int cell = std::max(from_sun - 1, 0);
             cell <= std::min(from_sun + 1, cells_.along() - 1); ++cell) {
            for (int other = std::max(line - 1, 0);
                 other <= std::min(line + 1, cells_.across() - 1); ++other) {
                const SunwardCells::Corners corners = cells_.corners(cell, other);
                largest = std::max(largest, corners.high() - corners.low());
            }
        }
        return largest;
    }

    // Whether no ray meets the surface in its own cells and the next ones.
    [[nodiscard]] bool is_open_nearby(int from_sun, int line) const {
        const double reach = 2.0 * cells_.drift();
        const Lines lines =
            lines_between(line + std::min(reach, 0.0), line + 1.0 + std::max(reach, 0.0));
        for (int cell = from_sun; cell >= std::max(from_sun - 1, 0); --cell) {
            const int last = std::min(lines.last, cells_.across() - 1);
            for (int other = std::max(lines.first, 0); other <= last; ++other) {
                if (!cells_.falls_behind(cell, other)) {
                    return false;
                }
            }
        }
        return true;
    }

    const SunwardCells& cells_;
    double lift_;
    double max_variation_;
    int first_strip_;
    int strips_;
    Bounds ahead_[2];
};

} // namespace

Grid<CertainSun> certain_sun(GridView<const float> heights, const SunRays& rays) {
    check(rays.to_sun.z > 0.0 && heights.cols() > 1 && heights.rows() > 1, "a sun above cells");
    const SunwardCells cells(heights, rays.to_sun);
    if (!std::isfinite(cells.rise())) { // above: slopes are finite
        return Grid<CertainSun>(heights.cols() - 1, heights.rows() - 1, CertainSun::lit);
    }
    return Sweep(cells, rays).run(heights);
}

std::optional<glm::dvec3> sun_in_samples(const terrain::Placement& placement,
                                         const TerrainLight& light) {
    if (placement.kind() != terrain::PlacementKind::plane) {
        return std::nullopt;
    }
    const glm::dvec3 local = glm::inverse(light.world_from_local) * to_light(light.sun);
    const glm::dvec2 spacing = placement.spacing();
    const glm::dvec3 to_sun(local.x / spacing.x, -local.y / spacing.y,
                            local.z / placement.exaggeration());
    return to_sun.z > 0.0 ? std::optional(to_sun) : std::nullopt;
}

} // namespace reljef::scene
