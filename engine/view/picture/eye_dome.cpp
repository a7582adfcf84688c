#include "engine/view/picture/eye_dome.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
        : nearness_(hits.cols(), hits.rows()),
          is_perspective_(list.camera.projection == scene::ProjectionKind::perspective),
          strength_(static_cast<float>(list.eye_dome)) {
        const glm::vec2 metres = metres_a_pixel(list.camera, list.size);
        pixel_ = is_perspective_ ? metres.y : metres.x;
        std::ranges::transform(hits.samples(), nearness_.samples().begin(), [this](const Hit& hit) {
            return hit.is_sky() ? std::numeric_limits<float>::quiet_NaN()
                                : (is_perspective_ ? 1.0F / hit.depth : -hit.depth);
        });
        const double scale = contour_scale(list.camera, list.size);
        std::size_t count = 0;
        for (const double ring : rings) {
            const int reach =
                std::min(static_cast<int>(std::lround(ring * scale)), max_eye_dome_reach);
            for (const glm::ivec2 direction : directions) {
                const glm::ivec2 step = reach * direction;
                steps_[count++] = {step, glm::abs(step), 1.0F / glm::length(glm::vec2(step))};
            }
        }
    }

    // What remains of a pixel's colour.
    [[nodiscard]] float share_at(glm::ivec2 pixel) const {
        if (std::isnan(nearness_(pixel.x, pixel.y))) {
            return 1.0F;
        }
        float sum = 0.0F;
        for (const Step& step : steps_) {
            sum += darkness_at(pixel, step);
        }
        return 1.0F - strength_ * sum / static_cast<float>(steps_.size());
    }

private:
    // To one of two opposite neighbours, pixels.
    struct Step {
        glm::ivec2 way{0};
        glm::ivec2 reach{0};
        float per_length = 1.0F;
    };

    // Creases between cells of the terrain are faint. Beside the sky, which is behind everything,
    // `behind` is not a number.
    static float darkness(float behind) {
        const float square = behind * behind / (half_depth * half_depth);
        return behind > 0.0F ? square / (square + 1.0F) : 0.0F;
    }

    // Between the neighbours before and after a step. Near the picture's border the nearest pixel
    // counts that has both.
    [[nodiscard]] float darkness_at(glm::ivec2 pixel, const Step& step) const {
        const glm::ivec2 last = glm::ivec2(nearness_.cols(), nearness_.rows()) - 1 - step.reach;
        if (last.x < step.reach.x || last.y < step.reach.y) {
            return 0.0F;
        }
        pixel = glm::clamp(pixel, step.reach, last);
        const float near = nearness_(pixel.x, pixel.y);
        const float before = nearness_(pixel.x - step.way.x, pixel.y - step.way.y);
        const float after = nearness_(pixel.x + step.way.x, pixel.y + step.way.y);
        const float metres_per_pixel = is_perspective_ ? near * pixel_ : pixel_;
        return darkness((0.5F * (before + after) - near) / metres_per_pixel * step.per_length);
    }

    // Inverse depth in perspective, else negative depth: linear on a plane. NaN: sky.
    Grid<float> nearness_;
    bool is_perspective_;
    float strength_;
    float pixel_ = 1.0F; // metres of its width, at a depth of 1 m in perspective
    std::array<Step, rings.size() * directions.size()> steps_{};
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
