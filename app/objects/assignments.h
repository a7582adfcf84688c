#pragma once

#include <string>
#include <vector>

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

} // namespace reljef::app
