#include "engine/gl/draw.h"

#include <glad/gl.h>

namespace reljef::gl {

void draw_elements(IndexType type, int count) {
    glDrawElements(GL_TRIANGLES, count,
                   type == IndexType::uint16 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT, nullptr);
}

void draw_arrays(Primitive primitive, int count, int instances) {
    glDrawArraysInstanced(primitive == Primitive::triangles ? GL_TRIANGLES : GL_TRIANGLE_STRIP, 0,
                          count, instances);
}

void wait_until_drawn() {
    glFinish();
}

} // namespace reljef::gl
