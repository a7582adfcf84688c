#include "engine/gl/shader_log.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <system_error>

#include <fmt/format.h>

namespace reljef::gl {

namespace {

struct Located {
    std::size_t file = 0;
    int line = 0;
    std::string_view text;
};

template <class Number> std::optional<Number> take_number(std::string_view& text) {
    Number number = 0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (status != std::errc{}) {
        return std::nullopt;
    }
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

bool take(std::string_view& text, std::string_view prefix) {
    const bool found = text.starts_with(prefix);
    if (found) {
        text.remove_prefix(prefix.size());
    }
    return found;
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blank(" \t\r\0", 4);
    const std::size_t first = text.find_first_not_of(blank);
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// "FILE:LINE" or "FILE(LINE)", then an optional "(COLUMN)" and a colon.
std::optional<Located> locate(std::string_view text) {
    take(text, "ERROR: ");
    const auto file = take_number<std::size_t>(text);
    if (!file || !(take(text, ":") || take(text, "("))) {
        return std::nullopt;
    }
    const auto line = take_number<int>(text);
    const std::size_t colon = text.find(':');
    if (!line || colon == std::string_view::npos) {
        return std::nullopt;
    }
    if (text.substr(0, colon).find_first_not_of("() 0123456789") != std::string_view::npos) {
        return std::nullopt;
    }
    return Located{*file, *line, trimmed(text.substr(colon + 1))};
}

std::string_view file_name(const StageSource& source, std::size_t number) {
    return number >= 1 && number <= source.included.size() ? source.included[number - 1]
                                                           : source.name;
}

std::string readable_line(const StageSource& source, std::string_view line) {
    const auto located = locate(line);
    if (!located) {
        return std::string(line);
    }
    return fmt::format("{}:{}: {}", file_name(source, located->file), located->line, located->text);
}

} // namespace

std::string readable_log(const StageSource& source, std::string_view log) {
    std::string all;
    while (!log.empty()) {
        const std::size_t end = std::min(log.find('\n'), log.size());
        const std::string_view line = trimmed(log.substr(0, end));
        log.remove_prefix(std::min(end + 1, log.size()));
        if (!line.empty()) {
            all += (all.empty() ? "" : "; ") + readable_line(source, line);
        }
    }
    return all;
}

} // namespace reljef::gl
