#include "engine/gl/draw.h"

#include <glad/gl.h>

#include "engine/core/check.h"

namespace reljef::gl {

namespace {

GLenum mode(Primitive primitive) {
    switch (primitive) {
    case Primitive::triangles:
        return GL_TRIANGLES;
    case Primitive::triangle_strip:
        return GL_TRIANGLE_STRIP;
    case Primitive::lines:
        return GL_LINES;
    case Primitive::line_strip:
        return GL_LINE_STRIP;
    case Primitive::points:
        return GL_POINTS;
    }
    abort_with("unknown primitive");
}

} // namespace

std::size_t size_of(IndexType type) {
    return type == IndexType::uint16 ? 2 : 4;
}

void draw_elements(const DrawElements& draw) {
    // GL takes the byte offset into the element buffer as a pointer.
    // NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto* offset = reinterpret_cast<const void*>(draw.first_index * size_of(draw.type));
    const GLenum type = draw.type == IndexType::uint16 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
    glDrawElementsInstancedBaseVertex(mode(draw.primitive), draw.count, type, offset,
                                      draw.instances, draw.base_vertex);
}

void draw_arrays(Primitive primitive, int first, int count, int instances) {
    glDrawArraysInstanced(mode(primitive), first, count, instances);
}

} // namespace reljef::gl
