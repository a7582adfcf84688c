#pragma once

#include <optional>

#include "engine/cast/block_rays.h"
#include "engine/cast/frame/seen_terrain.h"
#include "engine/cast/packet/block_kernel.h"
#include "engine/material/grain_map.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {

/// The fine structure of near ground, for rays. Its patterns are made once, if a terrain has grain.
class GroundGrain {
public:
    /// Null: the terrain has no grain. Adds what it needs to the paints of `placed`. Valid as long
    /// as this object, until the next call.
    const GrainPaint* prepare(const view::DrawList& list, const SeenTerrain& seen,
                              PlacedTiles& placed);

private:
    std::optional<material::GrainMap> map_;
    GrainPaint paint_;
};

} // namespace reljef::cast
