#include "engine/scene/motion/ground_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>

#include "engine/core/check.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::scene {
namespace {

// An ellipsoid above samples: above an offset d from its centre, in samples, its lower half is
// half_height · sqrt(1 − dᵀ·metric·d) metres below the centre.
struct Footprint {
    glm::dvec2 center{0.0}; // col, row
    glm::dmat2 metric{1.0};
    double half_height = 0.0;
    double exaggeration = 1.0;
    glm::dvec3 along_col{0.0}; // horizontal metres per sample
    glm::dvec3 along_row{0.0};

    // Half of the extent along columns and rows, in samples.
    [[nodiscard]] glm::dvec2 extent() const {
        const double determinant = glm::determinant(metric);
        return {std::sqrt(metric[1][1] / determinant), std::sqrt(metric[0][0] / determinant)};
    }
};

// Where the ellipsoid touches if it comes from above.
struct Touch {
    double height = -HUGE_VAL; // of the centre, metres with exaggeration
    glm::dvec2 offset{0.0};    // of the place from the centre, in samples

    [[nodiscard]] bool is_there() const { return height > -HUGE_VAL; }
};

void add(Touch& highest, const Touch& other) {
    if (other.height > highest.height) {
        highest = other;
    }
}

// One cell of a grid below an ellipsoid.
class CellBelow {
public:
    CellBelow(GridView<const float> heights, const Footprint& footprint, glm::ivec2 cell)
        : footprint_(footprint), low_(glm::dvec2(cell) - footprint.center), high_(low_ + 1.0) {
        for (int i = 0; i < 4; ++i) {
            corners_[static_cast<std::size_t>(i)] =
                footprint.exaggeration * heights(cell.x + i % 2, cell.y + i / 2);
        }
    }

    // Upper bound of the height at which the ellipsoid touches the cell.
    [[nodiscard]] double bound() const {
        const glm::dvec2 near = glm::clamp(glm::dvec2(0.0), low_, high_);
        const glm::dvec2 shares = near / footprint_.extent();
        const double nearest = std::max(shares.x * shares.x, shares.y * shares.y);
        return nearest < 1.0 ? *std::max_element(corners_.begin(), corners_.end()) +
                                   footprint_.half_height * std::sqrt(1.0 - nearest)
                             : -HUGE_VAL;
    }

    [[nodiscard]] Touch touch() const {
        const double begin = std::max(low_.y, farthest(-1.0));
        const double end = std::min(high_.y, farthest(1.0));
        // Lines across a cell touch at heights that are concave from line to line, unless the cell
        // is twisted more than the ellipsoid is bent.
        const int parts = is_concave() ? 1 : 16;
        Touch highest;
        for (int i = 0; i < parts && begin <= end; ++i) {
            const double step = (end - begin) / parts;
            add(highest, touch_between(begin + i * step, begin + (i + 1) * step));
        }
        return highest;
    }

private:
    [[nodiscard]] bool is_concave() const {
        const double twist = corners_[0] - corners_[1] - corners_[2] + corners_[3];
        const glm::dmat2& metric = footprint_.metric;
        return std::abs(twist) < footprint_.half_height * (std::sqrt(metric[0][0] * metric[1][1]) -
                                                           std::abs(metric[0][1]));
    }

    // The farthest line that the ellipsoid reaches within the cell's columns; `side`: 1 or -1.
    [[nodiscard]] double farthest(double side) const {
        const glm::dmat2& metric = footprint_.metric;
        const double top = -side * metric[0][1] / metric[0][0] * footprint_.extent().y;
        const double x = std::clamp(top, low_.x, high_.x);
        const double root =
            metric[0][1] * x * metric[0][1] * x - metric[1][1] * (metric[0][0] * x * x - 1.0);
        return root >= 0.0 ? (side * std::sqrt(root) - metric[0][1] * x) / metric[1][1]
                           : -side * HUGE_VAL;
    }

    // The highest touch among lines along columns; `begin`, `end`: offsets from the centre. Lines
    // beyond the ellipsoid, by rounding, count as far below.
    [[nodiscard]] Touch touch_between(double begin, double end) const {
        constexpr int rounds = 52; // to the last bits of the interval
        Touch highest = touch_on(begin);
        const Touch last = touch_on(end);
        const bool rises = !highest.is_there() || is_rising(highest.offset);
        const bool falls = !last.is_there() || !is_rising(last.offset);
        if (!rises || !falls) {
            add(highest, last);
            return highest;
        }
        for (int i = 0; i < rounds; ++i) {
            const double middle = 0.5 * (begin + end);
            highest = touch_on(middle);
            (highest.is_there() && is_rising(highest.offset) ? begin : end) = middle;
        }
        return highest;
    }

    // Whether touches rise from line to line at the highest touch of its line.
    [[nodiscard]] bool is_rising(glm::dvec2 offset) const {
        const glm::dvec2 along = footprint_.metric * offset;
        const double below = std::sqrt(std::max(1.0 - glm::dot(offset, along), 0.0));
        const double part = offset.x - low_.x;
        const double slope =
            (1.0 - part) * (corners_[2] - corners_[0]) + part * (corners_[3] - corners_[1]);
        return slope * below > footprint_.half_height * along.y;
    }

    // On a line along columns the surface is straight and the ellipsoid an ellipse.
    [[nodiscard]] Touch touch_on(double y) const {
        const glm::dmat2& metric = footprint_.metric;
        const double scale = std::sqrt(metric[0][0]); // of w = scale · (x + lean · y)
        const double lean = metric[0][1] / metric[0][0];
        const double left_over = 1.0 - y * y * (metric[1][1] - metric[0][1] * lean);
        const double reach = std::sqrt(std::max(left_over, 0.0));
        const double begin = std::max(scale * (low_.x + lean * y), -reach);
        const double end = std::min(scale * (high_.x + lean * y), reach);
        if (!(begin <= end)) {
            return {};
        }
        const double part = std::clamp(y - low_.y, 0.0, 1.0);
        const double west = (1.0 - part) * corners_[0] + part * corners_[2];
        const double east = (1.0 - part) * corners_[1] + part * corners_[3];
        const double slope = (east - west) / scale;
        const double top = slope * reach / std::hypot(footprint_.half_height, slope);
        const double w = std::clamp(top, begin, end);
        const double x = w / scale - lean * y;
        const double below =
            footprint_.half_height * std::sqrt(std::max(reach * reach - w * w, 0.0));
        return {west + (east - west) * (x - low_.x) + below, {x, y}};
    }

    const Footprint& footprint_;
    glm::dvec2 low_; // offsets of the cell's corners from the centre
    glm::dvec2 high_;
    std::array<double, 4> corners_{}; // heights with exaggeration
};

Touch touch_on_grid(GridView<const float> heights, const Footprint& footprint) {
    const glm::ivec2 last(heights.cols() - 2, heights.rows() - 2); // cells
    const glm::dvec2 low = footprint.center - footprint.extent();
    const glm::dvec2 high = footprint.center + footprint.extent();
    if (high.x < 0.0 || high.y < 0.0 || low.x > last.x + 1 || low.y > last.y + 1) {
        return {};
    }
    Touch highest;
    for (int row = clamped_int(low.y, 0, last.y); row <= clamped_int(high.y, 0, last.y); ++row) {
        for (int col = clamped_int(low.x, 0, last.x); col <= clamped_int(high.x, 0, last.x);
             ++col) {
            const CellBelow cell(heights, footprint, {col, row});
            if (cell.bound() > highest.height) {
                add(highest, cell.touch());
            }
        }
    }
    return highest;
}

// Metres from a place to the one a sample farther along columns or rows, without their rise.
glm::dvec3 level_step(const terrain::Placement& placement, glm::dvec3 sample, glm::dvec3 step) {
    const glm::dvec3 way = placement.world_from_sample(sample + 0.5 * step) -
                           placement.world_from_sample(sample - 0.5 * step);
    const glm::dvec3 up = placement.up(placement.world_from_sample(sample));
    return way - glm::dot(way, up) * up;
}

Footprint footprint_of(const Ellipsoid& ellipsoid, const terrain::Placement& placement,
                       glm::dvec3 sample) {
    Footprint footprint;
    footprint.center = glm::dvec2(sample);
    footprint.along_col = level_step(placement, sample, {1.0, 0.0, 0.0});
    footprint.along_row = level_step(placement, sample, {0.0, 1.0, 0.0});
    const double mixed = glm::dot(footprint.along_col, footprint.along_row);
    footprint.metric = glm::dmat2(glm::dot(footprint.along_col, footprint.along_col), mixed, mixed,
                                  glm::dot(footprint.along_row, footprint.along_row)) /
                       (ellipsoid.radius * ellipsoid.radius);
    footprint.half_height = ellipsoid.half_height;
    footprint.exaggeration = placement.exaggeration();
    return footprint;
}

// A touch of one of the grids below an ellipsoid.
struct TouchedGrid {
    Touch touch;
    Footprint footprint;
};

void add_grid(std::optional<TouchedGrid>& highest, GridView<const float> heights,
              const Footprint& footprint) {
    const Touch touch = touch_on_grid(heights, footprint);
    if (touch.height > (highest ? highest->touch.height : -HUGE_VAL)) {
        highest = TouchedGrid{touch, footprint};
    }
}

// The tiles below an ellipsoid, from a coarse one to the finest loaded ones.
class TilesBelow {
public:
    TilesBelow(const TileStream& stream, const Ellipsoid& ellipsoid, glm::dvec3 center)
        : stream_(stream), ellipsoid_(ellipsoid), center_(center) {}

    [[nodiscard]] bool add(std::optional<TouchedGrid>& highest, terrain::TreeTile id) const {
        const auto tile = stream_.find(id);
        if (tile == nullptr) {
            return false;
        }
        const auto sample = tile->placement->sample_from_world(center_);
        if (!sample) {
            return true;
        }
        const Footprint footprint = footprint_of(ellipsoid_, *tile->placement, *sample);
        if (!is_below(*tile, footprint)) {
            return true;
        }
        std::optional<TouchedGrid> of_children;
        const auto children = stream_.tree().children(id);
        const bool is_refined =
            !children.empty() && std::all_of(children.begin(), children.end(),
                                             [&](auto child) { return add(of_children, child); });
        if (!is_refined) {
            add_grid(highest, tile->heightfield.heights.view(), footprint);
        }
        if (of_children) {
            highest = !highest || of_children->touch.height > highest->touch.height ? of_children
                                                                                    : highest;
        }
        return true;
    }

private:
    static bool is_below(const TerrainTile& tile, const Footprint& footprint) {
        const Grid<float>& heights = tile.heightfield.heights;
        const glm::dvec2 low = footprint.center - footprint.extent();
        const glm::dvec2 high = footprint.center + footprint.extent();
        return high.x >= 0.0 && high.y >= 0.0 && low.x <= heights.cols() - 1 &&
               low.y <= heights.rows() - 1;
    }

    const TileStream& stream_;
    const Ellipsoid& ellipsoid_;
    glm::dvec3 center_;
};

bool is_on(const TerrainSurface& surface, glm::dvec3 sample) {
    const Grid<float>& heights = surface.heightfield().heights;
    return sample.x >= 0.0 && sample.y >= 0.0 && sample.x <= heights.cols() - 1 &&
           sample.y <= heights.rows() - 1;
}

std::optional<TouchedGrid> find_touch(const TerrainNode& terrain, const Ellipsoid& ellipsoid,
                                      glm::dvec3 center, glm::dvec3 sample) {
    std::optional<TouchedGrid> highest;
    const TileStream* const stream = terrain.stream.get();
    if (stream == nullptr ||
        !TilesBelow(*stream, ellipsoid, center).add(highest, stream->tree().root())) {
        const TerrainSurface& surface = *terrain.surface;
        add_grid(highest, surface.heightfield().heights.view(),
                 footprint_of(ellipsoid, surface.placement(), sample));
    }
    return highest;
}

} // namespace

std::optional<GroundContact> ground_contact(const TerrainNode& terrain, const Ellipsoid& ellipsoid,
                                            glm::dvec3 center) {
    check(ellipsoid.radius > 0.0 && ellipsoid.half_height > 0.0, "an ellipsoid was expected");
    const terrain::Placement& placement = terrain.surface->placement();
    const bool is_place =
        std::isfinite(center.x) && std::isfinite(center.y) && std::isfinite(center.z);
    const auto sample = is_place ? placement.sample_from_world(center) : std::nullopt;
    if (!sample || !is_on(*terrain.surface, *sample)) {
        return std::nullopt;
    }
    const auto found = find_touch(terrain, ellipsoid, center, *sample);
    if (!found) {
        return std::nullopt;
    }
    const Footprint& footprint = found->footprint;
    const glm::dvec2 offset = found->touch.offset;
    const glm::dvec3 aside = offset.x * footprint.along_col + offset.y * footprint.along_row;
    const double share = glm::dot(offset, footprint.metric * offset);
    const double below = std::sqrt(std::max(1.0 - share, 0.0)) / ellipsoid.half_height;
    const glm::dvec3 normal =
        below * placement.up(center) - aside / (ellipsoid.radius * ellipsoid.radius);
    return GroundContact{found->touch.height - placement.exaggeration() * sample->z,
                         glm::normalize(normal)};
}

} // namespace reljef::scene
