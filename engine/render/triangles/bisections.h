#pragma once

#include <map>
#include <memory>

#include "engine/scene/graph/terrain_node.h"
#include "engine/scene/streaming/terrain_surface.h"
#include "engine/terrain/mesh/bisection.h"
#include "engine/view/draw_list.h"

namespace reljef::render {

/// The bisections of terrains in memory: those that come with their nodes, and others computed
/// here.
class Bisections {
public:
    /// Null for a tile of a stream, which has its own.
    const terrain::Bisection* of(const view::TileDraw& draw);
    /// Those of surfaces that are gone.
    void forget_unused();

private:
    struct Entry {
        std::weak_ptr<const scene::TerrainSurface> owner;
        std::unique_ptr<const terrain::Bisection> bisection;
    };
    const terrain::Bisection& of_surface(const scene::TerrainNode& terrain);

    std::map<const scene::TerrainSurface*, Entry> entries_;
};

/// A loaded tile and its bisection, which needs it.
struct TileBisection {
    explicit TileBisection(std::shared_ptr<const scene::TerrainTile> of);

    std::shared_ptr<const scene::TerrainTile> tile;
    terrain::Bisection bisection;
};

} // namespace reljef::render
