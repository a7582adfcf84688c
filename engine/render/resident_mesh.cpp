#include "engine/render/resident_mesh.h"

#include <array>
#include <utility>

#include "engine/render/grid_mesh.h"

namespace reljef::render {

ResidentMesh resident_grid(gl::Buffer vertices, int index_count) {
    ResidentMesh mesh{std::move(vertices), gl::VertexArray::create(), index_count, {}};
    const std::array attributes{
        gl::VertexAttribute{.location = 0, .components = 3},
        gl::VertexAttribute{.location = 1, .components = 2, .offset = offsetof(GridVertex, place)},
        gl::VertexAttribute{.location = 2, .components = 1, .offset = offsetof(GridVertex, height)},
        gl::VertexAttribute{.location = 3, .components = 3, .offset = offsetof(GridVertex, rest)}};
    mesh.vertex_array.set_vertices(0, mesh.vertices, {.stride = sizeof(GridVertex)}, attributes);
    return mesh;
}

void count_upload(FrameStats& stats, std::size_t bytes) {
    ++stats.uploads;
    stats.upload_bytes += bytes;
}

} // namespace reljef::render
