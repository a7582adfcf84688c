#include "app/cli/message.h"

#include <algorithm>
#include <bit>
#include <cstdio>

#include <fmt/format.h>

namespace reljef::cli {

void write_stderr(std::string_view text) noexcept {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

namespace {

// Bytes of the character that begins the text in UTF-8; 0: none does.
std::size_t character_size(std::string_view text) {
    const auto first = static_cast<unsigned char>(text.front());
    if (first < 0x80U) {
        return 1;
    }
    const bool is_first = first >= 0xC2U && first < 0xF5U;
    const std::size_t size = is_first ? static_cast<std::size_t>(std::countl_one(first)) : 0;
    const std::string_view rest = text.substr(1, size > 0 ? size - 1 : 0);
    const bool is_whole =
        rest.size() + 1 == size && std::all_of(rest.begin(), rest.end(), [](char c) {
            return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
        });
    return is_whole ? size : 0;
}

} // namespace

std::string printable(std::string_view text) {
    std::string shown;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
        const std::size_t size = character_size(text.substr(i));
        if (byte < 0x20U || byte == 0x7FU || size == 0) {
            shown += fmt::format("\\x{:02x}", byte);
        } else if (byte == 0xC2U && next >= 0x80U && next < 0xA0U) { // U+0080 to U+009F, UTF-8
            shown += fmt::format("\\x{:02x}", next);
            ++i;
        } else {
            shown += text.substr(i, size);
            i += size - 1;
        }
    }
    return shown;
}

} // namespace reljef::cli
