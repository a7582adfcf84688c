#include "app/cli/usage_error.h"

#include <CLI/CLI.hpp>

namespace reljef::cli {

void fail_usage(const std::string& message) {
    throw CLI::ValidationError(message);
}

} // namespace reljef::cli
