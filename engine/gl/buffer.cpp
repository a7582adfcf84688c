#include "engine/gl/buffer.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include "engine/gl/memory.h"

namespace reljef::gl {

namespace {

Result<UniqueId<delete_buffer>> make_storage(std::size_t size, const std::byte* content,
                                             GLbitfield flags) {
    check(size > 0, "empty buffer");
    GLuint name = 0;
    glCreateBuffers(1, &name);
    UniqueId<delete_buffer> id(name);
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(size), content, flags);
    if (ran_out_of_memory()) {
        return Error{fmt::format("GL buffer of {} bytes: the driver has no memory for it", size)};
    }
    return id;
}

} // namespace

Result<Buffer> Buffer::create(std::span<const std::byte> content) {
    auto id = make_storage(content.size(), content.data(), 0);
    if (!id) {
        return id.error();
    }
    Buffer buffer;
    buffer.id_ = std::move(*id);
    buffer.size_ = content.size();
    return buffer;
}

Result<Buffer> Buffer::create_writable(std::size_t size) {
    auto id = make_storage(size, nullptr, GL_DYNAMIC_STORAGE_BIT);
    if (!id) {
        return id.error();
    }
    Buffer buffer;
    buffer.id_ = std::move(*id);
    buffer.size_ = size;
    buffer.writable_ = true;
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
