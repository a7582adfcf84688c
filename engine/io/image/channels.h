#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "engine/core/grid.h"
#include "engine/core/result.h"

namespace reljef::io {

/// A picture's channels as numbers, row after row: what is stored as whole numbers in [0,1] of what
/// its type can hold, floats as they are.
struct Channels {
    int cols = 0;
    int rows = 0;
    int count = 0; ///< channels
    int bits = 0;  ///< of a channel
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

/// Any picture OpenImageIO opens.
Result<Channels> read_channels(const std::filesystem::path& path);
/// One of them. Precondition: it is there.
Grid<float> channel_of(const Channels& channels, int channel);

/// Whether the first `count` channels hold no NaN and no infinity; fails with the first place that
/// does, and `what` they are.
Result<void> check_finite(const Channels& channels, int count, const std::filesystem::path& path,
                          std::string_view what);

/// The bytes of a map's file, by its extension: .png and .tif of 16 bits a channel, which hold
/// [0,1] and cut off what is beyond, .exr of 32-bit floats. Fails on another extension.
Result<std::vector<std::byte>> encode_channels(const std::filesystem::path& path,
                                               const Channels& channels);

/// Whether a file of that name can hold a map: by its extension.
Result<void> check_map_name(const std::filesystem::path& path);

} // namespace reljef::io
