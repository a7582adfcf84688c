#pragma once

#include <string>
#include <string_view>

namespace reljef::cli {

/// Writes to stderr. Where nobody can read it, it is lost: telling is never what fails.
void write_stderr(std::string_view text) noexcept;

/// The text in one line without control characters, each told as "\\x1b": what names hold can
/// neither forge a line nor steer a terminal.
std::string printable(std::string_view text);

} // namespace reljef::cli
