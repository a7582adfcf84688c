#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "engine/core/result.h"
#include "engine/render/triangles/bisections.h"
#include "engine/render/triangles/mesh_group.h"
#include "engine/render/triangles/resident_mesh.h"
#include "engine/render/triangles/tile_mesh.h"
#include "engine/view/draw_list.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// The triangles of terrain tiles in GPU memory. Each tile stands alone: uploaded on first use, and
/// again when it gets other triangles. Seams join the tiles of a stream. Tiles that are not drawn
/// for some frames are dropped, except whole tiles of a terrain in memory.
class TerrainMeshes {
public:
    Result<void> prepare(const view::DrawList& list, view::FrameStats& stats);
    /// Tiles are cut again in the next frame.
    void forget_cuts();

    /// The parts of the tile with this index in the prepared list.
    [[nodiscard]] std::span<const TileMesh> tile(std::size_t index) const {
        return drawn_.at(index)->meshes;
    }

private:
    // The source of the tiles, whether they are flat, and whether they are cut. The node is part of
    // the key of tiles that depend on its view: those of streams, which have seams, and cut ones.
    // So are the parameters of tiles in memory that are cut: a technique that is selected again is
    // ready.
    using Key = std::tuple<const void*, bool, bool, const scene::TerrainNode*,
                           std::optional<scene::TechniqueParameters>>;
    static Key key_of(const view::TileDraw& draw);
    MeshGroup& group_of(const view::TileDraw& draw);
    ResidentTriangles& entry_of(MeshGroup& group, const view::TileDraw& draw) const;
    std::vector<DrawnGroup> drawn_groups(const view::DrawList& list);
    void forget_unused();

    Result<void> prepare(const DrawnGroup& drawn, view::FrameStats& stats);
    Result<void> upload_whole(const DrawnGroup& drawn, view::FrameStats& stats);
    Result<void> upload(MeshGroup& group, std::span<const OutdatedTile> tiles,
                        view::FrameStats& stats);

    std::uint64_t frame_ = 0;
    std::map<Key, MeshGroup> groups_;
    Bisections bisections_;
    GridUploader grids_;
    std::vector<const ResidentTriangles*> drawn_; // as in the prepared list
};

} // namespace reljef::render
