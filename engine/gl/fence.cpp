#include "engine/gl/fence.h"

#include <glad/gl.h>

namespace reljef::gl {

Fence Fence::after_commands() {
    Fence fence;
    fence.sync_.reset(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
    glFlush();
    return fence;
}

void Fence::wait() const {
    constexpr GLuint64 a_second = 1'000'000'000; // nanoseconds
    while (sync_ != nullptr &&
           glClientWaitSync(static_cast<GLsync>(sync_.get()), 0, a_second) == GL_TIMEOUT_EXPIRED) {
    }
}

void Fence::Deleter::operator()(void* sync) const {
    glDeleteSync(static_cast<GLsync>(sync));
}

} // namespace reljef::gl
