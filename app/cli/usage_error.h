#pragma once

#include <string>

namespace CLI {
class ParseError;
}

namespace reljef::cli {

/// Throws CLI::ParseError: the program ends with this message and exit status 2. For wrong options,
/// not for wrong files.
[[noreturn]] void fail_usage(const std::string& message);

/// What was found and what was expected, also for errors that CLI11 words itself.
std::string usage_text(const CLI::ParseError& error);

} // namespace reljef::cli
