#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/render/residency/ground_residency.h"
#include "engine/render/residency/resident_mesh.h"
#include "engine/terrain/tree/stitching.h"
#include "engine/view/draw_list.h"
#include "engine/view/grid_mesh.h"
#include "engine/view/streamed_cut.h"

namespace reljef::render {

using StreamedByTile = std::map<terrain::TreeTile, const view::StreamedDraw*>;

struct ResidentStreamed {
    ResidentMesh mesh;
    std::optional<gl::Texture2D> lit;
    glm::vec4 lit_from_sample{0.0F}; ///< texture coordinate = samples from the first · xy + zw
    std::optional<ResidentGround> ground; ///< for visible surface detail
};

/// The tiles of streamed terrains. Uploaded on first use, and again when a neighbour moves their
/// border or changes its heights, or when the sun moves. Dropped when the stream drops them or
/// after some frames unused: most tiles of a stream are ancestors of the drawn ones.
class StreamedTiles {
public:
    Result<void> prepare(const view::DrawList& list, bool with_maps, view::FrameStats& stats);

    void add_light(const std::shared_ptr<scene::TileStream>& stream,
                   const scene::TerrainLight& light,
                   std::shared_ptr<const scene::TerrainIrradiance> irradiance);

    /// Precondition: `draw` is of the prepared list.
    [[nodiscard]] const ResidentStreamed& tile(const view::StreamedDraw& draw) const;

private:
    using Key = std::pair<const scene::TileStream*, terrain::TreeTile>;
    struct Entry {
        std::weak_ptr<const scene::StreamedTile> owner;
        std::uint64_t drawn = 0;    // last frame
        std::uint64_t since = 0;    // first frame
        std::uint64_t uploaded = 0; // frame of the vertices
        bool flat = false;
        std::vector<terrain::EdgeMove> moves;
        std::set<terrain::TreeTile> moved_to;
        std::optional<scene::TerrainLight> light;
        std::optional<ResidentStreamed> resident;
        bool is_whole = false;                  // the resident mesh has all triangles
        std::vector<view::GridVertex> vertices; // all vertices of a mesh that is not whole
        view::StreamedCut cut;
    };
    struct Cover {
        std::weak_ptr<const scene::TileStream> owner;
        terrain::DrawnTiles tiles;
        bool is_new = true; // the triangles are still those of the last cover
    };
    struct SharedLight {
        std::weak_ptr<scene::TileStream> owner;
        std::optional<scene::TerrainLight> light;
        std::shared_ptr<const scene::TerrainIrradiance> irradiance;
    };

    struct ChangedMesh {
        const view::StreamedDraw* draw = nullptr;
        const std::vector<terrain::EdgeMove>* moves = nullptr;
    };

    void forget_unused(const view::DrawList& list);
    Result<void> prepare_meshes(const terrain::DrawnTiles& cover, const StreamedByTile& drawn,
                                view::FrameStats& stats);
    Result<void> prepare_cuts(const view::DrawList& list, Cover& cover, const StreamedByTile& drawn,
                              view::FrameStats& stats);
    Cover& cover_of(const StreamedByTile& drawn);
    Result<void> set_triangles(const view::StreamedDraw& draw, const view::CutTriangles& triangles,
                               view::FrameStats& stats);
    void set_mesh(const view::StreamedDraw& draw, ResidentMesh mesh);
    Result<void> upload_all(std::span<const ChangedMesh> changed, const StreamedByTile& drawn,
                            view::FrameStats& stats);
    Result<void> prepare_light(const view::DrawList& list, const view::StreamedDraw& draw,
                               view::FrameStats& stats);
    Result<void> prepare_ground(const view::StreamedDraw& draw, view::FrameStats& stats);
    Result<void> upload(const view::StreamedDraw& draw, const view::GridMesh& mesh,
                        view::FrameStats& stats);
    const scene::TerrainIrradiance& irradiance_of(const view::StreamedDraw& draw,
                                                  const scene::TerrainLight& light);
    static Key key_of(const view::StreamedDraw& draw) {
        return {draw.terrain->stream.get(), draw.tile->id};
    }
    Entry& entry_of(const view::StreamedDraw& draw);
    [[nodiscard]] bool is_moved_as(const view::StreamedDraw& draw,
                                   const std::vector<terrain::EdgeMove>& moves) const;

    std::uint64_t frame_ = 0;
    std::map<Key, Entry> entries_;
    std::map<const scene::TileStream*, Cover> covers_;
    std::map<const scene::TileStream*, SharedLight> lights_;
    GridUploader grids_;
};

/// The vertices of a tile after the moves of its border. `drawn` contains the moves' target tiles.
view::GridMesh streamed_mesh(const view::StreamedDraw& draw,
                             const std::vector<terrain::EdgeMove>& moves,
                             const StreamedByTile& drawn);

} // namespace reljef::render
