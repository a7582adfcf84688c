#include "app/cli/message.h"

#include <cstdio>

#include <fmt/format.h>

namespace reljef::cli {

void write_stderr(std::string_view text) noexcept {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

std::string printable(std::string_view text) {
    std::string shown;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
        if (byte < 0x20U || byte == 0x7FU) {
            shown += fmt::format("\\x{:02x}", byte);
        } else if (byte == 0xC2U && next >= 0x80U && next < 0xA0U) { // U+0080 to U+009F, UTF-8
            shown += fmt::format("\\x{:02x}", next);
            ++i;
        } else {
            shown += text[i];
        }
    }
    return shown;
}

} // namespace reljef::cli
