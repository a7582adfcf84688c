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

/// The tiles whose triangles are chosen frame by frame: cut where the choice changed, uploaded
/// where other triangles came of it. Needs a current context; destroy while it is current.
class CoarseTiles {
public:
    /// Precondition: `draw` is of a list that was prepared.
    [[nodiscard]] std::span<const ResidentMesh> tile(const view::TileDraw& draw) const;

    /// Cuts and uploads the list's coarse tiles; fails when the driver has no memory left.
    Result<void> prepare(const view::DrawList& list, view::FrameStats& stats);

    /// Begins a frame: lets go of what no scene holds any more, and of what was not drawn for long.
    void forget_unused();

private:
    // A tile as it was cut last.
    struct CutTile {
        int choice = -1; // that it was cut for
        std::vector<terrain::Triangulation> parts;
        std::vector<std::vector<view::GridVertex>> vertices; // of each part
        std::vector<ResidentMesh> meshes;                    // one a part
    };
    struct Cut {
        std::weak_ptr<const scene::TerrainSurface> owner;
        view::Coarseness coarseness;
        int choice = 0; // counts how often it changed
        int frame = 0;  // that it was drawn in last
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

    // A node and the parameters of its technique: one that is taken up again is cut already.
    using CutKey = std::pair<const scene::TerrainNode*, scene::TechniqueParameters>;

    int frame_ = 0;
    std::map<CutKey, Cut> cuts_;
    std::map<const scene::TerrainSurface*, SharedBisection> bisections_;
};

} // namespace reljef::render
