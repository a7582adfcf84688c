#include "engine/core/check.h"

#include <cstdio>
#include <cstdlib>

namespace reljef {

void abort_with(const char* what) {
    std::fprintf(stderr, "reljef: broken precondition: %s\n", what);
    std::abort();
}

} // namespace reljef
