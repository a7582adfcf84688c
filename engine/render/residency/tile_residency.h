#pragma once

#include <map>
#include <memory>
#include <utility>

#include "engine/core/result.h"
#include "engine/render/residency/resident_tile.h"
#include "engine/scene/technique/technique.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// The layers that a technique searches; empty: the heights.
std::optional<material::LayerKind> layers_for(scene::TechniqueId id);

/// The surface detail in GPU memory, kept as long as the scene has it.
class TileResidency {
public:
    using Set = std::shared_ptr<const material::ReliefMaterial>;

    /// Uploads a tile, its side and the technique's additional maps. Fails without GL memory.
    Result<void> prepare(const Set& set, const TileSide& side, scene::TechniqueId technique,
                         view::FrameStats& stats);
    void forget_unused();

    /// Precondition: prepared.
    [[nodiscard]] const ResidentTile& tile(const Set& set, const TileSide& side) const;
    [[nodiscard]] const ResidentSurface& surface(const Set& set, const TileSide& side) const;

private:
    struct Tile {
        std::weak_ptr<const material::ReliefMaterial> owner;
        ResidentTile resident;
    };
    struct Surface {
        std::weak_ptr<const material::ReliefMaterial> owner;
        ResidentSurface resident;
    };
    using TileKey = std::pair<const material::ReliefMaterial*, bool>; // wraps
    using SurfaceKey = std::pair<const material::ReliefMaterial*, TileSide>;

    Result<void> prepare_tile(const Set& set, bool wraps, view::FrameStats& stats);
    Result<void> prepare_surface(const Set& set, const TileSide& side, scene::TechniqueId technique,
                                 view::FrameStats& stats);

    std::map<TileKey, Tile> tiles_;
    std::map<SurfaceKey, Surface> surfaces_;
};

} // namespace reljef::render
