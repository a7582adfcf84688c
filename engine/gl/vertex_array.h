#pragma once

#include <cstddef>
#include <span>

#include "engine/gl/buffer.h"
#include "engine/gl/unique_id.h"

namespace reljef::gl {

/// A float attribute.
struct VertexAttribute {
    unsigned int location = 0;
    int components = 1;     ///< 1..4
    std::size_t offset = 0; ///< bytes from the start of the vertex
};

struct VertexLayout {
    std::size_t stride = 0;   ///< bytes from one vertex to the next
    unsigned int divisor = 0; ///< 0: one element per vertex; n: one every n instances
};

/// Where a draw reads its vertices and indices. The buffers must outlive the draws.
class VertexArray {
public:
    VertexArray() = default;
    static VertexArray create();

    void set_vertices(const Buffer& vertices, const VertexLayout& layout,
                      std::span<const VertexAttribute> attributes);
    void set_indices(const Buffer& indices);
    void bind() const;

    [[nodiscard]] unsigned int id() const { return id_.get(); }

private:
    UniqueId<delete_vertex_array> id_;
};

} // namespace reljef::gl
