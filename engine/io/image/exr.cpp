#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/io/image/image.h"
#include "engine/io/image/image_encoder.h"
#include "engine/io/image/picture_file.h"

namespace reljef::io {
namespace fs = std::filesystem;
namespace {

constexpr std::array<const char*, 6> channel_names{"col",   "row",     "height",
                                                   "depth", "col_low", "row_low"};
constexpr std::array<std::size_t, 6> channel_offsets{
    offsetof(Hit, col),   offsetof(Hit, row),     offsetof(Hit, height),
    offsetof(Hit, depth), offsetof(Hit, col_low), offsetof(Hit, row_low)};
static_assert(sizeof(Hit) == channel_names.size() * sizeof(float)); // written as it lies in memory

OIIO::ImageSpec spec_of(const HitBuffer& hits) {
    OIIO::ImageSpec spec(hits.cols(), hits.rows(), channel_names.size(), OIIO::TypeDesc::FLOAT);
    spec.channelnames.assign(channel_names.begin(), channel_names.end());
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "1970:01:01 00:00:00"); // fixed: the same bytes each time
    return spec;
}

Result<HitBuffer> read_hit_channels(OIIO::ImageInput& input, const fs::path& path) {
    const OIIO::ImageSpec& spec = input.spec();
    HitBuffer hits(spec.width, spec.height);
    auto* bytes = reinterpret_cast<std::byte*>(hits.samples().data());
    for (std::size_t i = 0; i < channel_names.size(); ++i) {
        const auto found = std::find(spec.channelnames.begin(), spec.channelnames.end(),
                                     std::string(channel_names[i]));
        const int channel = static_cast<int>(found - spec.channelnames.begin());
        if (found == spec.channelnames.end() ||
            spec.channelformat(channel) != OIIO::TypeDesc(OIIO::TypeDesc::FLOAT)) {
            return Error{fmt::format("{}: has no float32 channel {}, the channels {} were expected",
                                     path.string(), channel_names[i],
                                     fmt::join(channel_names, ", "))};
        }
        if (!input.read_image(0, 0, channel, channel + 1, OIIO::TypeDesc::FLOAT,
                              bytes + channel_offsets[i], sizeof(Hit))) {
            return Error{fmt::format("{}: cannot be read ({}), a whole OpenEXR file was expected",
                                     path.string(), input.geterror())};
        }
    }
    return hits;
}

} // namespace

Result<void> check_hits_name(const fs::path& path) {
    if (path.extension() == ".exr") {
        return {};
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
    auto output = OIIO::ImageOutput::create("openexr");
    if (output == nullptr) {
        return Error{
            fmt::format("{}: cannot be written: OpenImageIO has no OpenEXR", path.string())};
    }
    return prepare_encoded(std::move(output), spec_of(hits), hits.samples().data(), sizeof(Hit),
                           path);
}

Result<void> write_hits(const fs::path& path, const HitBuffer& hits) {
    auto file = prepare_hits(path, hits);
    return file ? file->commit() : file.error();
}

Result<HitBuffer> read_hits(const fs::path& path) {
    return read_picture<HitBuffer>(
        path, [&](OIIO::ImageInput& input) { return read_hit_channels(input, path); });
}

} // namespace reljef::io
