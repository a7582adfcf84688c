#include "engine/view/picture/eye_dome.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/common.hpp>

namespace reljef::view {
namespace {

// From a pixel to one of two opposite neighbours.
constexpr std::array<glm::ivec2, 4> directions{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
constexpr std::array<double, 3> rings{1.0, 3.0, 7.0}; // pixels, at a contour_scale() of 1
constexpr int max_ring = 28;                          // less than the margin of a picture's parts
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
            return std::min(static_cast<int>(std::lround(ring * scale)), max_ring);
        });
    }

    // What remains of a pixel's colour.
    [[nodiscard]] float share_at(glm::ivec2 pixel) const {
        const Hit& hit = hits_(pixel.x, pixel.y);
        if (hit.is_sky()) {
            return 1.0F;
        }
        float sum = 0.0F;
        int count = 0;
        for (const int ring : rings_) {
            for (const glm::ivec2 direction : directions) {
                const glm::ivec2 step = ring * direction;
                if (!is_inside(pixel - step) || !is_inside(pixel + step)) {
                    continue;
                }
                const float length = static_cast<float>(ring) *
                                     (direction.x != 0 && direction.y != 0 ? diagonal : 1.0F);
                const float behind =
                    depth_behind(hit.depth, depth_at(pixel - step), depth_at(pixel + step)) /
                    length;
                sum += darkness(behind);
                ++count;
            }
        }
        return count > 0 ? 1.0F - strength_ * sum / static_cast<float>(count) : 1.0F;
    }

private:
    // Creases between cells of the terrain are faint.
    static float darkness(float behind) {
        const float square = behind * behind / (half_depth * half_depth);
        return behind > 0.0F ? square / (square + 1.0F) : 0.0F;
    }

    static constexpr float diagonal = 1.41421356F;

    [[nodiscard]] bool is_inside(glm::ivec2 pixel) const {
        return pixel.x >= 0 && pixel.y >= 0 && pixel.x < hits_.cols() && pixel.y < hits_.rows();
    }
    [[nodiscard]] float depth_at(glm::ivec2 pixel) const { return hits_(pixel.x, pixel.y).depth; }

    // Widths of a pixel at `depth`; 0 beside the sky, which is behind everything. In perspective
    // the inverse of a plane's depth is linear.
    [[nodiscard]] float depth_behind(float depth, float one, float other) const {
        if (std::isinf(one) || std::isinf(other)) {
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
