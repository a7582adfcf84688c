#pragma once

#include <memory>
#include <optional>

#include "engine/cast/frame/seen_terrain.h"
#include "engine/cast/packet/block_kernel.h"
#include "engine/view/draw_list.h"
#include "engine/view/facade_view.h"

namespace reljef::cast {

/// The façades of a terrain, for rays. They are made anew for another terrain or light.
class GroundFacades {
public:
    /// Null: the terrain shows none. Valid as long as this object, until the next call. The tiles
    /// need their normals: see set_normals().
    const FacadePaint* prepare(const view::DrawList& list, const SeenTerrain& seen);

private:
    std::weak_ptr<const scene::TerrainSurface> surface_;
    std::optional<scene::TerrainLight> light_;
    view::FacadeMap map_;
    FacadePaint paint_;
};

} // namespace reljef::cast
