#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/grid.h"
#include "engine/core/result.h"

namespace reljef::io {

/// A picture's channels, row-major. Integer values are scaled to [0,1]; floats are unchanged.
struct Channels {
    int cols = 0;
    int rows = 0;
    int count = 0; ///< channels
    int bits = 0;  ///< per channel
    std::vector<float> values;

    [[nodiscard]] float at(int col, int row, int channel) const {
        return values[index(col, row, channel)];
    }
    [[nodiscard]] float& at(int col, int row, int channel) {
        return values[index(col, row, channel)];
    }

private:
    [[nodiscard]] std::size_t index(int col, int row, int channel) const {
        return (static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) +
                static_cast<std::size_t>(col)) *
                   static_cast<std::size_t>(count) +
               static_cast<std::size_t>(channel);
    }
};

/// Precondition: cols, rows, count > 0.
Channels make_channels(int cols, int rows, int count);

/// Any picture of a format that picture_format() knows.
Result<Channels> read_channels(const std::filesystem::path& path);
/// Precondition: the channel exists.
Grid<float> channel_of(const Channels& channels, int channel);

/// A channel of heights; fails outside [0,1].
Result<Grid<float>> unit_channel(const Channels& channels, int channel,
                                 const std::filesystem::path& path);
/// Decodes r, g, b from [0,1] to [-1,1]; y as stored. Precondition: at least 3 channels.
Grid<glm::vec3> decoded_normals(const Channels& channels);

/// Fails if one of the first `count` channels holds a value that is not finite. `what` names it.
Result<void> check_finite(const Channels& channels, int count, const std::filesystem::path& path,
                          std::string_view what);

/// Encodes a map by extension: .png and .tif with 16 bits per channel, clamped to [0,1]; .exr with
/// 32-bit floats. Fails for other extensions.
Result<std::vector<std::byte>> encode_channels(const std::filesystem::path& path,
                                               const Channels& channels);

/// Fails if the extension is none of these.
Result<void> check_map_name(const std::filesystem::path& path);

} // namespace reljef::io
