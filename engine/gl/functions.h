#pragma once

#include "engine/core/result.h"

namespace reljef::gl {

/// A context library's function that looks up one GL function.
using GetProcAddress = void (*(*)(const char* name))();

/// Loads the OpenGL 4.5 core functions of the current context. The process has one table (glad's):
/// load again after another context becomes current, and use contexts of different libraries on
/// one thread only. Fails with the found version when the context is older than 4.5.
Result<void> load_functions(GetProcAddress get_proc_address);

} // namespace reljef::gl
