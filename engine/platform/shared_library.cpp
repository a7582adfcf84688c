#include "engine/platform/shared_library.h"

#include <string>

#include <dlfcn.h>

namespace reljef::platform {

namespace {

std::string loader_error() {
    const char* text = dlerror();
    return text == nullptr ? "unknown reason" : text;
}

} // namespace

Result<SharedLibrary> SharedLibrary::open(std::span<const char* const> names) {
    std::string why;
    for (const char* name : names) {
        if (void* handle = dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE); handle != nullptr) {
            return SharedLibrary(handle);
        }
        const std::string reason = loader_error();
        why = why.empty() ? reason : why;
    }
    return Error{why};
}

void SharedLibrary::Close::operator()(void* handle) const {
    dlclose(handle);
}

void* SharedLibrary::address(const char* name) const {
    return dlsym(handle_.get(), name);
}

} // namespace reljef::platform
