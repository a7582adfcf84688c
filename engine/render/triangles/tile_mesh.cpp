#include "engine/render/triangles/tile_mesh.h"

#include <utility>

namespace reljef::render {
namespace {

Result<ResidentMesh> upload_corners(const view::SliverView::Triangles& all,
                                    std::span<const std::uint32_t> triangles,
                                    view::FrameStats& stats) {
    return triangles.empty()
               ? ResidentMesh()
               : upload_vertices(view::corners_of(all.vertices, all.indices, triangles), stats);
}

} // namespace

Result<TileMesh> tile_mesh(const std::vector<view::GridVertex>& vertices,
                           const std::vector<std::uint16_t>& indices, view::FrameStats& stats) {
    auto mesh = with_indices(upload_vertices(vertices, stats), indices, stats);
    if (!mesh) {
        return mesh.error();
    }
    return TileMesh{std::move(*mesh), {}, {}, {}};
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

Result<void> set_slivers(TileMesh& mesh, const view::SliverView::Triangles& all,
                         view::Slivers slivers, view::FrameStats& stats) {
    if (mesh.slivers == slivers) {
        return {};
    }
    auto mild = upload_corners(all, slivers.mild, stats);
    if (!mild) {
        return mild.error();
    }
    auto narrow = upload_corners(all, slivers.narrow, stats);
    if (!narrow) {
        return narrow.error();
    }
    const std::vector<std::uint16_t> others = view::without(all.indices, slivers.all());
    if (!others.empty()) {
        auto uploaded = upload_buffer(bytes_of(others), stats);
        if (!uploaded) {
            return uploaded.error();
        }
        mesh.mesh.indices = std::move(*uploaded);
        mesh.mesh.vertex_array.set_indices(mesh.mesh.indices);
    }
    mesh.mesh.index_count = static_cast<int>(others.size());
    mesh.mild = std::move(*mild);
    mesh.narrow = std::move(*narrow);
    mesh.slivers = std::move(slivers);
    return {};
}

} // namespace reljef::render
