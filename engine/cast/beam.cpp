#include "engine/cast/beam.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/common.hpp>

#include "engine/cast/packet/block_kernel.h"

namespace reljef::cast {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

// Floats have errors of 2^-24 of the distance from the rays' anchor, and a ray adds a few of them.
constexpr double rounding = 0x1p-20;

// All rays of a block: bounds of their origins and directions.
struct Beam {
    Box origins;
    Box directions;

    [[nodiscard]] glm::dvec3 low(double t) const {
        return origins.low + t * (t < 0.0 ? directions.high : directions.low);
    }
    [[nodiscard]] glm::dvec3 high(double t) const {
        return origins.high + t * (t < 0.0 ? directions.low : directions.high);
    }
};

Beam beam_of(const PictureRays& rays, const PixelBlock& block) {
    Beam beam;
    for (int i = 0; i < 4; ++i) {
        const glm::dvec2 corner(block.first + block.size * glm::ivec2(i & 1, i >> 1));
        beam.origins.add(rays.origin.at(corner));
        beam.directions.add(rays.direction.at(corner));
    }
    const auto widen = [&](const PictureRays::Vectors& vectors, Box& box) {
        const glm::dvec3 bulge = vectors.bulge(glm::dvec2(block.size));
        box = {box.low - bulge, box.high + bulge};
    };
    widen(rays.origin, beam.origins);
    widen(rays.direction, beam.directions);
    return beam;
}

class BeamWalk {
public:
    BeamWalk(const RayTile& tile, const Beam& beam, double anchor)
        : tile_(tile), beam_(beam), anchor_(anchor), last_(tile.cells()),
          speed_(std::max({std::abs(beam.directions.low.x), std::abs(beam.directions.high.x),
                           std::abs(beam.directions.low.y), std::abs(beam.directions.high.y),
                           std::numeric_limits<double>::min()})),
          lift_(rounding * (std::max(std::abs(tile.total().low), std::abs(tile.total().high)) +
                            std::abs(beam.low(anchor).z))) {}

    double run(double begin) {
        t_ = begin;
        if (!fall_to_top() || !reach_tile(0) || !reach_tile(1)) {
            return never;
        }
        t_ = std::max(begin, before(t_));
        return advance() ? std::max(begin, before(t_)) : never;
    }

private:
    [[nodiscard]] double before(double t) const { return t - rounding * std::abs(t - anchor_); }

    // The t at which the first ray is as low as the surface's highest place.
    bool fall_to_top() {
        const double above = beam_.low(t_).z - (tile_.total().high + lift_);
        const double down = beam_.directions.low.z;
        if (above > 0.0) {
            t_ = down < 0.0 ? t_ - above / down : never;
        }
        return t_ < never;
    }

    // The t at which the first ray is over the tile, along one axis.
    bool reach_tile(int axis) {
        const double before_it = -margin(t_) - beam_.high(t_)[axis];
        const double behind_it = beam_.low(t_)[axis] - (last_[axis] + margin(t_));
        if (before_it > 0.0) {
            const double on = beam_.directions.high[axis];
            t_ = on > 0.0 ? t_ + before_it / on : never;
        } else if (behind_it > 0.0) {
            const double back = beam_.directions.low[axis];
            t_ = back < 0.0 ? t_ - behind_it / back : never;
        }
        return t_ < never;
    }

    // Samples by which rounded rays may miss their place.
    [[nodiscard]] double margin(double t) const {
        return rounding * (1.0 + speed_ * std::abs(t - anchor_));
    }

    // Steps on as long as nothing can be hit; steps double in free space, and halve where the beam
    // may hit, down to half its width. False beyond the tile.
    bool advance() {
        constexpr int max_steps = 64;
        constexpr double first_step = 8.0; // samples
        double step = first_step;
        for (int i = 0; i < max_steps; ++i) {
            const auto clear = is_clear(t_ + step / speed_);
            if (!clear) {
                return false;
            }
            if (*clear) {
                t_ += step / speed_;
                step *= 2.0;
            } else {
                step *= 0.5;
                if (step < smallest_step()) {
                    return true;
                }
            }
        }
        return true;
    }

    [[nodiscard]] double smallest_step() const {
        const glm::dvec2 width(beam_.high(t_) - beam_.low(t_));
        return std::max(0.5 * std::max(width.x, width.y), 0.5);
    }

    // Whether no ray can hit between t_ and `end`; absent: all have left the tile.
    [[nodiscard]] std::optional<bool> is_clear(double end) const {
        if (!(end < never)) {
            return false;
        }
        const double wider = margin(end);
        const glm::dvec2 low = glm::min(glm::dvec2(beam_.low(t_)), glm::dvec2(beam_.low(end)));
        const glm::dvec2 high = glm::max(glm::dvec2(beam_.high(t_)), glm::dvec2(beam_.high(end)));
        for (int axis = 0; axis < 2; ++axis) {
            if ((high[axis] < -wider && beam_.directions.high[axis] <= 0.0) ||
                (low[axis] > last_[axis] + wider && beam_.directions.low[axis] >= 0.0)) {
                return std::nullopt;
            }
        }
        const double lowest = std::min(beam_.low(t_).z, beam_.low(end).z);
        if (lowest > tile_.total().high + lift_ && beam_.directions.low.z >= 0.0) {
            return std::nullopt;
        }
        return lowest > tile_.max_within(cell_at(low - wider), cell_at(high + wider)) + lift_;
    }

    [[nodiscard]] glm::ivec2 cell_at(glm::dvec2 place) const {
        return {clamped_int(place.x, 0, last_.x - 1), clamped_int(place.y, 0, last_.y - 1)};
    }

    const RayTile& tile_;
    const Beam& beam_;
    double anchor_;
    glm::ivec2 last_;
    double speed_; // samples per t
    double lift_;  // metres by which rounded rays may miss their height
    double t_ = 0.0;
};

} // namespace

glm::ivec2 part_size(glm::ivec2 size) {
    constexpr glm::ivec2 beam(beam_cols, beam_rows);
    const bool is_beam = size.x <= beam.x && size.y <= beam.y;
    return is_beam ? glm::max(size / 2, glm::ivec2(1)) : glm::max(size / 2, beam);
}

double clear_until(const RayTile& tile, const PictureRays& rays, const PixelBlock& block,
                   double begin) {
    if (tile.cells().x < 1 || tile.cells().y < 1) {
        return never;
    }
    const Beam beam = beam_of(rays, block);
    return BeamWalk(tile, beam, rays.anchor).run(begin);
}

} // namespace reljef::cast
