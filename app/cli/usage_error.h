#pragma once

#include <string>

namespace reljef::cli {

/// Ends a command whose options are wrong for what they are about, which only that shows: with one
/// line and exit status 2, as what is wrong by itself (throws CLI::ParseError, which run_program
/// catches). Never where a file is at fault.
[[noreturn]] void fail_usage(const std::string& message);

} // namespace reljef::cli
