#include "engine/gl/vertex_array.h"

#include <glad/gl.h>

namespace reljef::gl {

VertexArray VertexArray::create() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    VertexArray array;
    array.id_ = UniqueId<delete_vertex_array>(name);
    return array;
}

void VertexArray::set_vertices(const Buffer& vertices, const VertexLayout& layout,
                               std::span<const VertexAttribute> attributes) {
    glVertexArrayVertexBuffer(id(), 0, vertices.id(), 0, static_cast<GLsizei>(layout.stride));
    glVertexArrayBindingDivisor(id(), 0, layout.divisor);
    for (const VertexAttribute& attribute : attributes) {
        glEnableVertexArrayAttrib(id(), attribute.location);
        glVertexArrayAttribFormat(id(), attribute.location, attribute.components, GL_FLOAT,
                                  GL_FALSE, static_cast<GLuint>(attribute.offset));
        glVertexArrayAttribBinding(id(), attribute.location, 0);
    }
}

void VertexArray::set_indices(const Buffer& indices) {
    glVertexArrayElementBuffer(id(), indices.id());
}

void VertexArray::bind() const {
    glBindVertexArray(id());
}

} // namespace reljef::gl
