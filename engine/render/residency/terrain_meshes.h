#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "engine/core/result.h"
#include "engine/render/residency/resident_mesh.h"
#include "engine/terrain/mesh/bisection.h"
#include "engine/terrain/tree/stitching.h"
#include "engine/view/draw_list.h"
#include "engine/view/grid_mesh.h"
#include "engine/view/tile_cut.h"

namespace reljef::render {

using DrawnById = std::map<terrain::TreeTile, const view::TileDraw*>;

/// The triangles of terrain tiles in GPU memory. Uploaded on first use, and again when a tile gets
/// other triangles, or a neighbour moves its border or changes its heights. Tiles that are not
/// drawn for some frames are dropped, except whole tiles of a terrain in memory.
class TerrainMeshes {
public:
    Result<void> prepare(const view::DrawList& list, view::FrameStats& stats);

    /// The parts of the tile with this index in the prepared list.
    [[nodiscard]] std::span<const ResidentMesh> tile(std::size_t index) const {
        return drawn_.at(index)->meshes;
    }

private:
    struct Entry {
        std::weak_ptr<const scene::TerrainTile> owner;
        std::uint64_t drawn = 0;    // last frame
        std::uint64_t since = 0;    // first frame
        std::uint64_t uploaded = 0; // frame of the vertices
        std::vector<ResidentMesh> meshes;
        bool is_whole = false; // the meshes have all triangles
        // Of loaded tiles, whose borders may move.
        std::vector<terrain::EdgeMove> moves;
        std::set<terrain::TreeTile> moved_to;
        view::TileCut cut;
        std::vector<view::GridVertex> vertices; // all vertices of a tile that is cut
        // Of tiles in memory that are cut.
        std::uint64_t version = 0; // of the coarseness
        view::CutMesh last;
    };
    struct Cover {
        terrain::DrawnTiles tiles;
        bool is_new = true; // the triangles are still those of the last cover
    };
    // Tiles of one terrain that are drawn alike.
    struct Group {
        std::weak_ptr<const void> owner;
        std::uint64_t kept_frames = 0;
        std::map<terrain::TreeTile, Entry> tiles;
        std::optional<Cover> cover; // of loaded tiles
        view::Coarseness coarseness;
        std::uint64_t version = 0; // of the coarseness, from 1
    };
    struct SharedBisection {
        std::weak_ptr<const scene::TerrainSurface> owner;
        std::unique_ptr<const terrain::Bisection> bisection;
    };
    using Draws = std::vector<const view::TileDraw*>;
    struct ChangedMesh {
        const view::TileDraw* draw = nullptr;
        const std::vector<terrain::EdgeMove>* moves = nullptr;
    };

    // The source of the tiles, whether they are flat, and whether they are cut. If tiles in memory
    // are cut, the node and the parameters are part of the key, so that a technique that is
    // selected again is ready.
    using Key = std::tuple<const void*, bool, bool, const scene::TerrainNode*,
                           std::optional<scene::TechniqueParameters>>;
    static Key key_of(const view::TileDraw& draw);
    Group& group_of(const view::TileDraw& draw);
    Entry& entry_of(Group& group, const view::TileDraw& draw);
    void forget_unused();

    Result<void> prepare_group(const view::DrawList& list, Group& group, const Draws& draws,
                               view::FrameStats& stats);
    Result<void> prepare_vertices(Group& group, const DrawnById& drawn, view::FrameStats& stats);
    Result<void> upload_all(Group& group, std::span<const ChangedMesh> changed,
                            const DrawnById& drawn, view::FrameStats& stats);
    Result<void> cut_in_memory(const view::DrawList& list, Group& group, const Draws& draws,
                               view::FrameStats& stats);
    Result<void> cut_loaded(const view::DrawList& list, Group& group, const DrawnById& drawn,
                            view::FrameStats& stats);
    Result<void> set_triangles(Entry& entry, const terrain::Triangulation& triangles,
                               glm::ivec2 cells, view::FrameStats& stats);
    const terrain::Bisection& bisection_of(const scene::TerrainNode& terrain);
    [[nodiscard]] static bool is_moved_as(const Group& group, const Entry& entry,
                                          const std::vector<terrain::EdgeMove>& moves);

    std::uint64_t frame_ = 0;
    std::map<Key, Group> groups_;
    std::map<const scene::TerrainSurface*, SharedBisection> bisections_;
    GridUploader grids_;
    std::vector<const Entry*> drawn_; // as in the prepared list
};

/// The vertices of a tile after the moves of its border. `drawn` contains the moves' target tiles.
view::GridMesh tile_mesh(const view::TileDraw& draw, const std::vector<terrain::EdgeMove>& moves,
                         const DrawnById& drawn);

} // namespace reljef::render
