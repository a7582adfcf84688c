#include "app/cli/version.h"

namespace reljef::cli {

std::string version_text() {
    return "reljef " RELJEF_VERSION;
}

} // namespace reljef::cli
