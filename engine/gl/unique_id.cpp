#include "engine/gl/unique_id.h"

#include <glad/gl.h>

namespace reljef::gl {

void delete_buffer(unsigned int id) {
    glDeleteBuffers(1, &id);
}

void delete_texture(unsigned int id) {
    glDeleteTextures(1, &id);
}

void delete_renderbuffer(unsigned int id) {
    glDeleteRenderbuffers(1, &id);
}

void delete_vertex_array(unsigned int id) {
    glDeleteVertexArrays(1, &id);
}

void delete_framebuffer(unsigned int id) {
    glDeleteFramebuffers(1, &id);
}

void delete_shader(unsigned int id) {
    glDeleteShader(id);
}

void delete_program(unsigned int id) {
    glDeleteProgram(id);
}

void delete_query(unsigned int id) {
    glDeleteQueries(1, &id);
}

} // namespace reljef::gl
