#pragma once

#include <vector>

#include <glm/vec2.hpp>

namespace reljef::io {

/// A part of an image, pixels.
struct PixelWindow {
    glm::ivec2 first{0};
    glm::ivec2 size{0};
};

/// All of an image of `size` pixels that is stored in blocks of `block`, or as much of it, evenly
/// spread, as makes `max_sampled_pixels`, and a window more. None has more than
/// `max_window_pixels`: what is read at a time is no larger where a file claims huge blocks.
std::vector<PixelWindow> sampled_windows(glm::ivec2 size, glm::ivec2 block);
inline constexpr int max_sampled_pixels = 1 << 22;
inline constexpr int max_window_pixels = 1 << 18;

} // namespace reljef::io
