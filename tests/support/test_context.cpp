#include "tests/support/test_context.h"

#include <cstdlib>

namespace reljef::test {

std::string context_name() {
    const char* const chosen = std::getenv("RELJEF_TEST_CONTEXT");
    return chosen == nullptr ? "osmesa" : chosen;
}

} // namespace reljef::test
