#include "engine/io/image/channels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "engine/io/checks/lowercase.h"
#include "engine/io/image/image_encoder.h"
#include "engine/io/image/picture_file.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

constexpr double max_values = 1 << 28; // 1 GB; 8192² pixels of RGBA

Result<Channels> read_open_channels(PictureInput& input, const fs::path& path) {
    const PictureHeader& header = input.header();
    const int count = header.channels();
    if (static_cast<double>(header.cols) * header.rows * count > max_values) {
        return Error{fmt::format("{}: claims {}×{} pixels of {} channels, at most {:.0f} values "
                                 "were expected",
                                 path.string(), header.cols, header.rows, count, max_values)};
    }
    Channels channels = make_channels(header.cols, header.rows, count);
    channels.bits = header.channel_bits;
    if (!input.read_channels(0, count, channels.values.data(),
                             static_cast<std::size_t>(count) * sizeof(float))) {
        return Error{fmt::format("{}: cannot be read ({}), a whole picture was expected",
                                 path.string(), input.error())};
    }
    return channels;
}

bool is_map_file(const fs::path& path) {
    constexpr std::array extensions{".png", ".tif", ".tiff", ".exr"};
    return std::any_of(extensions.begin(), extensions.end(),
                       [&](const char* extension) { return extension_of(path) == extension; });
}

Error no_map_file(const fs::path& path) {
    return {fmt::format("{}: cannot be written: {:?} names no format of maps, .png, .tif or .exr "
                        "was expected",
                        path.string(), path.extension().string())};
}

std::vector<std::uint16_t> whole_numbers(const std::vector<float>& values) {
    std::vector<std::uint16_t> whole(values.size());
    std::transform(values.begin(), values.end(), whole.begin(), [](float value) {
        return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 65535.0F));
    });
    return whole;
}

PictureSpec map_spec(const Channels& channels, SampleType type) {
    PictureSpec spec{channels.cols, channels.rows, channels.count, type, true};
    spec.texts = {{"oiio:ColorSpace", "Linear"}, {"compression", "zip"}};
    return spec;
}

} // namespace

Channels make_channels(int cols, int rows, int count) {
    Channels channels{cols, rows, count, 0, {}};
    channels.values.resize(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows) *
                           static_cast<std::size_t>(count));
    return channels;
}

Result<Channels> read_channels(const fs::path& path) {
    return read_picture<Channels>(
        path, [&](PictureInput& input) { return read_open_channels(input, path); });
}

Grid<float> channel_of(const Channels& channels, int channel) {
    Grid<float> grid(channels.cols, channels.rows);
    for (int row = 0; row < grid.rows(); ++row) {
        for (int col = 0; col < grid.cols(); ++col) {
            grid(col, row) = channels.at(col, row, channel);
        }
    }
    return grid;
}

Result<Grid<float>> unit_channel(const Channels& channels, int channel, const fs::path& path) {
    Grid<float> heights = channel_of(channels, channel);
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            if (!(heights(col, row) >= 0.0F && heights(col, row) <= 1.0F)) {
                return Error{fmt::format("{}: a height of {} found at column {}, row {}, heights "
                                         "in [0, 1] were expected",
                                         path.string(), heights(col, row), col, row)};
            }
        }
    }
    return heights;
}

Grid<glm::vec3> decoded_normals(const Channels& channels) {
    Grid<glm::vec3> normals(channels.cols, channels.rows);
    for (int row = 0; row < normals.rows(); ++row) {
        for (int col = 0; col < normals.cols(); ++col) {
            const glm::vec3 stored(channels.at(col, row, 0), channels.at(col, row, 1),
                                   channels.at(col, row, 2));
            normals(col, row) = 2.0F * stored - 1.0F;
        }
    }
    return normals;
}

Result<void> check_finite(const Channels& channels, int count, const fs::path& path,
                          std::string_view what) {
    for (int row = 0; row < channels.rows; ++row) {
        for (int col = 0; col < channels.cols; ++col) {
            for (int i = 0; i < std::min(count, channels.count); ++i) {
                const float value = channels.at(col, row, i);
                if (!std::isfinite(value)) {
                    return Error{fmt::format("{}: {} of {} found at column {}, row {}, finite "
                                             "numbers were expected",
                                             path.string(), what, value, col, row)};
                }
            }
        }
    }
    return {};
}

Result<std::vector<std::byte>> encode_channels(const fs::path& path, const Channels& channels) {
    if (!is_map_file(path)) {
        return no_map_file(path);
    }
    auto output = create_output(path, path.string());
    if (!output) {
        return output.error();
    }
    const auto count = static_cast<std::size_t>(channels.count);
    if (extension_of(path) == ".exr") {
        return encoded(std::move(*output), map_spec(channels, SampleType::float32),
                       {channels.values.data(), count * sizeof(float)});
    }
    const std::vector<std::uint16_t> whole = whole_numbers(channels.values);
    return encoded(std::move(*output), map_spec(channels, SampleType::uint16),
                   {whole.data(), count * sizeof(std::uint16_t)});
}

Result<void> check_map_name(const fs::path& path) {
    return is_map_file(path) ? Result<void>() : no_map_file(path);
}

} // namespace reljef::io
