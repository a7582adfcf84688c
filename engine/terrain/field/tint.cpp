#include "engine/terrain/field/tint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "engine/core/parallel_for.h"

namespace reljef::terrain {
namespace {

constexpr Rgba8 pale{173, 173, 171, 255}; // as the plane beside the terrain

// Whether a sample and its eight neighbours have one height.
bool is_level(const Grid<float>& heights, int col, int row) {
    const float height = heights(col, row);
    for (int r = row - 1; r <= row + 1; ++r) {
        for (int c = col - 1; c <= col + 1; ++c) {
            if (heights.clamped(c, r) != height) {
                return false;
            }
        }
    }
    return true;
}

constexpr std::array<glm::ivec2, 8> around{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

// The samples of one height that are connected with level ones, and what lies around them.
class LevelGround {
public:
    explicit LevelGround(const Heightfield& heightfield)
        : heights_(heightfield.heights), voids_(heightfield.void_mask),
          state_(heights_.cols(), heights_.rows(), unseen) {}

    void visit(int col, int row, Grid<std::uint8_t>& water) {
        if (state_(col, row) != unseen || is_void({col, row}) || !is_level(heights_, col, row)) {
            return;
        }
        samples_.assign(1, {col, row});
        state_(col, row) = seen;
        higher_ = lower_ = 0;
        for (std::size_t next = 0; next < samples_.size(); ++next) {
            spread(samples_[next]);
        }
        const float height = heights_(col, row);
        if (!is_water(height)) {
            return;
        }
        for (const glm::ivec2 sample : samples_) {
            // At the sea, the shore is land.
            if (height != 0.0F || is_level(heights_, sample.x, sample.y)) {
                water(sample.x, sample.y) = 1;
            }
        }
    }

private:
    static constexpr std::uint8_t unseen = 0;
    static constexpr std::uint8_t seen = 1;

    [[nodiscard]] bool is_void(glm::ivec2 sample) const {
        return !voids_.empty() && voids_(sample.x, sample.y) != 0;
    }
    [[nodiscard]] bool is_inside(glm::ivec2 sample) const {
        return sample.x >= 0 && sample.y >= 0 && sample.x < heights_.cols() &&
               sample.y < heights_.rows();
    }
    // An outlet, or a river that flows in, is a small part of the shore.
    [[nodiscard]] bool is_water(float height) const {
        const bool has_shore = higher_ > 0; // without, it is a plain
        const bool is_basin =
            has_shore && samples_.size() >= min_lake_samples && 20 * lower_ <= higher_;
        return height == 0.0F || is_basin;
    }
    void spread(glm::ivec2 from) {
        const float height = heights_(from.x, from.y);
        for (const glm::ivec2 step : around) {
            const glm::ivec2 to = from + step;
            if (!is_inside(to) || is_void(to)) {
                continue;
            }
            const float other = heights_(to.x, to.y);
            if (other != height) {
                ++(other > height ? higher_ : lower_);
            } else if (state_(to.x, to.y) == unseen) {
                state_(to.x, to.y) = seen;
                samples_.push_back(to);
            }
        }
    }

    const Grid<float>& heights_;
    const Grid<std::uint8_t>& voids_;
    Grid<std::uint8_t> state_;
    std::vector<glm::ivec2> samples_;
    std::size_t higher_ = 0;
    std::size_t lower_ = 0;
};

// Connected voids among seas and lakes: water, if nearly all samples around them are.
class VoidsInWater {
public:
    VoidsInWater(const Grid<std::uint8_t>& voids, Grid<std::uint8_t>& water)
        : voids_(voids), water_(water), seen_(voids.cols(), voids.rows(), 0) {}

    void visit(int col, int row) {
        samples_.clear();
        wet_ = dry_ = 0;
        meet({col, row});
        for (std::size_t next = 0; next < samples_.size(); ++next) {
            for (const glm::ivec2 step : around) {
                meet(samples_[next] + step);
            }
        }
        if (wet_ > 0 && 20 * dry_ <= wet_) {
            for (const glm::ivec2 sample : samples_) {
                water_(sample.x, sample.y) = 1;
            }
        }
    }

private:
    void meet(glm::ivec2 at) {
        const bool is_inside =
            at.x >= 0 && at.y >= 0 && at.x < voids_.cols() && at.y < voids_.rows();
        if (!is_inside) {
            return;
        }
        if (voids_(at.x, at.y) == 0) {
            ++(water_(at.x, at.y) != 0 ? wet_ : dry_);
        } else if (seen_(at.x, at.y) == 0) {
            seen_(at.x, at.y) = 1;
            samples_.push_back(at);
        }
    }

    const Grid<std::uint8_t>& voids_;
    Grid<std::uint8_t>& water_;
    Grid<std::uint8_t> seen_;
    std::vector<glm::ivec2> samples_;
    std::size_t wet_ = 0; // around the voids
    std::size_t dry_ = 0;
};

// The connected voids that reach the border.
class OutsideVoids {
public:
    explicit OutsideVoids(const Grid<std::uint8_t>& voids)
        : voids_(voids), outside_(voids.cols(), voids.rows(), 0) {}

    void visit_border() {
        for (int col = 0; col < voids_.cols(); ++col) {
            visit({col, 0});
            visit({col, voids_.rows() - 1});
        }
        for (int row = 0; row < voids_.rows(); ++row) {
            visit({0, row});
            visit({voids_.cols() - 1, row});
        }
    }
    [[nodiscard]] bool has_any() const { return has_any_; }
    Grid<std::uint8_t> take() { return std::move(outside_); }

private:
    void visit(glm::ivec2 from) {
        samples_.clear();
        add(from);
        for (std::size_t next = 0; next < samples_.size(); ++next) {
            for (const glm::ivec2 step : around) {
                add(samples_[next] + step);
            }
        }
        constexpr std::size_t min_share = 1000; // of all samples
        if (!samples_.empty() && min_share * samples_.size() >= voids_.size()) {
            has_any_ = true;
        } else {
            for (const glm::ivec2 sample : samples_) {
                outside_(sample.x, sample.y) = small;
            }
        }
    }
    void add(glm::ivec2 at) {
        const bool is_inside =
            at.x >= 0 && at.y >= 0 && at.x < voids_.cols() && at.y < voids_.rows();
        if (is_inside && voids_(at.x, at.y) != 0 && outside_(at.x, at.y) == 0) {
            outside_(at.x, at.y) = 1;
            samples_.push_back(at);
        }
    }

    static constexpr std::uint8_t small = 2;
    const Grid<std::uint8_t>& voids_;
    Grid<std::uint8_t> outside_;
    std::vector<glm::ivec2> samples_;
    bool has_any_ = false;
};

void add_voids_in_water(const Grid<std::uint8_t>& voids, Grid<std::uint8_t>& water) {
    VoidsInWater filled(voids, water);
    for (int row = 0; row < voids.rows(); ++row) {
        for (int col = 0; col < voids.cols(); ++col) {
            if (voids(col, row) != 0 && water(col, row) == 0) {
                filled.visit(col, row);
            }
        }
    }
}

glm::vec2 gradient_at(const Heightfield& heightfield, int col, int row) {
    const Grid<float>& heights = heightfield.heights;
    const glm::vec2 spacing(heightfield.spacing);
    const auto change = [](float ahead, float behind, int steps, float step) {
        return steps > 0 ? (ahead - behind) / (static_cast<float>(steps) * step) : 0.0F;
    };
    const int east = std::min(col + 1, heights.cols() - 1);
    const int west = std::max(col - 1, 0);
    const int south = std::min(row + 1, heights.rows() - 1);
    const int north = std::max(row - 1, 0);
    return {change(heights(east, row), heights(west, row), east - west, spacing.x),
            change(heights(col, north), heights(col, south), south - north, spacing.y)};
}

glm::vec3 vector_from(Rgba8 color) {
    return {color.r, color.g, color.b};
}

// The pixel of `beneath` at the place of a pixel of `over`. Both images cover the same ground.
Rgba8 nearest(const Image& beneath, const Image& over, int col, int row) {
    const auto scaled = [](int index, int from, int to) {
        return from > 1 ? static_cast<int>(
                              std::lround(static_cast<double>(index) * (to - 1) / (from - 1)))
                        : 0;
    };
    return beneath(scaled(col, over.cols(), beneath.cols()),
                   scaled(row, over.rows(), beneath.rows()));
}

} // namespace

HeightTint::HeightTint(const ColorRamp& ramp, const Heightfield& heightfield)
    : colors_(ramp, heightfield), has_water_(ramp.has_water),
      no_data_(ramp.no_data.value_or(pale)) {}

Grid<std::uint8_t> water_mask(const Heightfield& heightfield) {
    const Grid<float>& heights = heightfield.heights;
    Grid<std::uint8_t> water(heights.cols(), heights.rows(), 0);
    LevelGround level(heightfield);
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            level.visit(col, row, water);
        }
    }
    if (!heightfield.void_mask.empty()) {
        add_voids_in_water(heightfield.void_mask, water);
    }
    return water;
}

Grid<std::uint8_t> no_data_mask(const Heightfield& heightfield, const ColorRamp& ramp) {
    if (heightfield.void_mask.empty() || ramp.no_data) {
        return heightfield.void_mask;
    }
    OutsideVoids outside(heightfield.void_mask);
    outside.visit_border();
    if (!outside.has_any()) {
        return {};
    }
    Grid<std::uint8_t> mask = outside.take();
    for (std::uint8_t& of_sample : mask.samples()) {
        of_sample = of_sample == 1 ? 1 : 0;
    }
    return mask;
}

Image hypsometric_tint(const Heightfield& heightfield, const ColorRamp& ramp) {
    const auto& heights = heightfield.heights;
    const HeightTint tint(ramp, heightfield);
    const Grid<std::uint8_t> water =
        tint.has_water() ? water_mask(heightfield) : Grid<std::uint8_t>();
    const Grid<std::uint8_t> no_data = no_data_mask(heightfield, ramp);
    Image image(heights.cols(), heights.rows());
    parallel_for(image.rows(), [&](int row) {
        for (int col = 0; col < image.cols(); ++col) {
            const bool has_data = no_data.empty() || no_data(col, row) == 0;
            image(col, row) = !has_data ? tint.no_data()
                              : !water.empty() && water(col, row) != 0
                                  ? HeightTint::water
                                  : tint.at(heights(col, row), gradient_at(heightfield, col, row));
        }
    });
    return image;
}

Rgba8 mixed(Rgba8 under, Rgba8 over, float share) {
    return rgba8(glm::mix(vector_from(under), vector_from(over), share));
}

Image composite(const Image& color, const Image& beneath, double share) {
    if (color.empty()) {
        return beneath;
    }
    Image result = color;
    const float part = static_cast<float>(share) / 255.0F;
    for (int row = 0; row < result.rows(); ++row) {
        for (int col = 0; col < result.cols(); ++col) {
            Rgba8& pixel = result(col, row);
            if (pixel.a < 255 || share < 1.0) {
                pixel = mixed(nearest(beneath, color, col, row), pixel,
                              static_cast<float>(pixel.a) * part);
            }
        }
    }
    return result;
}

} // namespace reljef::terrain
