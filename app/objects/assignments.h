#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>

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

} // namespace reljef::app
