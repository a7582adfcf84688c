#pragma once

#include <optional>

#include "engine/cast/block_rays.h"
#include "engine/cast/frame/seen_terrain.h"
#include "engine/cast/packet/block_kernel.h"
#include "engine/material/grain_map.h"
#include "engine/view/draw_list.h"
#include "engine/view/grain_view.h"

namespace reljef::cast {

/// Sets the normals of ground with grain or façades in the paints of tiles.
void set_normals(const view::GrainView& view, PlacedTiles& placed);

/// The fine structure of near ground, for rays. Its patterns are made once, when they may first be
/// seen.
class GroundGrain {
public:
    /// Null: no tile of the terrain is near enough to show grain. Valid as long as this object,
    /// until the next call. The tiles need their normals: see set_normals().
    const GrainPaint* prepare(const view::DrawList& list, const SeenTerrain& seen,
                              const view::GrainView& view);

private:
    std::optional<material::GrainMap> map_;
    GrainPaint paint_;
};

} // namespace reljef::cast
