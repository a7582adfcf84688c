#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/io/checks/lowercase.h"
#include "engine/io/image/image.h"
#include "engine/io/image/image_encoder.h"
#include "engine/io/image/picture_file.h"
#include "engine/io/image/picture_module.h"

namespace reljef::io {
namespace fs = std::filesystem;
namespace {

constexpr std::array<const char*, 6> channel_names{"col",   "row",     "height",
                                                   "depth", "col_low", "row_low"};
constexpr std::array<std::size_t, 6> channel_offsets{
    offsetof(Hit, col),   offsetof(Hit, row),     offsetof(Hit, height),
    offsetof(Hit, depth), offsetof(Hit, col_low), offsetof(Hit, row_low)};
static_assert(sizeof(Hit) == channel_names.size() * sizeof(float)); // written as it lies in memory

PictureSpec spec_of(const HitBuffer& hits) {
    PictureSpec spec{hits.cols(), hits.rows(), channel_names.size(), SampleType::float32};
    spec.channel_names.assign(channel_names.begin(), channel_names.end());
    spec.texts = {{"compression", "zip"},
                  {"DateTime", "1970:01:01 00:00:00"}}; // fixed: the same bytes each time
    return spec;
}

Result<HitBuffer> read_hit_channels(PictureInput& input, const fs::path& path) {
    const PictureHeader& header = input.header();
    const std::vector<std::string>& names = header.channel_names;
    HitBuffer hits(header.cols, header.rows);
    auto* bytes = reinterpret_cast<std::byte*>(hits.samples().data());
    for (std::size_t i = 0; i < channel_names.size(); ++i) {
        const auto found = std::find(names.begin(), names.end(), channel_names[i]);
        const auto channel = static_cast<std::size_t>(found - names.begin());
        if (found == names.end() || !header.has_float32[channel]) {
            return Error{fmt::format("{}: has no float32 channel {}, the channels {} were expected",
                                     path.string(), channel_names[i],
                                     fmt::join(channel_names, ", "))};
        }
        const int first = static_cast<int>(channel);
        auto* const values = reinterpret_cast<float*>(bytes + channel_offsets[i]);
        if (!input.read_channels(first, first + 1, values, sizeof(Hit))) {
            return Error{fmt::format("{}: cannot be read ({}), a whole OpenEXR file was expected",
                                     path.string(), input.error())};
        }
    }
    return hits;
}

} // namespace

Result<void> check_hits_name(const fs::path& path) {
    if (extension_of(path) == ".exr") {
        const auto found = find_picture_module();
        return found ? found
                     : Error{fmt::format("{}: cannot be written: {}", path.string(),
                                         found.error().message)};
    }
    return Error{fmt::format("{}: cannot be written: hits go to an OpenEXR file, the extension "
                             ".exr was expected",
                             path.string())};
}

Result<AtomicFile> prepare_hits(const fs::path& path, const HitBuffer& hits) {
    if (hits.empty()) {
        return Error{fmt::format(
            "{}: cannot be written: no hits were given, at least 1×1 was expected", path.string())};
    }
    if (auto named = check_hits_name(path); !named) {
        return named.error();
    }
    auto output = create_output(path, "openexr");
    if (!output) {
        return output.error();
    }
    const auto bytes =
        encoded(std::move(*output), spec_of(hits), {hits.samples().data(), sizeof(Hit)});
    return bytes ? prepare_file(path, *bytes)
                 : Error{fmt::format("{}: cannot be written: {}", path.string(),
                                     bytes.error().message)};
}

Result<void> write_hits(const fs::path& path, const HitBuffer& hits) {
    auto file = prepare_hits(path, hits);
    return file ? file->commit() : file.error();
}

Result<HitBuffer> read_hits(const fs::path& path) {
    return read_picture<HitBuffer>(
        path, [&](PictureInput& input) { return read_hit_channels(input, path); });
}

} // namespace reljef::io
