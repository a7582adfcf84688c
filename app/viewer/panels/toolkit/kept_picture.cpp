#include "app/viewer/panels/toolkit/kept_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>

namespace reljef::app {
namespace {

// How far a row of a rounded corner begins from the side; rows count from the edge.
int inset(int row, int radius) {
    const double up = radius - row - 0.5;
    return row >= radius
               ? 0
               : static_cast<int>(std::ceil(
                     radius - std::sqrt(std::max(double(radius) * radius - up * up, 0.0)) - 0.5));
}

} // namespace

std::vector<PixelArea> strips_of(const RoundedArea& area, glm::ivec2 window) {
    const glm::ivec2 low = glm::max(area.low, glm::ivec2(0));
    const glm::ivec2 high = glm::min(area.high, window);
    std::vector<PixelArea> strips;
    for (int row = low.y; row < high.y;) {
        const auto inset_at = [&](int y) {
            return inset(std::min(y - area.low.y, area.high.y - 1 - y), area.radius);
        };
        const int begin = row;
        const int beside = inset_at(row);
        while (row < high.y && inset_at(row) == beside) {
            ++row;
        }
        const int left = std::max(low.x, area.low.x + beside);
        const int right = std::min(high.x, area.high.x - beside);
        if (left < right) {
            strips.push_back({{left, begin}, {right - left, row - begin}});
        }
    }
    return strips;
}

bool KeptPicture::resize(glm::ivec2 window) {
    auto kept =
        gl::Framebuffer::create({.size = window, .color = gl::Format::window8, .depth = false});
    kept_ = kept ? std::move(*kept) : gl::Framebuffer();
    drawn_ = Image(kept_.size().x, kept_.size().y);
    return kept.has_value();
}

void KeptPicture::draw(const std::vector<RoundedArea>& areas, const std::vector<PixelArea>& changed,
                       const DrawArea& draw_area) {
    const GridView<const Rgba8> pixels = drawn_.view();
    for (const PixelArea& area : changed) {
        draw_area(area, drawn_);
        kept_.upload_area(area.low,
                          pixels.window(area.low.x, area.low.y, area.size.x, area.size.y));
    }
    strips_.clear();
    for (const RoundedArea& area : areas) {
        const auto strips = strips_of(area, kept_.size());
        strips_.insert(strips_.end(), strips.begin(), strips.end());
    }
    show();
}

void KeptPicture::show() const {
    for (const PixelArea& strip : strips_) {
        kept_.blit_area_to_window(strip.low, strip.size);
    }
}

} // namespace reljef::app
