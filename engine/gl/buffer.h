#pragma once

#include <cstddef>
#include <span>

#include "engine/core/result.h"
#include "engine/gl/unique_id.h"

namespace reljef::gl {

/// A buffer object: vertices, indices, a uniform block or a storage block. Default-constructed and
/// moved-from ones hold nothing (id 0, size 0).
class Buffer {
public:
    Buffer() = default;

    /// Immutable content. Fails when the driver has no memory. Precondition: not empty.
    static Result<Buffer> create(std::span<const std::byte> content);
    /// `size` bytes of undefined content for write(). Precondition: size > 0.
    static Result<Buffer> create_writable(std::size_t size);

    /// Replaces the bytes from `offset` on. Precondition: made by create_writable(); the bytes fit.
    void write(std::size_t offset, std::span<const std::byte> bytes);

    void bind_uniform_block(unsigned int binding) const;
    void bind_storage_block(unsigned int binding) const;

    [[nodiscard]] unsigned int id() const { return id_.get(); }
    [[nodiscard]] std::size_t size() const { return id() == 0U ? 0 : size_; }

private:
    static Result<Buffer> make(std::size_t size, const std::byte* content, bool writable);

    UniqueId<delete_buffer> id_;
    std::size_t size_ = 0;
    bool writable_ = false;
};

} // namespace reljef::gl
