#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/core/result.h"

namespace reljef::cli {

/// A number that is the whole text, or nothing.
template <class T> std::optional<T> number_from(std::string_view text) {
    T value{};
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc{} || end != text.data() + text.size()) {
        return std::nullopt;
    }
    return value;
}

/// Lets a parser with a Result set `target` and turns its error into the parser library's.
template <class Parse, class Target>
CLI::Option* add_parsed(CLI::App& command, const char* names, Target& target, const Parse& parse,
                        const char* description, const char* type) {
    return command
        .add_option_function<std::string>(
            names,
            [&target, parse](const std::string& text) {
                auto value = parse(text);
                if (!value) {
                    throw CLI::ValidationError(value.error().message);
                }
                target = std::move(*value);
            },
            description)
        ->type_name(type);
}

/// Parses a number in [low, high], or above low where `above`.
inline auto number_in(std::string option, double low, double high, bool above = false) {
    return [=](const std::string& text) -> Result<double> {
        const auto value = number_from<double>(text);
        if (!value || !(above ? *value > low : *value >= low) || !(*value <= high)) {
            return Error{fmt::format("{}: '{}' found, a number {} {} to {} was expected", option,
                                     text, above ? "over" : "from", low, high)};
        }
        return *value;
    };
}

/// The same of whole numbers.
inline auto whole_number_in(std::string option, int low, int high) {
    return [=](const std::string& text) -> Result<int> {
        const auto value = number_from<int>(text);
        if (!value || *value < low || *value > high) {
            return Error{fmt::format("{}: '{}' found, a whole number from {} to {} was expected",
                                     option, text, low, high)};
        }
        return *value;
    };
}

/// Looks a word up in a list of (word, value).
template <class T> auto word_of(std::string option, std::vector<std::pair<std::string, T>> words) {
    return [=](const std::string& text) -> Result<T> {
        std::string expected;
        for (const auto& [word, value] : words) {
            if (word == text) {
                return value;
            }
            expected += (expected.empty() ? "" : ", ") + word;
        }
        return Error{fmt::format("{}: '{}' found, one of {} was expected", option, text, expected)};
    };
}

} // namespace reljef::cli
