#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/gl/buffer.h"
#include "engine/gl/vertex_array.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// Triangles that are in the driver's memory.
struct ResidentMesh {
    gl::Buffer vertices;
    gl::VertexArray vertex_array;
    int index_count = 0;
    gl::Buffer indices; ///< its own; none where it shares those of others
};

/// A part of a terrain tile over its GridVertex vertices. The vertex array has no indices yet.
ResidentMesh resident_grid(gl::Buffer vertices, int index_count);

/// Counts a buffer or texture that was filled.
void count_upload(view::FrameStats& stats, std::size_t bytes);

template <class T> std::span<const std::byte> bytes_of(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

} // namespace reljef::render
