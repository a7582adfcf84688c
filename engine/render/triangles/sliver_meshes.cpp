#include "engine/render/triangles/sliver_meshes.h"

#include <utility>

#include "engine/core/parallel_for.h"

namespace reljef::render {
namespace {

// In the order of the tile's meshes.
std::vector<view::SliverView::Triangles> parts_of(const ResidentTriangles& tile) {
    std::vector<view::SliverView::Triangles> parts;
    for (std::size_t i = 0; i < tile.last.parts.size(); ++i) {
        const terrain::Triangulation& part = tile.last.parts[i];
        parts.push_back({tile.last.vertices[i], part.indices, &part});
    }
    for (const view::SeamPart& part : tile.seam_parts) {
        parts.push_back({part.vertices, part.indices, nullptr});
    }
    return parts;
}

// Parts of a large picture have one version.
void forget_slivers_of_others(MeshGroup& group, const SeenPicture& picture) {
    if (group.slivers_of != picture) {
        for (auto& [id, tile] : group.tiles) {
            tile.slivers_version = 0;
        }
        group.slivers_of = picture;
    }
}

std::vector<OutdatedTile> tiles_of_unknown_slivers(const DrawnGroup& drawn) {
    std::vector<OutdatedTile> tiles;
    for (const view::TileDraw* const draw : drawn.draws) {
        ResidentTriangles& tile = drawn.triangles_of(*draw);
        if (tile.slivers_version != drawn.group.version) {
            tiles.push_back({draw, &tile});
        }
    }
    return tiles;
}

Result<void> keep(ResidentTriangles& tile, std::vector<view::Slivers> slivers,
                  view::FrameStats& stats) {
    const auto parts = parts_of(tile);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        auto done = set_slivers(tile.meshes[i], parts[i], std::move(slivers[i]), stats);
        if (!done) {
            return done;
        }
    }
    return {};
}

} // namespace

Result<void> sliver_meshes(const DrawnGroup& drawn, Bisections& bisections,
                           view::FrameStats& stats) {
    MeshGroup& group = drawn.group;
    forget_slivers_of_others(group, {drawn.list.camera, drawn.list.size});
    const std::vector<OutdatedTile> tiles = tiles_of_unknown_slivers(drawn);
    if (tiles.empty()) {
        return {};
    }
    const terrain::Bisection* const shared = bisections.of(*drawn.draws.front());
    std::vector<std::vector<view::Slivers>> slivers(tiles.size());
    parallel_for(static_cast<int>(tiles.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const auto& [draw, tile] = tiles[at];
        const view::SliverView view(drawn.list, *draw, cut_options(group, tiles[at], shared));
        for (const auto& part : parts_of(*tile)) {
            slivers[at].push_back(view.slivers(part));
        }
    });
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        ResidentTriangles& tile = *tiles[i].triangles;
        if (auto done = keep(tile, std::move(slivers[i]), stats); !done) {
            return done;
        }
        tile.slivers_version = group.version;
    }
    return {};
}

} // namespace reljef::render
