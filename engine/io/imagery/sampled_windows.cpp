#include "engine/io/imagery/sampled_windows.h"

#include <algorithm>
#include <cstdint>

#include <glm/common.hpp>

namespace reljef::io {
namespace {

constexpr int min_window_cols = 64; // so that there are not too many

/// A block or some rows of it, or some narrow blocks.
glm::ivec2 window_for(glm::ivec2 block, glm::ivec2 size) {
    const int cols = std::min(std::clamp(block.x, min_window_cols, max_window_pixels), size.x);
    return {cols, std::clamp(std::min(block.y, size.y), 1, max_window_pixels / cols)};
}

} // namespace

std::vector<PixelWindow> sampled_windows(glm::ivec2 size, glm::ivec2 block) {
    const glm::ivec2 window = window_for(block, size);
    const std::int64_t across = (size.x - 1) / window.x + 1;
    const std::int64_t count = across * ((size.y - 1) / window.y + 1);
    const std::int64_t desired = max_sampled_pixels / (window.x * window.y) + 1;
    std::int64_t step = std::max<std::int64_t>(1, (count + desired - 1) / desired);
    step += step > 1 && step % across == 0 ? 1 : 0; // not always the same column
    std::vector<PixelWindow> windows;
    for (std::int64_t i = 0; i < count; i += step) {
        const glm::ivec2 first(static_cast<int>(i % across) * window.x,
                               static_cast<int>(i / across) * window.y);
        windows.push_back({first, glm::min(window, size - first)});
    }
    return windows;
}

} // namespace reljef::io
