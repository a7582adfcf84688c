#include "engine/gl/limits.h"

#include <glad/gl.h>
#include <glm/gtc/type_ptr.hpp>

namespace reljef::gl {

namespace {

std::string text(GLenum name) {
    const GLubyte* found = glGetString(name);
    return found == nullptr ? std::string() : reinterpret_cast<const char*>(found);
}

} // namespace

Limits query_limits() {
    Limits limits{.renderer = text(GL_RENDERER), .version = text(GL_VERSION)};
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limits.max_texture_size);
    glGetIntegerv(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS, &limits.max_texture_units);
    glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &limits.max_fragment_texture_units);
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, glm::value_ptr(limits.max_viewport));
    return limits;
}

bool ran_out_of_memory() {
    // A lost context reports errors without end.
    constexpr int max_flags = 16;
    bool out_of_memory = false;
    GLenum error = glGetError();
    for (int taken = 0; taken < max_flags && error != GL_NO_ERROR; ++taken) {
        out_of_memory = out_of_memory || error == GL_OUT_OF_MEMORY;
        error = glGetError();
    }
    return out_of_memory;
}

bool is_context_lost() {
    return glGetGraphicsResetStatus() != GL_NO_ERROR;
}

} // namespace reljef::gl
