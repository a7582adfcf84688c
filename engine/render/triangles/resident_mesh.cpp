#include "engine/render/triangles/resident_mesh.h"

#include <array>
#include <cstdint>

#include "engine/terrain/mesh/grid_triangles.h"

namespace reljef::render {

void count_upload(view::FrameStats& stats, std::size_t bytes) {
    ++stats.uploads;
    stats.upload_bytes += bytes;
}

Result<gl::Buffer> upload_buffer(std::span<const std::byte> content, view::FrameStats& stats) {
    auto buffer = gl::Buffer::create(content);
    if (buffer) {
        count_upload(stats, content.size());
    }
    return buffer;
}

Result<ResidentMesh> upload_vertices(std::span<const std::byte> vertices, std::size_t stride,
                                     std::span<const gl::VertexAttribute> attributes,
                                     view::FrameStats& stats) {
    auto buffer = upload_buffer(vertices, stats);
    if (!buffer) {
        return buffer.error();
    }
    ResidentMesh mesh{std::move(*buffer), gl::VertexArray::create(), 0, {}};
    mesh.vertex_array.set_vertices(mesh.vertices, {.stride = stride}, attributes);
    return mesh;
}

Result<ResidentMesh> upload_vertices(const std::vector<view::GridVertex>& vertices,
                                     view::FrameStats& stats) {
    using view::GridVertex;
    constexpr std::array attributes{
        gl::VertexAttribute{.location = 0, .components = 3},
        gl::VertexAttribute{.location = 1, .components = 2, .offset = offsetof(GridVertex, place)},
        gl::VertexAttribute{.location = 2, .components = 1, .offset = offsetof(GridVertex, height)},
        gl::VertexAttribute{.location = 3, .components = 3, .offset = offsetof(GridVertex, rest)}};
    return upload_vertices(bytes_of(vertices), sizeof(GridVertex), attributes, stats);
}

Result<ResidentMesh> GridUploader::upload(const view::GridMesh& grid, view::FrameStats& stats) {
    auto shared = indices_.find({grid.cols, grid.rows});
    if (shared == indices_.end()) {
        const auto triangles = terrain::grid_triangles<std::uint16_t>(grid.cols, grid.rows);
        auto buffer = upload_buffer(bytes_of(triangles), stats);
        if (!buffer) {
            return buffer.error();
        }
        shared = indices_.emplace(std::pair{grid.cols, grid.rows}, std::move(*buffer)).first;
    }
    auto mesh = upload_vertices(grid.vertices, stats);
    if (mesh) {
        mesh->index_count = 6 * grid.cols * grid.rows;
        mesh->vertex_array.set_indices(shared->second);
    }
    return mesh;
}

} // namespace reljef::render
