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
#include "engine/render/residency/tile_mesh.h"
#include "engine/terrain/mesh/bisection.h"
#include "engine/view/draw_list.h"
#include "engine/view/triangles/tile_cut.h"
#include "engine/view/triangles/tile_seam.h"

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
    // A loaded tile and its bisection, which needs it.
    struct TileBisection {
        explicit TileBisection(std::shared_ptr<const scene::TerrainTile> of);

        std::shared_ptr<const scene::TerrainTile> tile;
        terrain::Bisection bisection;
    };
    // What a seam depends on, beside the tile.
    struct Seam {
        view::OpenSide open;
        std::uint64_t neighbour_shape = 0;
        view::BorderError error; // without a neighbour

        friend bool operator==(const Seam&, const Seam&) = default;
    };
    struct Entry {
        std::weak_ptr<const scene::TerrainTile> owner;
        std::uint64_t drawn = 0;      // last frame
        std::vector<TileMesh> meshes; // of the tile, then of its seams
        std::size_t seam_count = 0;
        std::uint64_t slivers_version = 0; // of the coarseness; 0: no slivers are known
        // Of tiles of streams:
        std::uint64_t shape = 0; // changes with the triangles; no two tiles have the same
        view::TileBorder border;
        std::uint64_t seamed_shape = 0;
        std::vector<Seam> seams;
        std::vector<view::SeamPart> seam_parts;
        // Of tiles that are cut.
        std::uint64_t version = 0; // of the coarseness
        double error = 0.0;        // of the tile, pixels
        double triangle_error = 0.0;
        view::Coarsening coarsening;
        double kept_error = 0.0; // of all that is drawn, pixels
        std::size_t triangles = 0;
        view::CutMesh last;
        std::unique_ptr<const TileBisection> bisection; // of a loaded tile

        /// Whether anything else holds the tile; otherwise it was evicted.
        [[nodiscard]] bool is_held_elsewhere() const;
        const terrain::Bisection&
        own_bisection(const std::shared_ptr<const scene::TerrainTile>& tile);
    };
    struct PictureView {
        scene::Camera camera;
        glm::ivec2 size{0};
        friend bool operator==(const PictureView&, const PictureView&) = default;
    };
    // Tiles of one terrain that are drawn alike.
    struct Group {
        std::weak_ptr<const void> owner;
        std::uint64_t kept_frames = 0;
        std::map<terrain::TreeTile, Entry> tiles;
        view::Coarseness coarseness;
        std::uint64_t version = 0; // of the coarseness, from 1
        std::optional<PictureView> slivers_of;
        std::vector<std::tuple<terrain::TreeTile, double, double>> errors;
        std::size_t max_triangles = 0;
        view::Coarsening coarsening;
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
    };
    // Tiles and their new triangles.
    struct Cuts {
        std::vector<Outdated> tiles;
        std::vector<view::CutMesh> meshes;
        std::vector<view::TileBorder> borders;
    };
    // A tile that needs new seams.
    struct Unseamed {
        const view::TileDraw* draw = nullptr;
        Entry* entry = nullptr;
        std::vector<Seam> seams;
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

    Result<void> upload_whole(Group& group, const Draws& draws, view::FrameStats& stats);
    Result<void> upload(std::span<const Outdated> tiles, view::FrameStats& stats);
    Result<void> cut(const view::DrawList& list, Group& group, const Draws& draws,
                     view::FrameStats& stats);
    static void note_errors(const view::Coarseness& coarseness, const Draws& draws, Group& group);
    static std::vector<Outdated> outdated_cuts(Group& group, const Draws& draws,
                                               terrain::TriangleBudget& budget);
    Cuts cut_within_budget(Group& group, const Draws& draws);
    std::optional<Cuts> try_to_cut(Group& group, const Draws& draws);
    Result<void> keep(Cuts cuts, const Group& group, view::FrameStats& stats);
    void replace_meshes(Entry& entry, std::vector<TileMesh> meshes);
    static std::vector<Unseamed> unseamed(const view::DrawList& list, Group& group,
                                          const Draws& draws);
    static Result<void> close_seams(const view::DrawList& list, Group& group, const Draws& draws,
                                    view::FrameStats& stats);
    /// In the order of the entry's meshes. Precondition: the tile is cut.
    static std::vector<view::SliverView::Triangles> triangles_of(const Entry& entry);
    static void forget_slivers_of_others(Group& group, const PictureView& picture);
    Result<void> part_slivers(const view::DrawList& list, Group& group, const Draws& draws,
                              view::FrameStats& stats);
    static void add_kept_errors(const Group& group, const Draws& draws, view::FrameStats& stats);
    static view::CutOptions cut_options(const Group& group, const Outdated& tile,
                                        const terrain::Bisection* shared);
    const terrain::Bisection* shared_bisection(const view::TileDraw& draw);
    const terrain::Bisection& bisection_of(const scene::TerrainNode& terrain);

    std::uint64_t frame_ = 0;
    std::uint64_t shapes_ = 0;
    std::map<Key, Group> groups_;
    std::map<const scene::TerrainSurface*, SharedBisection> bisections_;
    GridUploader grids_;
    std::vector<const Entry*> drawn_; // as in the prepared list
};

} // namespace reljef::render
