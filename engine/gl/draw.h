#pragma once

namespace reljef::gl {

enum class Primitive { triangles, triangle_strip };
enum class IndexType { uint16, uint32 };

/// Draws `count` indices of the bound vertex array as triangles.
void draw_elements(IndexType type, int count);

/// Draws vertices 0 .. count - 1. A vertex array must be bound even if the shader reads no
/// attribute.
void draw_arrays(Primitive primitive, int count, int instances = 1);

/// Waits for all draws before.
void wait_until_drawn();

} // namespace reljef::gl
