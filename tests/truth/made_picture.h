#pragma once

#include <algorithm>
#include <cstdint>
#include <random>

#include "engine/core/color.h"

namespace reljef::test {

/// One colour all over.
inline Image plain_picture(int cols, int rows, Rgba8 color) {
    return {cols, rows, color};
}

/// Each byte by chance, alpha too.
inline Image random_picture(int cols, int rows, std::mt19937& random) {
    std::uniform_int_distribution<int> byte(0, 255);
    const auto next = [&] { return static_cast<std::uint8_t>(byte(random)); };
    Image picture(cols, rows);
    for (Rgba8& color : picture.samples()) {
        color = {next(), next(), next(), next()};
    }
    return picture;
}

/// The picture with every channel moved by up to `most` and kept in [0,255]; alpha stays.
inline Image disturbed(Image picture, int most, std::mt19937& random) {
    std::uniform_int_distribution<int> step(-most, most);
    const auto moved = [&](std::uint8_t byte) {
        return static_cast<std::uint8_t>(std::clamp(byte + step(random), 0, 255));
    };
    for (Rgba8& color : picture.samples()) {
        color = {moved(color.r), moved(color.g), moved(color.b), color.a};
    }
    return picture;
}

} // namespace reljef::test
