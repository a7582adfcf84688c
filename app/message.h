#pragma once

#include <string_view>

namespace reljef::app {

/// Writes to stderr. Where nobody can read it, it is lost: telling is never what fails.
void tell(std::string_view text) noexcept;

} // namespace reljef::app
