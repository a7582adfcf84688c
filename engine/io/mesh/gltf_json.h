#pragma once

#include <cstddef>

#include <nlohmann/json.hpp>

namespace reljef::io {

using Json = nlohmann::json;

// Reading of JSON that may have any form.

/// The value at a key; null where there is none.
const Json& at(const Json& json, const char* key);

/// The element of a list at an index; null where there is none.
const Json& at(const Json& list, const Json& index);

/// Of a list; 0 of anything else.
std::size_t size_of(const Json& json);

} // namespace reljef::io
