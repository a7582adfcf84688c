#pragma once

#include <string>

namespace reljef::cli {

/// Throws CLI::ParseError: the program ends with this message and exit status 2. For wrong options,
/// not for wrong files.
[[noreturn]] void fail_usage(const std::string& message);

} // namespace reljef::cli
