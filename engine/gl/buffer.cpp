#include "engine/gl/buffer.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include "engine/gl/limits.h"

namespace reljef::gl {

Result<Buffer> Buffer::create(std::span<const std::byte> content) {
    return make(content.size(), content.data(), false);
}

Result<Buffer> Buffer::create_writable(std::size_t size) {
    return make(size, nullptr, true);
}

Result<Buffer> Buffer::make(std::size_t size, const std::byte* content, bool writable) {
    check(size > 0, "empty buffer");
    GLuint name = 0;
    glCreateBuffers(1, &name);
    Buffer buffer;
    buffer.id_ = UniqueId<delete_buffer>(name);
    buffer.size_ = size;
    buffer.writable_ = writable;
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(size), content,
                         writable ? GL_DYNAMIC_STORAGE_BIT : 0U);
    if (ran_out_of_memory()) {
        return Error{fmt::format("GL buffer of {} bytes: the driver has no memory for it", size)};
    }
    return buffer;
}

void Buffer::write(std::size_t offset, std::span<const std::byte> bytes) {
    check(writable_ && offset <= size() && bytes.size() <= size() - offset,
          "write outside a buffer or to an immutable one");
    glNamedBufferSubData(id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes.size()),
                         bytes.data());
}

void Buffer::bind_uniform_block(unsigned int binding) const {
    glBindBufferBase(GL_UNIFORM_BUFFER, binding, id());
}

void Buffer::bind_storage_block(unsigned int binding) const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id());
}

} // namespace reljef::gl
