#include "bench/report/row_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "engine/core/check.h"
#include "engine/io/image/image.h"

namespace reljef::bench {
namespace {

// Merges blocks of factor × factor pixels; drops incomplete blocks at the right and bottom.
template <class Pixel, class Merge>
Grid<Pixel> reduced(const Grid<Pixel>& fine, int factor, const Merge& merge) {
    Grid<Pixel> coarse(fine.cols() / factor, fine.rows() / factor);
    std::vector<Pixel> block;
    for (int row = 0; row < coarse.rows(); ++row) {
        for (int col = 0; col < coarse.cols(); ++col) {
            block.clear();
            for (int i = 0; i < factor * factor; ++i) {
                block.push_back(fine(col * factor + i % factor, row * factor + i / factor));
            }
            coarse(col, row) = merge(block);
        }
    }
    return coarse;
}

Rgba8 mean_color(const std::vector<Rgba8>& block) {
    glm::vec3 sum(0.0F);
    for (const Rgba8 color : block) {
        sum += linear_from_rgba8(color);
    }
    return rgba8_from_linear(sum / static_cast<float>(block.size()));
}

// NaN only if all are NaN.
float max_error(const std::vector<float>& block) {
    return std::accumulate(block.begin(), block.end(), std::numeric_limits<float>::quiet_NaN(),
                           [](float a, float b) { return std::fmax(a, b); });
}

Image smaller(const Image& image, int factor) {
    return factor == 1 ? image : reduced(image, factor, mean_color);
}

// Oklab's a and b at equal steps of the scale: blue, green, yellow, all inside sRGB. Magenta is
// reserved for infinite errors.
constexpr std::array<glm::vec2, 5> hues{
    {{0.0F, -0.08F}, {-0.03F, -0.12F}, {-0.09F, -0.02F}, {-0.12F, 0.12F}, {-0.05F, 0.165F}}};
constexpr float darkest = 0.20F;
constexpr float lightest = 0.92F;

constexpr int hatch_period = 8; // pixels
constexpr int hatch_width = 2;
constexpr Rgba8 hatch_line{104, 104, 108, 255};
constexpr Rgba8 hatch_ground{62, 62, 66, 255};

// Ottosson 2020, "A perceptual color space for image processing".
glm::vec3 linear_from_oklab(float lightness, glm::vec2 ab) {
    const glm::vec3 roots = lightness + glm::vec3(0.3963377774F * ab.x + 0.2158037573F * ab.y,
                                                  -0.1055613458F * ab.x - 0.0638541728F * ab.y,
                                                  -0.0894841775F * ab.x - 1.2914855480F * ab.y);
    const glm::vec3 lms = roots * roots * roots;
    return {4.0767416621F * lms.x - 3.3077115913F * lms.y + 0.2309699292F * lms.z,
            -1.2684380046F * lms.x + 2.6097574011F * lms.y - 0.3413193965F * lms.z,
            -0.0041960863F * lms.x - 0.7034186147F * lms.y + 1.7076147010F * lms.z};
}

glm::vec2 hue_at(float share) {
    const float place = share * static_cast<float>(hues.size() - 1);
    const std::size_t index = std::min(static_cast<std::size_t>(place), hues.size() - 2);
    return glm::mix(hues.at(index), hues.at(index + 1), place - static_cast<float>(index));
}

std::size_t level_of(double error_px) {
    const double share = std::log(std::max(error_px, heat_low_px) / heat_low_px) /
                         std::log(heat_high_px / heat_low_px);
    return std::min(static_cast<std::size_t>(share * static_cast<double>(heat_levels)),
                    heat_levels - 1);
}

Rgba8 hatch(int col, int row) {
    return (col + row) % hatch_period < hatch_width ? hatch_line : hatch_ground;
}

} // namespace

std::array<Rgba8, heat_levels> heat_scale() {
    std::array<Rgba8, heat_levels> scale;
    for (std::size_t i = 0; i < scale.size(); ++i) {
        const float share = static_cast<float>(i) / static_cast<float>(scale.size() - 1);
        scale[i] =
            rgba8_from_linear(linear_from_oklab(glm::mix(darkest, lightest, share), hue_at(share)));
    }
    return scale;
}

Image heat_map(const Grid<float>& error_px) {
    const auto scale = heat_scale();
    Image map(error_px.cols(), error_px.rows());
    for (int row = 0; row < map.rows(); ++row) {
        for (int col = 0; col < map.cols(); ++col) {
            const float error = error_px(col, row);
            check(!(error < 0.0F), "heat_map of a negative error");
            map(col, row) = std::isnan(error)   ? hatch(col, row)
                            : std::isinf(error) ? heat_unbounded
                                                : scale.at(level_of(error));
        }
    }
    return map;
}

namespace {

float taps_of(const view::PixelWork& work) {
    return work.taps > 0 ? static_cast<float>(work.taps) : std::numeric_limits<float>::quiet_NaN();
}

Image map_of_taps(Grid<float> taps) {
    for (float& count : taps.samples()) {
        count *= static_cast<float>(heat_low_px / work_low);
    }
    return heat_map(taps);
}

Grid<float> taps_in(const Grid<view::PixelWork>& pixels) {
    Grid<float> taps(pixels.cols(), pixels.rows());
    std::transform(pixels.samples().begin(), pixels.samples().end(), taps.samples().begin(),
                   taps_of);
    return taps;
}

// Empty without work.
Result<RowView::File> encoded_work(const Grid<view::PixelWork>& pixels, int factor) {
    if (pixels.empty()) {
        return RowView::File();
    }
    const Grid<float> taps = taps_in(pixels);
    return io::encode_image(".png",
                            map_of_taps(factor == 1 ? taps : reduced(taps, factor, max_error)));
}

} // namespace

Image work_map(const Grid<view::PixelWork>& pixels) {
    return map_of_taps(taps_in(pixels));
}

Result<std::shared_ptr<const RowView>> RowViews::make(const ShownView& view) {
    const int cols = view.shown.cols();
    check(!view.shown.empty() && view.truth->cols() == cols &&
              view.truth->rows() == view.shown.rows() && view.reprojection.cols() == cols &&
              view.reprojection.rows() == view.shown.rows(),
          "a row's pictures are empty or differ in size");
    const int desired = max_cols_ > 0 ? (cols + max_cols_ - 1) / max_cols_ : 1;
    const int factor = std::min({desired, cols, view.shown.rows()});
    auto shown = io::encode_image(".jpg", smaller(view.shown, factor));
    if (!shown) {
        return shown.error();
    }
    const Image heat_picture =
        heat_map(factor == 1 ? view.reprojection : reduced(view.reprojection, factor, max_error));
    auto heat = io::encode_image(".png", heat_picture);
    if (!heat) {
        return heat.error();
    }
    auto truth = truth_of(view, factor);
    if (!truth) {
        return truth.error();
    }
    auto work = encoded_work(view.work, factor);
    if (!work) {
        return work.error();
    }
    return std::make_shared<const RowView>(RowView{{heat_picture.cols(), heat_picture.rows()},
                                                   std::move(*shown),
                                                   std::move(*truth),
                                                   std::move(*heat),
                                                   std::move(*work)});
}

Result<std::shared_ptr<const RowView::File>> RowViews::truth_of(const ShownView& view, int factor) {
    if (truth_ != view.truth) {
        auto file = io::encode_image(".jpg", smaller(*view.truth, factor));
        if (!file) {
            return file.error();
        }
        truth_ = view.truth;
        truth_file_ = std::make_shared<const RowView::File>(std::move(*file));
    }
    return truth_file_;
}

} // namespace reljef::bench
