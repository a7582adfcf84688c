#include "bench/page/page_data_uri.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

namespace reljef::bench {
namespace {

constexpr std::string_view base64_digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

// Up to three bytes as four digits, the last ones '=' where there are fewer.
void append_group(std::string& text, std::span<const std::byte> bytes) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        bits = (bits << 8U) | (i < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i]) : 0U);
    }
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t digit = (bits >> (18U - 6U * i)) & 63U;
        text += i <= bytes.size() ? base64_digits[digit] : '=';
    }
}

} // namespace

std::string data_uri(std::string_view media_type, std::span<const std::byte> bytes) {
    std::string text = fmt::format("data:{};base64,", media_type);
    text.reserve(text.size() + (bytes.size() + 2) / 3 * 4);
    for (std::size_t begin = 0; begin < bytes.size(); begin += 3) {
        append_group(text, bytes.subspan(begin, std::min<std::size_t>(3, bytes.size() - begin)));
    }
    return text;
}

} // namespace reljef::bench
