#include "engine/view/occlusion.h"

#include <map>
#include <optional>
#include <variant>
#include <vector>

#include "engine/terrain/field/earth_horizon.h"
#include "engine/terrain/field/horizon.h"
#include "engine/view/error_view.h"

namespace reljef::view {
namespace {

// The error bound of a terrain, pixels; empty if there is none.
std::optional<double> max_error_of(const TerrainDraw& terrain) {
    if (!terrain.coarseness) {
        return 0.0;
    }
    const auto* const view = std::get_if<terrain::ErrorView>(&*terrain.coarseness);
    return view != nullptr ? std::optional(view->max_error + view->vertex_rounding) : std::nullopt;
}

// What nearer ground of a terrain in memory hides: on a plane, or on the Earth.
struct Occluders {
    std::optional<terrain::Horizon> ground;
    std::optional<terrain::EarthHorizon> earth;

    [[nodiscard]] bool hide(const Box& box) {
        return (ground && ground->hides(box)) || (earth && earth->hides(box));
    }
};

Occluders occluders_of(const DrawList& list, const TileDraw& draw) {
    const auto error = max_error_of(list.terrains[draw.node]);
    if (draw.flat || draw.terrain->material.wireframe || !error) {
        return {};
    }
    const auto view = horizon_view(list.camera, list.size, list.world_from_local(draw), *error);
    if (!view) {
        return {};
    }
    const scene::TerrainSurface& surface = *draw.terrain->surface;
    const terrain::Heightfield& heightfield = surface.heightfield();
    const terrain::Placement& placement = surface.placement();
    const terrain::MinMax range = surface.pyramid().total();
    const double exaggeration = placement.exaggeration();
    return {terrain::Horizon::create(heightfield, surface.pyramid(), placement, *view),
            terrain::EarthHorizon::create(
                placement, {heightfield.heights.cols(), heightfield.heights.rows()},
                {exaggeration * range.low, exaggeration * range.high}, 1.0, *view)};
}

} // namespace

void drop_occluded(DrawList& list) {
    std::map<const scene::TerrainNode*, Occluders> occluders;
    const auto dropped = std::erase_if(list.tiles, [&](const TileDraw& draw) {
        if (!draw.tile->borrows) {
            return draw.is_hidden;
        }
        const auto [entry, is_new] = occluders.try_emplace(draw.terrain);
        if (is_new) {
            entry->second = occluders_of(list, draw);
        }
        return entry->second.hide(draw.tile->bounds);
    });
    list.stats.skipped.tiles_occluded += static_cast<int>(dropped);
}

} // namespace reljef::view
