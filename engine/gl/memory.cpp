#include "engine/gl/memory.h"

#include <glad/gl.h>

namespace reljef::gl {

bool ran_out_of_memory() {
    // A lost context reports errors without end, so the flags are taken a bounded number of times.
    constexpr int max_flags = 16;
    bool out_of_memory = false;
    for (int taken = 0; taken < max_flags; ++taken) {
        const GLenum error = glGetError();
        if (error == GL_NO_ERROR) {
            break;
        }
        out_of_memory = out_of_memory || error == GL_OUT_OF_MEMORY;
    }
    return out_of_memory;
}

} // namespace reljef::gl
