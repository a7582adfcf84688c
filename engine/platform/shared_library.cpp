#include "engine/platform/shared_library.h"

#include <string>

namespace reljef::platform {

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

} // namespace reljef::platform
