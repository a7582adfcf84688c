#pragma once

#include <cstddef>

namespace reljef::gl {

enum class Primitive { triangles, triangle_strip, lines, line_strip, points };
enum class IndexType { uint16, uint32 };

/// Bytes of one index.
std::size_t size_of(IndexType type);

/// A draw through the element buffer of the vertex array in use.
struct DrawElements {
    Primitive primitive = Primitive::triangles;
    IndexType type = IndexType::uint32;
    int count = 0;               ///< indices
    std::size_t first_index = 0; ///< of the element buffer, counted in indices
    int base_vertex = 0;         ///< added to each index
    int instances = 1;
};

/// Draws with the program, vertex array and target in use.
void draw_elements(const DrawElements& draw);

/// Draws vertices first .. first + count - 1 with the program, vertex array and target in use. A
/// vertex array must be bound even if the shader reads no attribute.
void draw_arrays(Primitive primitive, int first, int count, int instances = 1);

} // namespace reljef::gl
