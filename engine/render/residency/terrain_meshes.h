#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "engine/core/result.h"
#include "engine/render/residency/resident_mesh.h"
#include "engine/terrain/mesh/bisection.h"
#include "engine/view/draw_list.h"
#include "engine/view/tile_cut.h"

namespace reljef::render {

/// The triangles of terrain tiles in GPU memory. Each tile stands alone: uploaded on first use, and
/// again when it gets other triangles. Tiles that are not drawn for some frames are dropped, except
/// whole tiles of a terrain in memory.
class TerrainMeshes {
public:
    Result<void> prepare(const view::DrawList& list, view::FrameStats& stats);

    /// The parts of the tile with this index in the prepared list.
    [[nodiscard]] std::span<const ResidentMesh> tile(std::size_t index) const {
        return drawn_.at(index)->meshes;
    }

private:
    // A loaded tile and its bisection, which needs it.
    struct TileBisection {
        explicit TileBisection(std::shared_ptr<const scene::TerrainTile> of);

        std::shared_ptr<const scene::TerrainTile> tile;
        terrain::Bisection bisection;
    };
    struct Entry {
        std::weak_ptr<const scene::TerrainTile> owner;
        std::uint64_t drawn = 0; // last frame
        std::vector<ResidentMesh> meshes;
        terrain::Skirt skirt;
        // Of tiles that are cut.
        std::uint64_t version = 0; // of the coarseness
        double error = 0.0;        // of the tile, pixels
        double triangle_error = 0.0;
        double kept_error = 0.0; // of all that is drawn, pixels
        view::CutMesh last;
        std::unique_ptr<const TileBisection> bisection; // of a loaded tile

        /// Whether anything else holds the tile; otherwise it was evicted.
        [[nodiscard]] bool is_held_elsewhere() const;
        const terrain::Bisection&
        own_bisection(const std::shared_ptr<const scene::TerrainTile>& tile);
    };
    // Tiles of one terrain that are drawn alike.
    struct Group {
        std::weak_ptr<const void> owner;
        std::uint64_t kept_frames = 0;
        std::map<terrain::TreeTile, Entry> tiles;
        view::Coarseness coarseness;
        std::uint64_t version = 0; // of the coarseness, from 1
    };
    struct SharedBisection {
        std::weak_ptr<const scene::TerrainSurface> owner;
        std::unique_ptr<const terrain::Bisection> bisection;
    };
    using Draws = std::vector<const view::TileDraw*>;
    // A tile to upload.
    struct Outdated {
        const view::TileDraw* draw = nullptr;
        Entry* entry = nullptr;
        terrain::Skirt skirt;
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

    Result<void> upload_whole(const view::DrawList& list, Group& group, const Draws& draws,
                              view::FrameStats& stats);
    Result<void> upload(std::span<const Outdated> tiles, view::FrameStats& stats);
    Result<void> cut(const view::DrawList& list, Group& group, const Draws& draws,
                     view::FrameStats& stats);
    static std::vector<Outdated> outdated_cuts(const view::DrawList& list, Group& group,
                                               const Draws& draws, view::FrameStats& stats);
    static void add_kept_errors(const Group& group, const Draws& draws, view::FrameStats& stats);
    const terrain::Bisection& bisection_of(const scene::TerrainNode& terrain);

    std::uint64_t frame_ = 0;
    std::map<Key, Group> groups_;
    std::map<const scene::TerrainSurface*, SharedBisection> bisections_;
    GridUploader grids_;
    std::vector<const Entry*> drawn_; // as in the prepared list
};

} // namespace reljef::render
