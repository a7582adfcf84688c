#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "engine/render/triangles/bisections.h"
#include "engine/render/triangles/tile_mesh.h"
#include "engine/scene/graph/camera.h"
#include "engine/view/draw_list.h"
#include "engine/view/triangles/tile_cut.h"
#include "engine/view/triangles/tile_seam.h"

namespace reljef::render {

/// What a seam depends on, beside its tile.
struct Seam {
    view::OpenSide open;
    std::uint64_t neighbour_shape = 0;
    view::BorderError error; ///< without a neighbour

    friend bool operator==(const Seam&, const Seam&) = default;
};

/// A tile's triangles in GPU memory, and what they were made for.
struct ResidentTriangles {
    std::weak_ptr<const scene::TerrainTile> owner;
    std::uint64_t drawn = 0;      ///< last frame
    std::vector<TileMesh> meshes; ///< of the tile, then of its seams
    std::size_t seam_count = 0;
    std::uint64_t slivers_version = 0; ///< of the coarseness; 0: no slivers are known

    // Of tiles of streams.
    std::uint64_t shape = 0; ///< changes with the triangles; no two of a group have the same
    view::TileBorder border;
    std::uint64_t seamed_shape = 0;
    std::vector<Seam> seams;
    std::vector<view::SeamPart> seam_parts;

    // Of tiles that are cut.
    std::uint64_t version = 0; ///< of the coarseness
    double error = 0.0;        ///< of the tile, pixels
    double triangle_error = 0.0;
    view::Coarsening coarsening;
    double kept_error = 0.0; ///< of all that is drawn, pixels
    std::size_t triangles = 0;
    view::CutMesh last;
    std::unique_ptr<const TileBisection> bisection; ///< of a loaded tile

    /// Whether anything else holds the tile; otherwise it was evicted.
    [[nodiscard]] bool is_held_elsewhere() const;
    const terrain::Bisection& own_bisection(const std::shared_ptr<const scene::TerrainTile>& tile);
};

/// What slivers depend on, beside their triangles.
struct SeenPicture {
    scene::Camera camera;
    glm::ivec2 size{0};

    friend bool operator==(const SeenPicture&, const SeenPicture&) = default;
};

/// Tiles of one terrain that are drawn alike.
struct MeshGroup {
    std::weak_ptr<const void> owner;
    std::uint64_t kept_frames = 0; ///< of unused tiles
    std::map<terrain::TreeTile, ResidentTriangles> tiles;
    std::uint64_t last_shape = 0;
    view::Coarseness coarseness;
    std::uint64_t version = 0; ///< of the coarseness, from 1
    std::optional<SeenPicture> slivers_of;
    std::vector<std::tuple<terrain::TreeTile, double, double>> errors; ///< of the drawn tiles
    std::size_t max_triangles = 0;
    view::Coarsening coarsening;

    /// Keeps the seams.
    void replace_meshes(ResidentTriangles& tile, std::vector<TileMesh> meshes);
};

/// A group in a frame.
struct DrawnGroup {
    MeshGroup& group;
    const view::DrawList& list;
    std::vector<const view::TileDraw*> draws;

    [[nodiscard]] ResidentTriangles& triangles_of(const view::TileDraw& draw) const {
        return group.tiles.at(draw.tile->id);
    }
};

/// A tile that needs other triangles, seams or slivers.
struct OutdatedTile {
    const view::TileDraw* draw = nullptr;
    ResidentTriangles* triangles = nullptr;
};

/// Whether seams join the tile with its neighbours. Tiles in memory have one border with them; flat
/// ones, too.
bool has_seams(const view::TileDraw& draw);

/// How the tile's triangles are cut. `shared`: the bisection of a terrain in memory.
view::CutOptions cut_options(const MeshGroup& group, const OutdatedTile& tile,
                             const terrain::Bisection* shared);

} // namespace reljef::render
