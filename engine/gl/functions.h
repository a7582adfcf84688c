#pragma once

#include "engine/core/result.h"

namespace reljef::gl {

/// What a context library offers to look up one GL function.
using GlFunction = void (*)();
using GetProcAddress = GlFunction (*)(const char* name);

/// Loads the OpenGL 4.5 core functions of the context that is current on this thread. There is one
/// table in the process (glad's): load again whenever another context becomes current, and draw
/// with contexts of different libraries from one thread only. Fails when the context is older than
/// 4.5; the sentence names its version.
Result<void> load_functions(GetProcAddress get_proc_address);

} // namespace reljef::gl
