#include "engine/io/checks/jpeg2000_bytes.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include <cpl_vsi.h>
#include <fmt/format.h>

#include "engine/io/remote/read_scope.h"

namespace reljef::io {
namespace {

// ISO/IEC 15444-1, A.2 and I.2.2.
constexpr std::uint64_t start_of_codestream = 0xFF4F;
constexpr std::uint64_t start_of_tile_part = 0xFF90;
constexpr std::uint64_t start_of_data = 0xFF93;
constexpr std::uint64_t end_of_codestream = 0xFFD9;
constexpr std::uint64_t first_marker = 0xFF00;
constexpr std::uint64_t signature_of_codestream = 0xFF4FFF51;
constexpr std::uint64_t signature_of_boxes = 0x6A502020; // "jP  "
constexpr std::uint64_t codestream_box = 0x6A703263;     // "jp2c"
constexpr std::uint64_t letter_case = 0x20200020;        // GDAL takes "JP2C", too

/// Big-endian numbers of a file; absent beyond its end.
class Jpeg2000File {
public:
    explicit Jpeg2000File(const std::string& name)
        : file_(VSIFOpenL(name.c_str(), "rb"), &VSIFCloseL) {
        VSIStatBufL status{};
        const bool is_there = file_ != nullptr && VSIStatL(name.c_str(), &status) == 0;
        size_ = is_there ? static_cast<std::uint64_t>(status.st_size) : 0;
    }
    [[nodiscard]] std::uint64_t size() const { return size_; }

    [[nodiscard]] std::optional<std::uint64_t> number(std::uint64_t at, std::size_t bytes) const {
        std::array<unsigned char, sizeof(std::uint64_t)> read{};
        if (at > size_ || bytes > size_ - at || VSIFSeekL(file_.get(), at, SEEK_SET) != 0 ||
            VSIFReadL(read.data(), 1, bytes, file_.get()) != bytes) {
            return std::nullopt;
        }
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < bytes; ++i) {
            value = value << 8U | read.at(i);
        }
        return value;
    }

private:
    std::unique_ptr<VSILFILE, decltype(&VSIFCloseL)> file_;
    std::uint64_t size_ = 0;
};

struct ByteRange {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;

    [[nodiscard]] bool holds(std::uint64_t at, std::uint64_t count) const {
        return at <= end && count <= end - at;
    }
};

/// The content of the first box with a codestream; absent if a box does not fit.
std::optional<ByteRange> boxed_codestream(const Jpeg2000File& file) {
    for (std::uint64_t at = 0; !ReadScope::stop_requested();) {
        auto length = file.number(at, 4);
        const auto type = file.number(at + 4, 4);
        if (!length || !type) {
            return std::nullopt;
        }
        const std::uint64_t head = *length == 1 ? 16 : 8;
        length = *length == 1 ? file.number(at + 8, 8) : length;
        length = length == std::uint64_t{0} ? file.size() - at : length; // up to the end
        if (!length || *length < head || *length > file.size() - at) {
            return std::nullopt;
        }
        if ((*type | letter_case) == codestream_box) {
            return ByteRange{at + head, at + *length};
        }
        at += *length;
    }
    return std::nullopt;
}

/// Behind the segment of a marker; absent if it does not fit.
std::optional<std::uint64_t> end_of_segment(const Jpeg2000File& file, std::uint64_t at,
                                            const ByteRange& bytes) {
    const auto length = bytes.holds(at, 4) ? file.number(at + 2, 2) : std::nullopt;
    const bool fits = length && *length >= 2 && bytes.holds(at + 2, *length);
    return fits ? std::optional(at + 2 + *length) : std::nullopt;
}

/// Behind a part of a tile; absent if it or its header does not fit.
std::optional<std::uint64_t> end_of_tile_part(const Jpeg2000File& file, std::uint64_t at,
                                              const ByteRange& codestream) {
    constexpr std::uint64_t head = 12;
    const auto length = codestream.holds(at, head) ? file.number(at + 6, 4) : std::nullopt;
    if (!length || (*length != 0 && !codestream.holds(at, *length))) {
        return std::nullopt;
    }
    const ByteRange part{at, *length == 0 ? codestream.end : at + *length};
    std::optional<std::uint64_t> next = end_of_segment(file, at, part);
    while (next) {
        const auto marker = part.holds(*next, 2) ? file.number(*next, 2) : std::nullopt;
        if (!marker || *marker == start_of_data) {
            return marker ? std::optional(part.end) : std::nullopt;
        }
        next = *marker >= first_marker ? end_of_segment(file, *next, part) : std::nullopt;
    }
    return std::nullopt;
}

/// A header, then parts of tiles up to the end or its marker.
bool is_whole(const Jpeg2000File& file, const ByteRange& codestream) {
    if (!codestream.holds(codestream.begin, 2) ||
        file.number(codestream.begin, 2) != start_of_codestream) {
        return false;
    }
    bool has_tiles = false;
    std::optional<std::uint64_t> at = codestream.begin + 2;
    while (at && *at != codestream.end && !ReadScope::stop_requested()) {
        const auto marker = codestream.holds(*at, 2) ? file.number(*at, 2) : std::nullopt;
        if (!marker || *marker == end_of_codestream) {
            return marker && has_tiles;
        }
        if (*marker == start_of_tile_part) {
            at = end_of_tile_part(file, *at, codestream);
            has_tiles = true;
        } else {
            const bool is_header = *marker >= first_marker && !has_tiles;
            at = is_header ? end_of_segment(file, *at, codestream) : std::nullopt;
        }
    }
    return at && has_tiles;
}

} // namespace

Result<void> check_jpeg2000(const std::string& name) {
    const Jpeg2000File file(name);
    const bool is_bare = file.number(0, 4) == signature_of_codestream;
    if (!is_bare && file.number(4, 4) != signature_of_boxes) {
        return {};
    }
    const auto codestream =
        is_bare ? std::optional(ByteRange{0, file.size()}) : boxed_codestream(file);
    const bool is_good = codestream && is_whole(file, *codestream);
    if (ReadScope::stop_requested()) {
        return Error{fmt::format("{}: reading was stopped", name)};
    }
    return is_good
               ? Result<void>()
               : Error{fmt::format("{}: cannot be read (a part of it ends behind what holds it), "
                                   "a whole JPEG 2000 picture was expected",
                                   name)};
}

} // namespace reljef::io
