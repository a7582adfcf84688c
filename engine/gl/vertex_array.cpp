#include "engine/gl/vertex_array.h"

#include <glad/gl.h>

#include "engine/core/check.h"

namespace reljef::gl {

namespace {

struct Component {
    GLenum type;
    GLboolean normalized;
};

Component component(ComponentType type) {
    switch (type) {
    case ComponentType::float32:
        return {GL_FLOAT, GL_FALSE};
    case ComponentType::float16:
        return {GL_HALF_FLOAT, GL_FALSE};
    case ComponentType::uint8:
        return {GL_UNSIGNED_BYTE, GL_FALSE};
    case ComponentType::uint8_normalized:
        return {GL_UNSIGNED_BYTE, GL_TRUE};
    case ComponentType::int16:
        return {GL_SHORT, GL_FALSE};
    case ComponentType::int16_normalized:
        return {GL_SHORT, GL_TRUE};
    case ComponentType::uint16:
        return {GL_UNSIGNED_SHORT, GL_FALSE};
    case ComponentType::uint16_normalized:
        return {GL_UNSIGNED_SHORT, GL_TRUE};
    }
    abort_with("unknown vertex component type");
}

} // namespace

VertexArray VertexArray::create() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    VertexArray array;
    array.id_ = UniqueId<delete_vertex_array>(name);
    return array;
}

void VertexArray::set_vertices(unsigned int binding, const Buffer& vertices,
                               const VertexLayout& layout,
                               std::span<const VertexAttribute> attributes) {
    glVertexArrayVertexBuffer(id(), binding, vertices.id(), static_cast<GLintptr>(layout.offset),
                              static_cast<GLsizei>(layout.stride));
    glVertexArrayBindingDivisor(id(), binding, layout.divisor);
    for (const VertexAttribute& attribute : attributes) {
        check(attribute.components >= 1 && attribute.components <= 4,
              "vertex attribute of other than 1 to 4 components");
        const Component each = component(attribute.type);
        glEnableVertexArrayAttrib(id(), attribute.location);
        glVertexArrayAttribFormat(id(), attribute.location, attribute.components, each.type,
                                  each.normalized, static_cast<GLuint>(attribute.offset));
        glVertexArrayAttribBinding(id(), attribute.location, binding);
    }
}

void VertexArray::set_indices(const Buffer& indices) {
    glVertexArrayElementBuffer(id(), indices.id());
}

void VertexArray::bind() const {
    glBindVertexArray(id());
}

} // namespace reljef::gl
