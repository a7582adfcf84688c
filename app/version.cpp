#include "app/version.h"

namespace reljef::app {

std::string version_text() {
    return "reljef " RELJEF_VERSION;
}

} // namespace reljef::app
