#include "engine/view/picture/eye_dome.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::view {
namespace {

// From a pixel to one of two opposite neighbours.
constexpr std::array<glm::ivec2, 4> directions{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
constexpr std::array<double, 3> rings{1.0, 3.0, 7.0}; // pixels, at a contour_scale() of 1
// Depth behind the line of the neighbours, in their distances, that darkens by half.
constexpr float half_depth = 1.0F;

class EyeDome {
public:
    EyeDome(const HitBuffer& hits, const DrawList& list)
        : hits_(hits),
          is_perspective_(list.camera.projection == scene::ProjectionKind::perspective),
          strength_(static_cast<float>(list.eye_dome)) {
        const glm::vec2 metres = metres_a_pixel(list.camera, list.size);
        pixel_ = is_perspective_ ? metres.y : metres.x;
        const double scale = contour_scale(list.camera, list.size);
        std::ranges::transform(rings, rings_.begin(), [scale](double ring) {
            return std::min(static_cast<int>(std::lround(ring * scale)), max_eye_dome_reach);
        });
    }

    // What remains of a pixel's colour.
    [[nodiscard]] float share_at(glm::ivec2 pixel) const {
        const Hit& hit = hits_(pixel.x, pixel.y);
        if (hit.is_sky()) {
            return 1.0F;
        }
        float sum = 0.0F;
        for (const int ring : rings_) {
            for (const glm::ivec2 direction : directions) {
                sum += darkness_at(pixel, ring * direction);
            }
        }
        return 1.0F - strength_ * sum / static_cast<float>(rings_.size() * directions.size());
    }

private:
    // Creases between cells of the terrain are faint.
    static float darkness(float behind) {
        const float square = behind * behind / (half_depth * half_depth);
        return behind > 0.0F ? square / (square + 1.0F) : 0.0F;
    }

    // Between the neighbours before and after a step. Near the picture's border the nearest pixel
    // counts that has both.
    [[nodiscard]] float darkness_at(glm::ivec2 pixel, glm::ivec2 step) const {
        const glm::ivec2 reach = glm::abs(step);
        const glm::ivec2 last = glm::ivec2(hits_.cols(), hits_.rows()) - 1 - reach;
        if (last.x < reach.x || last.y < reach.y) {
            return 0.0F;
        }
        pixel = glm::clamp(pixel, reach, last);
        const float behind =
            depth_behind(depth_at(pixel), depth_at(pixel - step), depth_at(pixel + step));
        return darkness(behind / glm::length(glm::vec2(step)));
    }

    [[nodiscard]] float depth_at(glm::ivec2 pixel) const { return hits_(pixel.x, pixel.y).depth; }

    // Widths of a pixel at `depth`; 0 beside the sky, which is behind everything. In perspective
    // the inverse of a plane's depth is linear.
    [[nodiscard]] float depth_behind(float depth, float one, float other) const {
        if (std::isinf(depth) || std::isinf(one) || std::isinf(other)) {
            return 0.0F;
        }
        if (is_perspective_) {
            return (0.5F * (1.0F / one + 1.0F / other) - 1.0F / depth) * depth / pixel_;
        }
        return (depth - 0.5F * (one + other)) / pixel_;
    }

    const HitBuffer& hits_;
    bool is_perspective_;
    float strength_;
    float pixel_ = 1.0F; // metres of its width, at a depth of 1 m in perspective
    std::array<int, rings.size()> rings_{};
};

std::uint8_t darkened(std::uint8_t channel, float share) {
    return static_cast<std::uint8_t>(std::lround(share * static_cast<float>(channel)));
}

} // namespace

void shade_eye_dome(GridView<Rgba8> picture, const HitBuffer& hits, const DrawList& list,
                    const ParallelOptions& parallel) {
    check(picture.cols() == hits.cols() && picture.rows() == hits.rows(),
          "hits of the picture were expected");
    const EyeDome dome(hits, list);
    parallel_for(
        picture.rows(),
        [&](int row) {
            for (int col = 0; col < picture.cols(); ++col) {
                Rgba8& color = picture(col, row);
                const float share = dome.share_at({col, row});
                color = {darkened(color.r, share), darkened(color.g, share),
                         darkened(color.b, share), color.a};
            }
        },
        parallel);
}

} // namespace reljef::view
