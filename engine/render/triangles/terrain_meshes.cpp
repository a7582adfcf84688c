#include "engine/render/triangles/terrain_meshes.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "engine/core/parallel_for.h"
#include "engine/render/triangles/cut_meshes.h"
#include "engine/render/triangles/seam_meshes.h"
#include "engine/render/triangles/sliver_meshes.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::render {
namespace {

// Frames that unused tiles stay. Most tiles of a stream are ancestors of the drawn ones.
constexpr std::uint64_t kept_frames_loaded = 8;
constexpr std::uint64_t kept_frames_cut = 32;
constexpr std::uint64_t kept_always = std::numeric_limits<std::uint64_t>::max();

// Tiles per batch; limits the memory for vertices that are not yet uploaded.
constexpr std::size_t batch_tiles = 8;

view::GridMesh whole_mesh(const view::TileDraw& draw) {
    const view::TileSurface surface = view::surface_of(draw);
    const double flat_height = terrain::reference_height(draw.terrain->surface->heightfield());
    return draw.flat ? view::flat_mesh(surface.placement, surface.samples, flat_height)
                     : view::full_mesh(surface.heightfield, surface.placement, surface.samples);
}

} // namespace

TerrainMeshes::Key TerrainMeshes::key_of(const view::TileDraw& draw) {
    if (!draw.tile->borrows) {
        return {draw.terrain->stream.get(), draw.flat, draw.coarse, draw.terrain, std::nullopt};
    }
    const void* const source = draw.terrain->surface.get();
    return draw.coarse ? Key{source, draw.flat, true, draw.terrain,
                             draw.terrain->material.technique.parameters}
                       : Key{source, draw.flat, false, nullptr, std::nullopt};
}

MeshGroup& TerrainMeshes::group_of(const view::TileDraw& draw) {
    const scene::TerrainNode& terrain = *draw.terrain;
    const bool borrows = draw.tile->borrows;
    const std::shared_ptr<const void> owner = borrows ? std::shared_ptr<const void>(terrain.surface)
                                                      : std::shared_ptr<const void>(terrain.stream);
    MeshGroup& group = groups_[key_of(draw)];
    if (group.owner.lock() != owner) {
        group = {};
        group.owner = owner;
        group.kept_frames = !borrows      ? kept_frames_loaded
                            : draw.coarse ? kept_frames_cut
                                          : kept_always;
    }
    return group;
}

ResidentTriangles& TerrainMeshes::entry_of(MeshGroup& group, const view::TileDraw& draw) const {
    ResidentTriangles& tile = group.tiles[draw.tile->id];
    if (tile.owner.lock() != draw.tile) {
        tile = {};
        tile.owner = draw.tile;
    }
    tile.drawn = frame_;
    return tile;
}

// As they appear in the list.
std::vector<DrawnGroup> TerrainMeshes::drawn_groups(const view::DrawList& list) {
    std::vector<DrawnGroup> groups;
    drawn_.clear();
    drawn_.reserve(list.tiles.size());
    for (const view::TileDraw& draw : list.tiles) {
        MeshGroup& group = group_of(draw);
        drawn_.push_back(&entry_of(group, draw));
        auto found = std::find_if(groups.begin(), groups.end(),
                                  [&](const DrawnGroup& drawn) { return &drawn.group == &group; });
        if (found == groups.end()) {
            groups.push_back({group, list, {}});
            found = groups.end() - 1;
        }
        found->draws.push_back(&draw);
    }
    return groups;
}

void TerrainMeshes::forget_unused() {
    bisections_.forget_unused();
    for (auto& [key, group] : groups_) {
        std::erase_if(group.tiles, [&, kept = group.kept_frames](const auto& entry) {
            return !entry.second.is_held_elsewhere() || frame_ - entry.second.drawn > kept;
        });
    }
    std::erase_if(groups_, [](const auto& entry) {
        return entry.second.owner.expired() || entry.second.tiles.empty();
    });
}

void TerrainMeshes::forget_cuts() {
    for (auto& [key, group] : groups_) {
        for (auto& [id, tile] : group.tiles) {
            tile.version = 0;
        }
    }
}

Result<void> TerrainMeshes::prepare(const view::DrawList& list, view::FrameStats& stats) {
    ++frame_;
    const std::vector<DrawnGroup> groups = drawn_groups(list);
    forget_unused();
    for (const DrawnGroup& drawn : groups) {
        if (auto done = prepare(drawn, stats); !done) {
            return done;
        }
    }
    return {};
}

Result<void> TerrainMeshes::prepare(const DrawnGroup& drawn, view::FrameStats& stats) {
    const bool is_cut = drawn.draws.front()->coarse;
    auto done = is_cut ? cut_meshes(drawn, bisections_, stats) : upload_whole(drawn, stats);
    if (done && has_seams(*drawn.draws.front())) {
        done = seam_meshes(drawn, stats);
    }
    if (done && is_cut && std::holds_alternative<terrain::ErrorView>(drawn.group.coarseness)) {
        done = sliver_meshes(drawn, bisections_, stats);
    }
    return done;
}

Result<void> TerrainMeshes::upload_whole(const DrawnGroup& drawn, view::FrameStats& stats) {
    std::vector<OutdatedTile> outdated;
    for (const view::TileDraw* const draw : drawn.draws) {
        ResidentTriangles& tile = drawn.triangles_of(*draw);
        if (!tile.meshes.empty()) {
            ++stats.skipped.uploads_unchanged;
        } else {
            outdated.push_back({draw, &tile});
        }
    }
    for (std::size_t i = 0; i < outdated.size(); i += batch_tiles) {
        const auto left = std::span<const OutdatedTile>(outdated).subspan(i);
        const auto batch = left.first(std::min(left.size(), batch_tiles));
        if (auto done = upload(drawn.group, batch, stats); !done) {
            return done;
        }
    }
    return {};
}

Result<void> TerrainMeshes::upload(MeshGroup& group, std::span<const OutdatedTile> tiles,
                                   view::FrameStats& stats) {
    std::vector<view::GridMesh> grids(tiles.size());
    parallel_for(static_cast<int>(tiles.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const auto& [draw, tile] = tiles[at];
        grids[at] = whole_mesh(*draw);
        if (has_seams(*draw)) {
            tile->border = view::border_of_samples(view::surface_of(*draw));
        }
    });
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        auto mesh = grids_.upload(grids[i], stats);
        if (!mesh) {
            return mesh.error();
        }
        std::vector<TileMesh> meshes;
        meshes.push_back({std::move(*mesh), {}, {}, {}});
        group.replace_meshes(*tiles[i].triangles, std::move(meshes));
    }
    return {};
}

} // namespace reljef::render
