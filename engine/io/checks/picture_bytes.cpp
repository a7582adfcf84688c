#include "engine/io/checks/picture_bytes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <string_view>

#include <cpl_vsi.h>
#include <fmt/format.h>

#include "engine/io/remote/read_scope.h"

namespace reljef::io {
namespace {

constexpr double max_inflation = 1032.0; // deflate (RFC 1951): 258 bytes for two bits
constexpr double max_chunk_bytes = 8e6;  // libpng's limit of each, PNG_USER_CHUNK_MALLOC_MAX
constexpr double max_text_bytes = 8 * max_chunk_bytes; // programs write one to four

using File = std::unique_ptr<VSILFILE, decltype(&VSIFCloseL)>;

File opened_file(const std::string& name) {
    return {VSIFOpenL(name.c_str(), "rb"), &VSIFCloseL};
}

template <std::size_t count> using Bytes = std::array<unsigned char, count>;

template <std::size_t count> bool read_head(const File& file, Bytes<count>& head) {
    return file != nullptr && VSIFReadL(head.data(), 1, count, file.get()) == count;
}

/// What libpng keeps of a chunk, bytes.
double kept_bytes(std::string_view type, double length) {
    const bool is_compressed = type == "zTXt" || type == "iTXt" || type == "iCCP";
    const bool is_kept = is_compressed || type == "tEXt" || type == "sPLT" || type == "eXIf";
    return is_kept ? std::min(max_chunk_bytes, length * (is_compressed ? max_inflation : 1.0))
                   : 0.0;
}

} // namespace

// PNG specification, 5.2 and 5.3.
Result<void> check_png(const std::string& name, PngPart part) {
    constexpr Bytes<8> signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    constexpr vsi_l_offset checksum_bytes = 4;
    const File file = opened_file(name);
    Bytes<8> head{};
    if (!read_head(file, head) || head != signature) {
        return {};
    }
    double kept = 0.0;
    while (read_head(file, head)) {
        const std::string type(head.begin() + 4, head.end());
        if (type == "IEND" || (type == "IDAT" && part == PngPart::until_pixels)) {
            return {};
        }
        vsi_l_offset length = 0;
        std::for_each(head.begin(), head.begin() + 4,
                      [&](unsigned char byte) { length = length * 256 + byte; });
        kept += kept_bytes(type, static_cast<double>(length));
        if (kept > max_text_bytes) {
            return Error{
                fmt::format("{}: holds texts and colour profiles that may take over {:.0f} "
                            "MB, a PNG with less beside its pixels was expected",
                            name, max_text_bytes / 1e6)};
        }
        if (ReadScope::stop_requested()) {
            return Error{fmt::format("{}: reading was stopped", name)};
        }
        VSIFSeekL(file.get(), length + checksum_bytes, SEEK_CUR);
    }
    return part == PngPart::until_pixels
               ? Result<void>()
               : Error{fmt::format("{}: cannot be read (it is a PNG without its end), a whole "
                                   "picture was expected",
                                   name)};
}

// Truevision's specification 2.0. Run-length packets hold a pixel for up to 128.
Result<void> check_tga(const std::string& name, int cols, int rows) {
    constexpr unsigned run_length_bit = 8;
    Bytes<18> head{};
    VSIStatBufL status{};
    if (!read_head(opened_file(name), head) || VSIStatL(name.c_str(), &status) != 0) {
        return {}; // GDAL opened it, and reads its pixels
    }
    const double pixels = static_cast<double>(cols) * rows;
    const double pixel_bytes = std::max(head[16] / 8, 1);
    const double expected = (head[2] & run_length_bit) != 0 ? pixels / 128.0 * (1.0 + pixel_bytes)
                                                            : pixels * pixel_bytes;
    const auto found = static_cast<double>(status.st_size);
    if (found >= expected) {
        return {};
    }
    return Error{fmt::format("{}: ends early: {:.0f} bytes were found, at least {:.0f} were "
                             "expected of {}×{} pixels",
                             name, found, expected, cols, rows)};
}

} // namespace reljef::io
