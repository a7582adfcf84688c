#pragma once

#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/result.h"
#include "engine/render/residency/resident_mesh.h"
#include "engine/terrain/mesh/bisection.h"
#include "engine/view/draw_list.h"
#include "engine/view/grid_mesh.h"

namespace reljef::render {

/// Tiles whose triangles are chosen per frame. Triangulated when the coarseness changes, uploaded
/// when the triangles change.
class CoarseTiles {
public:
    /// Precondition: `draw` is of a prepared list.
    [[nodiscard]] std::span<const ResidentMesh> tile(const view::TileDraw& draw) const;

    Result<void> prepare(const view::DrawList& list, view::FrameStats& stats);

    /// Begins a frame: drops tiles without a scene and tiles that were not drawn for long.
    void forget_unused();

private:
    struct CutTile {
        int version = -1;
        std::vector<terrain::Triangulation> parts;
        std::vector<std::vector<view::GridVertex>> vertices;
        std::vector<ResidentMesh> meshes;
    };
    struct Cut {
        std::weak_ptr<const scene::TerrainSurface> owner;
        view::Coarseness coarseness;
        int version = 0; // of the coarseness
        int frame = 0;   // last drawn
        std::vector<CutTile> tiles;
    };
    struct SharedBisection {
        std::weak_ptr<const scene::TerrainSurface> owner;
        std::unique_ptr<const terrain::Bisection> bisection;
    };

    Result<void> prepare(const view::DrawList& list, const view::CoarseTerrain& terrain,
                         view::FrameStats& stats);
    Cut& cut_of(const view::CoarseTerrain& terrain);
    const terrain::Bisection& bisection_of(const scene::TerrainNode& terrain);
    static std::vector<std::size_t> outdated_tiles(const view::DrawList& list,
                                                   const scene::TerrainNode& terrain,
                                                   const Cut& cut, view::FrameStats& stats);

    // The parameters are part of the key, so that a technique that is selected again is ready.
    using CutKey = std::pair<const scene::TerrainNode*, scene::TechniqueParameters>;

    int frame_ = 0;
    std::map<CutKey, Cut> cuts_;
    std::map<const scene::TerrainSurface*, SharedBisection> bisections_;
};

} // namespace reljef::render
