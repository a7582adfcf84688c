#pragma once

#include <cstddef>
#include <span>

#include "engine/gl/buffer.h"
#include "engine/gl/unique_id.h"

namespace reljef::gl {

/// Of one component. The normalized ones arrive in the shader as float in [0,1] or [-1,1], the
/// plain integers as float of the same value.
enum class ComponentType {
    float32,
    float16,
    uint8,
    uint8_normalized,
    int16,
    int16_normalized,
    uint16,
    uint16_normalized
};

struct VertexAttribute {
    unsigned int location = 0; ///< GLSL `layout(location = …)`
    int components = 1;        ///< 1..4
    ComponentType type = ComponentType::float32;
    std::size_t offset = 0; ///< bytes from the start of the vertex
};

/// How one buffer holds the vertices, or the instances, of a draw.
struct VertexLayout {
    std::size_t stride = 0;   ///< bytes from one vertex to the next
    std::size_t offset = 0;   ///< bytes before the first
    unsigned int divisor = 0; ///< 0: one element a vertex; n: one every n instances
};

/// Where a draw reads its vertices and indices. Holds no buffer alive: the buffers must outlive the
/// draws. Default-constructed and moved-from ones hold nothing (id 0).
class VertexArray {
public:
    VertexArray() = default;
    static VertexArray create();

    /// Takes the attributes from `vertices`. Each call with another buffer uses another `binding`
    /// (0..15).
    void set_vertices(unsigned int binding, const Buffer& vertices, const VertexLayout& layout,
                      std::span<const VertexAttribute> attributes);
    void set_indices(const Buffer& indices);
    void bind() const;

    [[nodiscard]] unsigned int id() const { return id_.get(); }

private:
    UniqueId<delete_vertex_array> id_;
};

} // namespace reljef::gl
