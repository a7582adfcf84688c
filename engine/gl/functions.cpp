#include "engine/gl/functions.h"

#include <utility>

#include <fmt/format.h>
#include <glad/gl.h>

namespace reljef::gl {

Result<void> load_functions(GetProcAddress get_proc_address) {
    const int version = gladLoadGL(get_proc_address);
    if (version == 0) {
        return Error{"no OpenGL functions found, expected OpenGL 4.5 core"};
    }
    const int major = GLAD_VERSION_MAJOR(version);
    const int minor = GLAD_VERSION_MINOR(version);
    if (std::pair(major, minor) < std::pair(4, 5)) {
        return Error{fmt::format("found OpenGL {}.{} ({}), expected 4.5 core or newer", major,
                                 minor, reinterpret_cast<const char*>(glGetString(GL_VERSION)))};
    }
    return {};
}

} // namespace reljef::gl
