#include "engine/terrain/field/sky_share.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/core/parallel_for.h"

namespace reljef::terrain {
namespace {

// Half of the directions; each line is swept both ways. Every sample is on one line of a direction.
constexpr std::array<glm::ivec2, 8> steps{
    {{1, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 1}, {-1, 2}, {-1, 1}, {-2, 1}}};

double angle_of(glm::ivec2 step, glm::dvec2 spacing) {
    return std::atan2(step.y * spacing.y, step.x * spacing.x);
}

// The part of half the circle that a direction stands for.
double weight_of(std::size_t index, glm::dvec2 spacing) {
    const std::size_t count = steps.size();
    const double half = std::numbers::pi;
    const double next = index + 1 < count ? angle_of(steps[index + 1], spacing)
                                          : angle_of(steps[0], spacing) + half;
    const double last = index > 0 ? angle_of(steps[index - 1], spacing)
                                  : angle_of(steps[count - 1], spacing) - half;
    return 0.5 * (next - last) / half;
}

struct HullPoint {
    float place = 0.0F; // metres along the line
    float height = 0.0F;
};

// The convex hull of the ground that a sweep has passed.
class Hull {
public:
    explicit Hull(std::size_t capacity) : points_(capacity) {}

    void clear() { count_ = 0; }

    // The steepest slope from a new point back to the ground, at least 0; then adds the point.
    float add(HullPoint point) {
        while (count_ >= 2 &&
               slope(point, points_[count_ - 1]) <= slope(point, points_[count_ - 2])) {
            --count_;
        }
        const float steepest = count_ > 0 ? slope(point, points_[count_ - 1]) : 0.0F;
        points_[count_++] = point;
        return std::max(steepest, 0.0F);
    }

private:
    static float slope(HullPoint from, HullPoint to) {
        return (to.height - from.height) / (from.place - to.place);
    }

    std::vector<HullPoint> points_;
    std::size_t count_ = 0;
};

// All lines along a direction: their first samples.
std::vector<glm::ivec2> first_samples(glm::ivec2 size, glm::ivec2 step) {
    std::vector<glm::ivec2> firsts;
    for (int row = 0; row < size.y; ++row) {
        const bool is_near = row < step.y;
        const int across = std::min(std::abs(step.x), size.x);
        for (int i = 0; i < (is_near ? size.x : across); ++i) {
            firsts.push_back({step.x < 0 && !is_near ? size.x - 1 - i : i, row});
        }
    }
    return firsts;
}

class Sweeps {
public:
    Sweeps(GridView<const float> heights, glm::dvec2 spacing, double exaggeration)
        : heights_(heights), spacing_(spacing), exaggeration_(static_cast<float>(exaggeration)),
          share_(heights.cols(), heights.rows(), 0.0F) {}

    void sweep(std::size_t index) {
        const glm::ivec2 step = steps[index];
        const auto weight = static_cast<float>(0.5 * weight_of(index, spacing_));
        const auto length =
            static_cast<float>(std::hypot(step.x * spacing_.x, step.y * spacing_.y));
        const std::vector<glm::ivec2> firsts =
            first_samples({heights_.cols(), heights_.rows()}, step);
        constexpr int lines_a_chunk = 64;
        const int lines = static_cast<int>(firsts.size());
        parallel_for((lines + lines_a_chunk - 1) / lines_a_chunk, [&](int chunk) {
            Hull hull(static_cast<std::size_t>(std::max(heights_.cols(), heights_.rows())));
            const int last = std::min((chunk + 1) * lines_a_chunk, lines);
            for (int line = chunk * lines_a_chunk; line < last; ++line) {
                sweep_line(firsts[static_cast<std::size_t>(line)], step, {length, weight}, hull);
            }
        });
    }

    [[nodiscard]] Grid<std::uint8_t> bytes() const {
        Grid<std::uint8_t> bytes(share_.cols(), share_.rows());
        std::transform(share_.samples().begin(), share_.samples().end(), bytes.samples().begin(),
                       [](float share) {
                           return static_cast<std::uint8_t>(
                               std::lround(255.0F * std::clamp(share, 0.0F, 1.0F)));
                       });
        return bytes;
    }

private:
    struct Scale {
        float length = 0.0F; // metres a step
        float weight = 0.0F;
    };

    void sweep_line(glm::ivec2 first, glm::ivec2 step, const Scale& scale, Hull& hull) {
        glm::ivec2 last = first;
        const auto visit = [&](glm::ivec2 at, int place) {
            const float slope = hull.add(
                {static_cast<float>(place) * scale.length, exaggeration_ * heights_(at.x, at.y)});
            share_(at.x, at.y) += scale.weight / (1.0F + slope * slope);
        };
        hull.clear();
        int place = 0;
        for (glm::ivec2 at = first; is_inside(at); at += step) {
            visit(at, place++);
            last = at;
        }
        hull.clear();
        place = 0;
        for (glm::ivec2 at = last; is_inside(at); at -= step) {
            visit(at, place++);
        }
    }
    [[nodiscard]] bool is_inside(glm::ivec2 at) const {
        return at.x >= 0 && at.y >= 0 && at.x < heights_.cols() && at.y < heights_.rows();
    }

    GridView<const float> heights_;
    glm::dvec2 spacing_;
    float exaggeration_;
    Grid<float> share_;
};

} // namespace

Grid<std::uint8_t> sky_share(GridView<const float> heights, glm::dvec2 spacing,
                             double exaggeration) {
    Sweeps sweeps(heights, spacing, exaggeration);
    for (std::size_t index = 0; index < steps.size(); ++index) {
        sweeps.sweep(index);
    }
    return sweeps.bytes();
}

} // namespace reljef::terrain
