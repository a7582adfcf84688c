#include "engine/view/picture/eye_dome.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::view {
namespace {

// From a pixel to one of two opposite neighbours.
constexpr std::array<glm::ivec2, 4> directions{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
constexpr std::array<double, 3> rings{1.0, 3.0, 7.0}; // pixels, at a contour_scale() of 1
constexpr float step_count = static_cast<float>(directions.size() * rings.size());
// Depth behind the line of the neighbours, in their distances, that darkens by half.
constexpr float half_depth = 1.0F;
constexpr float sky = -1e15F; // nearness: behind everything
constexpr float min_depth = std::numeric_limits<float>::min();

class EyeDome {
public:
    EyeDome(const Grid<float>& depths, const DrawList& list)
        : depths_(depths), nearness_(depths.cols(), depths.rows()),
          per_nearness_(depths.cols(), depths.rows()),
          is_perspective_(list.camera.projection == scene::ProjectionKind::perspective) {
        const glm::vec2 metres = scene::metres_a_pixel(list.camera, list.size);
        pixels_per_metre_ = 1.0F / (is_perspective_ ? metres.y : metres.x);
        const double scale = contour_scale(list.camera, list.size);
        for (const double ring : rings) {
            const int reach =
                std::min(static_cast<int>(std::lround(ring * scale)), max_eye_dome_reach);
            for (const glm::ivec2 direction : directions) {
                add_step(reach * direction);
            }
        }
    }

    void find_nearness(int row) {
        const float* const depths = &depths_(0, row);
        float* const nearness = &nearness_(0, row);
        float* const per_nearness = &per_nearness_(0, row);
        const float sky_depth = std::numeric_limits<float>::infinity();
        for (int col = 0; col < depths_.cols(); ++col) {
            const float depth = depths[col];
            const float found =
                is_perspective_ ? 1.0F / std::max(depth, min_depth) : std::max(-depth, sky);
            const float pixels = pixels_per_metre_ * (is_perspective_ ? depth : 1.0F);
            nearness[col] = depth < sky_depth ? found : sky;
            per_nearness[col] = depth < sky_depth ? pixels : 0.0F;
        }
    }

    // The darkness of a row's pixels, [0, 1]. Precondition: the nearness of all rows is found.
    void find_darkness(int row, std::span<float> darkness) const {
        std::ranges::fill(darkness, 0.0F);
        for (const Step& step : steps_) {
            add_darkness(row, step, darkness.data());
        }
        const float* const per_nearness = &per_nearness_(0, row);
        float* const found = darkness.data();
        for (int col = 0; col < depths_.cols(); ++col) {
            found[col] = per_nearness[col] > 0.0F ? found[col] / step_count : 0.0F;
        }
    }

private:
    // To one of two opposite neighbours, pixels.
    struct Step {
        glm::ivec2 way{0};
        glm::ivec2 reach{0};
        float per_length = 1.0F;
    };

    // Steps that no pixel of the picture can make to both sides darken nothing.
    void add_step(glm::ivec2 way) {
        const glm::ivec2 reach = glm::abs(way);
        if (2 * reach.x < depths_.cols() && 2 * reach.y < depths_.rows()) {
            steps_.push_back({way, reach, 1.0F / (half_depth * glm::length(glm::vec2(way)))});
        }
    }

    // Between the neighbours before and after a step. Near the picture's border the nearest pixel
    // counts that has both. Creases between cells of the terrain are faint.
    void add_darkness(int row, const Step& step, float* sums) const {
        const int middle = std::clamp(row, step.reach.y, depths_.rows() - 1 - step.reach.y);
        const float* const here = &nearness_(0, middle);
        const float* const before = &nearness_(0, middle - step.way.y);
        const float* const after = &nearness_(0, middle + step.way.y);
        const float* const per_nearness = &per_nearness_(0, middle);
        const float per_length = step.per_length;
        const int right = step.way.x;
        const auto darkness = [=](int col) {
            const float line = 0.5F * (before[col - right] + after[col + right]);
            const float signed_behind = (line - here[col]) * per_nearness[col] * per_length;
            // Without a comparison, compilers make vectors of it.
            const float behind = 0.5F * (signed_behind + std::abs(signed_behind));
            return 1.0F - 1.0F / (1.0F + behind * behind);
        };
        const int first = step.reach.x;
        const int last = depths_.cols() - 1 - step.reach.x;
        for (int col = first; col <= last; ++col) {
            sums[col] += darkness(col);
        }
        const float at_first = darkness(first);
        const float at_last = darkness(last);
        for (int col = 0; col < first; ++col) {
            sums[col] += at_first;
            sums[last + 1 + col] += at_last;
        }
    }

    const Grid<float>& depths_;
    // Inverse depth in perspective, else negative depth: linear on a plane.
    Grid<float> nearness_;
    Grid<float> per_nearness_; // a pixel's difference of depth; 0: sky
    bool is_perspective_;
    float pixels_per_metre_ = 1.0F; // of its width, at a depth of 1 m in perspective
    std::vector<Step> steps_;
};

// Shares of colours in whole numbers.
constexpr unsigned share_bits = 16;
constexpr unsigned whole = 1U << share_bits;

std::uint8_t darkened(std::uint8_t channel, unsigned share) {
    return static_cast<std::uint8_t>((channel * share + whole / 2) >> share_bits);
}

} // namespace

void shade_eye_dome(GridView<Rgba8> picture, const Grid<float>& depths, const DrawList& list,
                    const ParallelOptions& parallel) {
    check(picture.cols() == depths.cols() && picture.rows() == depths.rows(),
          "depths of the picture were expected");
    EyeDome dome(depths, list);
    parallel_for(
        picture.rows(), [&](int row) { dome.find_nearness(row); }, parallel);
    const auto strength = static_cast<float>(list.eye_dome);
    parallel_for(
        picture.rows(),
        [&](int row) {
            std::vector<float> darkness(static_cast<std::size_t>(picture.cols()));
            dome.find_darkness(row, darkness);
            for (int col = 0; col < picture.cols(); ++col) {
                Rgba8& color = picture(col, row);
                const float left = 1.0F - strength * darkness[static_cast<std::size_t>(col)];
                const auto share = static_cast<unsigned>(left * static_cast<float>(whole));
                color = {darkened(color.r, share), darkened(color.g, share),
                         darkened(color.b, share), color.a};
            }
        },
        parallel);
}

} // namespace reljef::view
