#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "engine/core/result.h"

namespace reljef::cli {

/// The number, if it is the whole text.
template <class T> std::optional<T> number_from(std::string_view text) {
    T value{};
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc{} || end != text.data() + text.size()) {
        return std::nullopt;
    }
    return value;
}

/// Parses exactly `N` finite numbers separated by commas; `option` is named in the error.
template <std::size_t N>
Result<std::array<double, N>> parse_numbers(std::string_view option, std::string_view text,
                                            std::string_view expected) {
    std::array<double, N> numbers{};
    std::string_view rest = text;
    bool right = true;
    for (std::size_t i = 0; i < N && right; ++i) {
        const auto comma = rest.find(',');
        const auto value = number_from<double>(rest.substr(0, comma));
        const bool is_last = comma == std::string_view::npos;
        right = value && std::isfinite(*value) && is_last == (i + 1 == N);
        numbers[i] = value.value_or(0.0);
        rest = is_last ? std::string_view() : rest.substr(comma + 1);
    }
    if (!right) {
        return Error{fmt::format("{}: '{}' found, {} was expected", option, text, expected)};
    }
    return numbers;
}

/// Adds an option that `parse` converts for `target`. Its errors become CLI::ValidationError.
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

/// Parses a number in [low, high]; with `above` it must be larger than `low`.
template <class T = double>
auto number_in(std::string option, std::type_identity_t<T> low, std::type_identity_t<T> high,
               bool above = false) {
    return [=](const std::string& text) -> Result<T> {
        const auto value = number_from<T>(text);
        if (!value || !(above ? *value > low : *value >= low) || !(*value <= high)) {
            return Error{fmt::format("{}: '{}' found, a {} {} {} {} {} was expected", option, text,
                                     std::is_integral_v<T> ? "whole number" : "number",
                                     above ? "above" : "from", low, above ? "and at most" : "to",
                                     high)};
        }
        return *value;
    };
}

/// A check that a text is one of `words`.
inline CLI::Validator one_of(std::vector<std::string> words) {
    return {[words = std::move(words)](const std::string& text) {
                return std::find(words.begin(), words.end(), text) != words.end()
                           ? std::string()
                           : fmt::format("'{}' found, one of {} was expected", text,
                                         fmt::join(words, ", "));
            },
            ""};
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
