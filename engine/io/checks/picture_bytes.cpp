#include "engine/io/checks/picture_bytes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include <cpl_vsi.h>
#include <fmt/format.h>

#include "engine/io/checks/little_endian.h"
#include "engine/io/remote/read_scope.h"

namespace reljef::io {
namespace {

using namespace std::string_view_literals;

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

struct ChunkHead {
    std::string type;
    vsi_l_offset length; // bytes
};

ChunkHead chunk_head(const Bytes<8>& bytes) {
    ChunkHead head{std::string(bytes.begin() + 4, bytes.end()), 0};
    std::for_each(bytes.begin(), bytes.begin() + 4,
                  [&](unsigned char byte) { head.length = head.length * 256 + byte; });
    return head;
}

/// What libpng allocates for a chunk, bytes: its length before it is read, then what it inflates
/// to.
double allocated_bytes(const ChunkHead& chunk) {
    constexpr std::array compressed{"zTXt"sv, "iTXt"sv, "iCCP"sv};
    constexpr std::array plain{"tEXt"sv, "sPLT"sv, "eXIf"sv, "pCAL"sv, "sCAL"sv};
    const auto length = static_cast<double>(chunk.length);
    if (std::find(compressed.begin(), compressed.end(), chunk.type) != compressed.end()) {
        return std::max(length, std::min(max_chunk_bytes, length * max_inflation));
    }
    return std::find(plain.begin(), plain.end(), chunk.type) != plain.end() ? length : 0.0;
}

/// Goes behind a chunk whose head was read. False if the file ends in it.
bool pass_chunk(const File& file, const ChunkHead& chunk) {
    Bytes<4> checksum{};
    return VSIFSeekL(file.get(), chunk.length, SEEK_CUR) == 0 && read_head(file, checksum);
}

template <std::size_t count> std::string_view text_of(const Bytes<count>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), count};
}

// "WebP Container Specification" and "WebP Lossless Bitstream Specification", RFC 9649; RFC 6386,
// 9.1. `head`: the first 30 bytes.
glm::ivec2 webp_size(std::string_view head) {
    constexpr std::uint64_t max_frame = 0x3FFF;
    const std::string_view chunk = head.substr(12, 4);
    if (chunk == "VP8X") {
        return glm::ivec2(little_endian(head, 24, 3), little_endian(head, 27, 3)) + 1;
    }
    if (chunk == "VP8L") {
        const std::uint64_t bits = little_endian(head, 21, 4);
        return glm::ivec2(bits & max_frame, bits >> 14U & max_frame) + 1;
    }
    return {little_endian(head, 26, 2) & max_frame, little_endian(head, 28, 2) & max_frame};
}

Error png_without_end(const std::string& name) {
    return Error{fmt::format("{}: cannot be read (it is a PNG without its end), a whole "
                             "picture was expected",
                             name)};
}

} // namespace

// PNG specification, 5.2 and 5.3.
Result<void> check_png(const std::string& name, PngPart part) {
    constexpr Bytes<8> signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    const File file = opened_file(name);
    Bytes<8> head{};
    if (!read_head(file, head) || head != signature) {
        return {};
    }
    double allocated = 0.0;
    while (read_head(file, head)) {
        const ChunkHead chunk = chunk_head(head);
        if (chunk.type == "IEND" || (chunk.type == "IDAT" && part == PngPart::until_pixels)) {
            return {};
        }
        allocated += allocated_bytes(chunk);
        if (allocated > max_text_bytes) {
            return Error{
                fmt::format("{}: holds texts and colour profiles that may take over {:.0f} "
                            "MB, a PNG with less beside its pixels was expected",
                            name, max_text_bytes / 1e6)};
        }
        if (ReadScope::stop_requested()) {
            return Error{fmt::format("{}: reading was stopped", name)};
        }
        if (!pass_chunk(file, chunk)) {
            return png_without_end(name);
        }
    }
    return png_without_end(name);
}

// "Graphics Interchange Format", version 89a, 18. What a short file lacks is 0.
std::optional<glm::ivec2> claimed_size(const std::string& name) {
    Bytes<30> bytes{};
    if (const File file = opened_file(name); file != nullptr) {
        VSIFReadL(bytes.data(), 1, bytes.size(), file.get());
    }
    const std::string_view head = text_of(bytes);
    if (head.starts_with("GIF8")) {
        return glm::ivec2(little_endian(head, 6, 2), little_endian(head, 8, 2));
    }
    const bool is_webp = head.starts_with("RIFF") && head.substr(8, 4) == "WEBP";
    return is_webp ? std::optional(webp_size(head)) : std::nullopt;
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
