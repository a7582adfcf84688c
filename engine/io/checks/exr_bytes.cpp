#include "engine/io/checks/exr_bytes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <cpl_vsi.h>
#include <fmt/format.h>

namespace reljef::io {
namespace {

constexpr double max_exr_side = 65'536.0;
constexpr double max_exr_block_bytes = 1 << 28; // as of rasters
constexpr double exr_channel_bytes = 4.0;       // at most
constexpr std::size_t max_exr_name = 255;       // of attributes, types and channels
constexpr std::size_t max_kept_attribute = std::size_t{1} << 16;

using ExrFile = std::unique_ptr<VSILFILE, decltype(&VSIFCloseL)>;

/// Little-endian parts of a file; an absent one and all after it are 0, and good() is false.
class ExrReader {
public:
    explicit ExrReader(const std::string& name)
        : file_(VSIFOpenL(name.c_str(), "rb"), &VSIFCloseL) {
        VSIStatBufL status{};
        good_ = file_ != nullptr && VSIStatL(name.c_str(), &status) == 0;
        size_ = good_ ? static_cast<std::uint64_t>(status.st_size) : 0;
    }
    [[nodiscard]] bool good() const { return good_; }
    [[nodiscard]] double size() const { return static_cast<double>(size_); }
    [[nodiscard]] std::uint64_t left() const { return good_ ? size_ - at_ : 0; }
    void fail() { good_ = false; }

    std::string bytes(std::size_t count) {
        std::string found(good_ && count <= left() ? count : 0, '\0');
        good_ = good_ && count <= left() && VSIFReadL(found.data(), 1, count, file_.get()) == count;
        at_ += found.size();
        found.resize(good_ ? count : 0);
        return found;
    }
    std::uint32_t word() { return word_in(bytes(sizeof(std::uint32_t)), 0); }
    std::string text() {
        std::string found;
        for (std::string letter = bytes(1); good_ && letter[0] != '\0'; letter = bytes(1)) {
            found += letter;
            good_ = found.size() <= max_exr_name;
        }
        return found;
    }
    void skip(std::uint64_t count) {
        at_ += count;
        VSIFSeekL(file_.get(), at_, SEEK_SET);
    }
    static std::uint32_t word_in(std::string_view bytes, std::size_t place) {
        std::uint32_t word = 0;
        for (std::size_t i = 0; i < sizeof(word) && place + i < bytes.size(); ++i) {
            word |= std::uint32_t{static_cast<unsigned char>(bytes[place + i])} << (8 * i);
        }
        return word;
    }

private:
    ExrFile file_;
    std::uint64_t size_ = 0;
    std::uint64_t at_ = 0;
    bool good_ = false;
};

struct ExrHeader {
    double cols = 1.0;
    double rows = 1.0;
    double channels = 0.0;
    double lines = 1.0; // of a block
    double tile_cols = 0.0;
    double tile_rows = 0.0;
    bool is_empty = true;
};

// "OpenEXR file layout": compression methods by number.
double lines_of(unsigned char compression) {
    constexpr std::array<double, 10> lines{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    return lines.at(std::min<std::size_t>(compression, lines.size() - 1));
}

double side_between(std::string_view box, std::size_t low, std::size_t high) {
    return static_cast<double>(static_cast<std::int32_t>(ExrReader::word_in(box, high))) -
           static_cast<std::int32_t>(ExrReader::word_in(box, low)) + 1.0;
}

/// Channels are a name and 16 bytes each, an empty name ends them. Absent if the list ends
/// elsewhere: OpenEXR goes on to the empty name.
std::optional<double> channels_in(std::string_view list) {
    constexpr std::size_t bytes_of_channel = 16;
    double count = 0.0;
    for (auto end = list.find('\0'); end != 0; end = list.find('\0')) {
        if (end == std::string_view::npos || list.size() - end <= bytes_of_channel) {
            return std::nullopt;
        }
        list.remove_prefix(end + 1 + bytes_of_channel);
        ++count;
    }
    return list.size() == 1 ? std::optional(count) : std::nullopt;
}

/// Whether a value is as long as its type. OpenEXR reads that much, whatever the file states.
bool has_length_of(std::string_view type, std::size_t bytes) {
    using Length = std::pair<std::string_view, std::size_t>;
    constexpr std::array lengths{Length{"box2f", 16},
                                 Length{"box2i", 16},
                                 Length{"chromaticities", 32},
                                 Length{"compression", 1},
                                 Length{"deepImageState", 1},
                                 Length{"double", 8},
                                 Length{"envmap", 1},
                                 Length{"float", 4},
                                 Length{"int", 4},
                                 Length{"keycode", 28},
                                 Length{"lineOrder", 1},
                                 Length{"m33d", 72},
                                 Length{"m33f", 36},
                                 Length{"m44d", 128},
                                 Length{"m44f", 64},
                                 Length{"rational", 8},
                                 Length{"tiledesc", 9},
                                 Length{"timecode", 8},
                                 Length{"v2d", 16},
                                 Length{"v2f", 8},
                                 Length{"v2i", 8},
                                 Length{"v3d", 24},
                                 Length{"v3f", 12},
                                 Length{"v3i", 12}};
    const auto* const found = std::find_if(
        lengths.begin(), lengths.end(), [&](const Length& known) { return known.first == type; });
    const bool is_whole_floats = type != "floatvector" || bytes % sizeof(float) == 0;
    return is_whole_floats && (found == lengths.end() || found->second == bytes);
}

/// Whether the texts of a list are as long as they claim.
bool are_whole_texts(std::string_view list) {
    while (!list.empty()) {
        const std::size_t length = ExrReader::word_in(list, 0);
        if (list.size() < sizeof(std::uint32_t) || length > list.size() - sizeof(std::uint32_t)) {
            return false;
        }
        list.remove_prefix(sizeof(std::uint32_t) + length);
    }
    return true;
}

bool is_whole_preview(std::string_view preview) {
    const double pixels =
        static_cast<double>(ExrReader::word_in(preview, 0)) * ExrReader::word_in(preview, 4);
    return preview.size() >= 8 && 8.0 + 4.0 * pixels == static_cast<double>(preview.size());
}

/// Takes what an attribute says of the picture; false if it claims other lengths than it has.
bool take_attribute(std::string_view name, std::string_view type, std::string_view value,
                    ExrHeader& header) {
    if (name == "dataWindow") {
        header.cols = side_between(value, 0, 8);
        header.rows = side_between(value, 4, 12);
    }
    if (type == "chlist") {
        const auto channels = channels_in(value);
        header.channels += channels.value_or(0.0); // OpenEXR joins lists
        return channels.has_value();
    }
    if (name == "compression") {
        header.lines = lines_of(value.empty() ? 0 : static_cast<unsigned char>(value.front()));
    } else if (name == "tiles") {
        header.tile_cols = ExrReader::word_in(value, 0);
        header.tile_rows = ExrReader::word_in(value, 4);
    }
    return (type != "stringvector" || are_whole_texts(value)) &&
           (type != "preview" || is_whole_preview(value));
}

ExrHeader read_exr_header(ExrReader& reader) {
    ExrHeader header;
    for (std::string name = reader.text(); reader.good() && !name.empty(); name = reader.text()) {
        header.is_empty = false;
        const std::string type = reader.text();
        const std::uint64_t size = reader.word();
        if (!reader.good() || size > reader.left()) {
            reader.fail();
            return header;
        }
        // OpenEXR allocates what an ID manifest claims to hold.
        if (!has_length_of(type, size) || type == "idmanifest") {
            reader.fail();
            return header;
        }
        const bool is_short = size <= max_kept_attribute || type == "stringvector" ||
                              type == "preview" || type == "chlist";
        if (!is_short) {
            reader.skip(size);
        } else if (!take_attribute(name, type, reader.bytes(size), header)) {
            reader.fail();
        }
    }
    return header;
}

/// What a header claims too much of; empty if nothing.
std::string excess_of(const ExrHeader& header, double file_bytes) {
    constexpr double bytes_of_place = 8.0; // of a tile, in the table of tiles
    const bool is_tiled = header.tile_cols > 0.0 && header.tile_rows > 0.0;
    if (!(std::max(header.cols, header.rows) <= max_exr_side)) {
        return fmt::format("{:.0f}×{:.0f} pixels", header.cols, header.rows);
    }
    const double pixels =
        is_tiled ? header.tile_cols * header.tile_rows : header.cols * header.lines;
    if (pixels * exr_channel_bytes * header.channels > max_exr_block_bytes) {
        return fmt::format("blocks of {:.0f} pixels of {:.0f} channels", pixels, header.channels);
    }
    const double tiles =
        is_tiled ? header.cols / header.tile_cols * header.rows / header.tile_rows : 0.0;
    return tiles * bytes_of_place > file_bytes ? fmt::format("{:.0f} tiles", tiles) : std::string();
}

} // namespace

// "OpenEXR file layout" (openexr.com).
Result<void> check_exr(const std::string& name) {
    constexpr std::uint32_t magic = 20000630;
    constexpr std::uint32_t several_parts = 0x1000;
    ExrReader reader(name);
    if (reader.word() != magic) {
        return {};
    }
    const bool has_parts = (reader.word() & several_parts) != 0;
    for (bool is_last = false; !is_last;) {
        const ExrHeader header = read_exr_header(reader);
        if (!reader.good()) {
            return Error{fmt::format("{}: cannot be read (its header is cut off or claims other "
                                     "lengths than it has), a whole OpenEXR file was expected",
                                     name)};
        }
        if (const std::string excess = excess_of(header, reader.size()); !excess.empty()) {
            return Error{fmt::format(
                "{}: claims {} in {:.0f} bytes, at most {:.0f} pixels a side, "
                "blocks of {:.0f} MB and the tiles that it holds were expected",
                name, excess, reader.size(), max_exr_side, max_exr_block_bytes / (1 << 20))};
        }
        is_last = !has_parts || header.is_empty;
    }
    return {};
}

} // namespace reljef::io
