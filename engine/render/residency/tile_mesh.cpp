#include "engine/render/residency/tile_mesh.h"

#include <utility>

#include "engine/view/triangles/slivers.h"

namespace reljef::render {

Result<TileMesh> tile_mesh(const std::vector<view::GridVertex>& vertices,
                           const std::vector<std::uint16_t>& indices, view::FrameStats& stats) {
    auto mesh = with_indices(upload_vertices(vertices, stats), indices, stats);
    if (!mesh) {
        return mesh.error();
    }
    return TileMesh{std::move(*mesh), {}, {}};
}

Result<std::vector<TileMesh>> tile_meshes(const view::CutMesh& cut, view::FrameStats& stats) {
    std::vector<TileMesh> meshes;
    for (std::size_t i = 0; i < cut.parts.size(); ++i) {
        auto mesh = tile_mesh(cut.vertices[i], cut.parts[i].indices, stats);
        if (!mesh) {
            return mesh.error();
        }
        meshes.push_back(std::move(*mesh));
    }
    return meshes;
}

Result<void> set_slivers(TileMesh& mesh, std::span<const std::uint16_t> indices,
                         std::vector<std::uint32_t> slivers, view::FrameStats& stats) {
    if (mesh.slivers == slivers) {
        return {};
    }
    gl::Buffer corners;
    if (!slivers.empty()) {
        auto uploaded = upload_buffer(bytes_of(view::corners_of(indices, slivers)), stats);
        if (!uploaded) {
            return uploaded.error();
        }
        corners = std::move(*uploaded);
    }
    const std::vector<std::uint16_t> others = view::without(indices, slivers);
    if (!others.empty()) {
        auto uploaded = upload_buffer(bytes_of(others), stats);
        if (!uploaded) {
            return uploaded.error();
        }
        mesh.mesh.indices = std::move(*uploaded);
        mesh.mesh.vertex_array.set_indices(mesh.mesh.indices);
    }
    mesh.mesh.index_count = static_cast<int>(others.size());
    mesh.sliver_corners = std::move(corners);
    mesh.slivers = std::move(slivers);
    return {};
}

} // namespace reljef::render
