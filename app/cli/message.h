#pragma once

#include <string>
#include <string_view>

namespace reljef::cli {

/// Writes to stderr and ignores failures.
void write_stderr(std::string_view text) noexcept;

/// The text with control characters as "\\x1b", so that names cannot control a terminal.
std::string printable(std::string_view text);

} // namespace reljef::cli
