#include "engine/io/checks/jpeg2000_bytes.h"

#include <algorithm>
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

struct CodestreamRange {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;

    [[nodiscard]] bool holds(std::uint64_t at, std::uint64_t count) const {
        return at <= end && count <= end - at;
    }
};

/// Big-endian numbers of a file; absent if they are not within it.
class Jpeg2000File {
public:
    explicit Jpeg2000File(const std::string& name)
        : file_(VSIFOpenL(name.c_str(), "rb"), &VSIFCloseL) {
        VSIStatBufL status{};
        const bool is_there = file_ != nullptr && VSIStatL(name.c_str(), &status) == 0;
        whole_.end = is_there ? static_cast<std::uint64_t>(status.st_size) : 0;
    }
    [[nodiscard]] const CodestreamRange& whole() const { return whole_; }

    [[nodiscard]] std::optional<std::uint64_t> number(std::uint64_t at, std::size_t bytes) const {
        return number_in(whole_, at, bytes);
    }
    /// Also absent if it is not within the range.
    [[nodiscard]] std::optional<std::uint64_t>
    number_in(const CodestreamRange& range, std::uint64_t at, std::size_t bytes) const {
        std::array<unsigned char, sizeof(std::uint64_t)> read{};
        if (!range.holds(at, bytes) || VSIFSeekL(file_.get(), at, SEEK_SET) != 0 ||
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
    CodestreamRange whole_;
};

/// The content of the first box with a codestream; absent if a box does not fit.
std::optional<CodestreamRange> boxed_codestream(const Jpeg2000File& file) {
    for (std::uint64_t at = 0; !ReadScope::stop_requested();) {
        auto length = file.number(at, 4);
        const auto type = file.number(at + 4, 4);
        if (!length || !type) {
            return std::nullopt;
        }
        const std::uint64_t head = *length == 1 ? 16 : 8;
        length = *length == 1 ? file.number(at + 8, 8) : length;
        length = length == std::uint64_t{0} ? file.whole().end - at : length; // up to the end
        if (!length || *length < head || *length > file.whole().end - at) {
            return std::nullopt;
        }
        if ((*type | letter_case) == codestream_box) {
            return CodestreamRange{at + head, at + *length};
        }
        at += *length;
    }
    return std::nullopt;
}

/// Passes segments up to a marker; absent if one of them does not fit.
std::optional<std::uint64_t> find_marker(const Jpeg2000File& file, std::uint64_t at,
                                         const CodestreamRange& range, std::uint64_t marker) {
    auto found = file.number_in(range, at, 2);
    while (found && *found != marker) {
        const auto length = file.number_in(range, at + 2, 2);
        if (*found < first_marker || !length || *length < 2 || !range.holds(at + 2, *length)) {
            return std::nullopt;
        }
        at += 2 + *length;
        found = file.number_in(range, at, 2);
    }
    return found ? std::optional(at) : std::nullopt;
}

/// Behind a part of a tile; absent if it or its header does not fit.
std::optional<std::uint64_t> end_of_tile_part(const Jpeg2000File& file, std::uint64_t at,
                                              const CodestreamRange& codestream) {
    constexpr std::uint64_t head = 12;
    const auto length = file.number_in(codestream, at + 6, 4);
    if (!length || !codestream.holds(at, std::max(head, *length))) {
        return std::nullopt;
    }
    const CodestreamRange part{at, *length == 0 ? codestream.end : at + *length};
    return find_marker(file, at + head, part, start_of_data) ? std::optional(part.end)
                                                             : std::nullopt;
}

/// A header, then parts of tiles up to the end or its marker.
bool is_whole(const Jpeg2000File& file, const CodestreamRange& codestream) {
    if (file.number_in(codestream, codestream.begin, 2) != start_of_codestream) {
        return false;
    }
    auto at = find_marker(file, codestream.begin + 2, codestream, start_of_tile_part);
    while (at && *at != codestream.end && !ReadScope::stop_requested()) {
        const auto marker = file.number_in(codestream, *at, 2);
        if (marker == end_of_codestream) {
            return true;
        }
        at = marker == start_of_tile_part ? end_of_tile_part(file, *at, codestream) : std::nullopt;
    }
    return at.has_value();
}

} // namespace

Result<void> check_jpeg2000(const std::string& name) {
    const Jpeg2000File file(name);
    const bool is_bare = file.number(0, 4) == signature_of_codestream;
    if (!is_bare && file.number(4, 4) != signature_of_boxes) {
        return {};
    }
    const auto codestream = is_bare ? std::optional(file.whole()) : boxed_codestream(file);
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
