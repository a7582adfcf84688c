#pragma once

#include <span>

#include <dlfcn.h>

#include "engine/core/result.h"

namespace reljef {

/// Opens the first library that exists and keeps its names apart from those of other libraries. It
/// is never closed: libraries leave thread-local and exit handlers behind. Fails with the loader's
/// message for the first name.
Result<void*> open_library(std::span<const char* const> names);

/// Sets `function` to the library's function `name`; false and null when there is none.
template <class F> bool load(void* library, F& function, const char* name) {
    function = reinterpret_cast<F>(dlsym(library, name));
    return function != nullptr;
}

} // namespace reljef
