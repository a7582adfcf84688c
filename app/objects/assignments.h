#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/result.h"

namespace reljef::app {

/// "key=value" behind a file.
struct Assignment {
    std::string key;
    std::string value;
};

/// The assignments of "a=1,b=2,3": a part without '=' belongs to the value before it. Fails if a
/// key is there twice. `option`: for errors.
Result<std::vector<Assignment>> assignments_of(const std::string& text, const std::string& option);

/// "LAT,LON" in degrees, or "X,Y" in scene metres. `option`: for errors.
Result<glm::dvec2> parse_place(const std::string& text, const std::string& option);

/// Sets `number` to a parsed value.
template <class Number> Result<void> set_number(Number& number, const Result<double>& value) {
    if (!value) {
        return value.error();
    }
    number = *value;
    return {};
}

/// Sets a colour from "#rrggbb". `option`: for errors.
Result<void> set_color(Rgba8& color, const std::string& text, const std::string& option);

/// Adds an option that may be repeated, each time with one value: `parse` makes it from a text.
/// Errors, and more than `max` values, throw CLI::ValidationError.
template <class Value>
CLI::Option* add_repeated(CLI::App& command, const std::string& name, std::vector<Value>& values,
                          std::size_t max, Result<Value> (*parse)(const std::string&),
                          const std::string& help) {
    const auto read = [&values, name, max, parse](const std::vector<std::string>& texts) {
        if (texts.size() > max) {
            throw CLI::ValidationError(fmt::format("{}: found {} times, at most {} were expected",
                                                   name, texts.size(), max));
        }
        values.clear();
        for (const std::string& text : texts) {
            auto value = parse(text);
            if (!value) {
                throw CLI::ValidationError(value.error().message);
            }
            values.push_back(*value);
        }
    };
    return command.add_option_function<std::vector<std::string>>(name, read, help)
        ->allow_extra_args(false);
}

} // namespace reljef::app
