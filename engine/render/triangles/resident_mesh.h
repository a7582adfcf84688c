#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/result.h"
#include "engine/gl/buffer.h"
#include "engine/gl/vertex_array.h"
#include "engine/view/frame_stats.h"
#include "engine/view/grid_mesh.h"

namespace reljef::render {

struct ResidentMesh {
    gl::Buffer vertices;
    gl::VertexArray vertex_array;
    int index_count = 0;
    gl::Buffer indices; ///< empty if shared
};

void count_upload(view::FrameStats& stats, std::size_t bytes);

template <class T> std::span<const std::byte> bytes_of(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

// All of these count the upload and fail when GL has no memory.

Result<gl::Buffer> upload_buffer(std::span<const std::byte> content, view::FrameStats& stats);

/// A mesh without indices. `stride`: bytes per vertex.
Result<ResidentMesh> upload_vertices(std::span<const std::byte> vertices, std::size_t stride,
                                     std::span<const gl::VertexAttribute> attributes,
                                     view::FrameStats& stats);
Result<ResidentMesh> upload_vertices(const std::vector<view::GridVertex>& vertices,
                                     view::FrameStats& stats);

/// Adds the mesh's own indices. Passes on an error of `mesh`.
template <class Index>
Result<ResidentMesh> with_indices(Result<ResidentMesh> mesh, const std::vector<Index>& indices,
                                  view::FrameStats& stats) {
    if (!mesh) {
        return mesh;
    }
    auto buffer = upload_buffer(bytes_of(indices), stats);
    if (!buffer) {
        return buffer.error();
    }
    mesh->index_count = static_cast<int>(indices.size());
    mesh->indices = std::move(*buffer);
    mesh->vertex_array.set_indices(mesh->indices);
    return mesh;
}

/// Uploads full grids; those of one size share their indices.
class GridUploader {
public:
    Result<ResidentMesh> upload(const view::GridMesh& grid, view::FrameStats& stats);

private:
    std::map<std::pair<int, int>, gl::Buffer> indices_; // by quads along a row and a column
};

} // namespace reljef::render
