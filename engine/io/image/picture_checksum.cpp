#include "engine/io/image/picture_checksum.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "engine/io/cache/fnv_hash.h"

namespace reljef::io {
namespace {

constexpr std::size_t digits = 16;
constexpr std::string_view words = checksum_text.substr(0, checksum_text.size() - digits);

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Where the digits of each checksum begin.
std::vector<std::size_t> checksums_in(std::string_view picture) {
    std::vector<std::size_t> places;
    for (auto found = picture.find(words); found != picture.npos;
         found = picture.find(words, found + words.size())) {
        if (const std::size_t place = found + words.size(); place + digits <= picture.size()) {
            places.push_back(place);
        }
    }
    return places;
}

// The digits that belong into a picture.
std::string right_digits(std::string_view picture, std::span<const std::size_t> places) {
    std::uint64_t hash = fnv_start;
    std::size_t begin = 0;
    for (const std::size_t place : places) {
        hash = fnv_hash(picture.substr(begin, place - begin), hash);
        hash = fnv_hash(std::string(digits, '0'), hash);
        begin = place + digits;
    }
    return fmt::format("{:016x}", fnv_hash(picture.substr(begin), hash));
}

} // namespace

std::vector<std::byte> with_checksum(std::vector<std::byte> picture) {
    const auto places = checksums_in(text_of(picture));
    const std::string right = right_digits(text_of(picture), places);
    for (const std::size_t place : places) {
        const auto bytes = std::as_bytes(std::span(right));
        std::copy(bytes.begin(), bytes.end(), picture.begin() + static_cast<std::ptrdiff_t>(place));
    }
    return picture;
}

bool has_right_checksum(std::span<const std::byte> picture) {
    const std::string_view text = text_of(picture);
    const auto places = checksums_in(text);
    const std::string right = right_digits(text, places);
    return !places.empty() && std::all_of(places.begin(), places.end(), [&](std::size_t place) {
        return text.substr(place, digits) == right;
    });
}

} // namespace reljef::io
