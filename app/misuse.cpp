#include "app/misuse.h"

#include <CLI/CLI.hpp>

namespace reljef::app {

void refuse(const std::string& message) {
    throw CLI::ValidationError(message);
}

} // namespace reljef::app
