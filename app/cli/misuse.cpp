#include "app/cli/misuse.h"

#include <CLI/CLI.hpp>

namespace reljef::cli {

void refuse(const std::string& message) {
    throw CLI::ValidationError(message);
}

} // namespace reljef::cli
