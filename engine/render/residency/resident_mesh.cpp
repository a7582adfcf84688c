#include "engine/render/residency/resident_mesh.h"

#include <array>
#include <utility>

#include "engine/view/grid_mesh.h"

namespace reljef::render {

ResidentMesh resident_grid(gl::Buffer vertices, int index_count) {
    ResidentMesh mesh{std::move(vertices), gl::VertexArray::create(), index_count, {}};
    const std::array attributes{
        gl::VertexAttribute{.location = 0, .components = 3},
        gl::VertexAttribute{
            .location = 1, .components = 2, .offset = offsetof(view::GridVertex, place)},
        gl::VertexAttribute{
            .location = 2, .components = 1, .offset = offsetof(view::GridVertex, height)},
        gl::VertexAttribute{
            .location = 3, .components = 3, .offset = offsetof(view::GridVertex, rest)}};
    mesh.vertex_array.set_vertices(mesh.vertices, {.stride = sizeof(view::GridVertex)}, attributes);
    return mesh;
}

void count_upload(view::FrameStats& stats, std::size_t bytes) {
    ++stats.uploads;
    stats.upload_bytes += bytes;
}

} // namespace reljef::render
