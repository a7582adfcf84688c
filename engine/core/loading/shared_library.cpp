#include "engine/core/loading/shared_library.h"

#include <string>

namespace reljef {

Result<void*> open_library(std::span<const char* const> names) {
    std::string reason;
    for (const char* name : names) {
        if (void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE)) {
            return library;
        }
        const char* text = dlerror();
        if (reason.empty()) {
            reason = text == nullptr ? "unknown reason" : text;
        }
    }
    return Error{reason};
}

} // namespace reljef
