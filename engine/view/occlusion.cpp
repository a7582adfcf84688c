#include "engine/view/occlusion.h"

#include <map>
#include <optional>

#include "engine/view/horizon_view.h"

namespace reljef::view {
namespace {

// Pixels that what is drawn may be seen off; nothing where that is not known.
std::optional<double> error_of(const DrawList& list, const scene::TerrainNode& terrain) {
    for (const CoarseTerrain& coarse : list.coarse_terrains) {
        if (coarse.terrain == &terrain) {
            const auto* const view = std::get_if<terrain::ErrorView>(&coarse.coarseness);
            return view != nullptr ? std::optional(view->max_error) : std::nullopt;
        }
    }
    return 0.0;
}

std::optional<terrain::Horizon> horizon_of(const DrawList& list, const TileDraw& draw) {
    const auto error = error_of(list, *draw.terrain);
    if (draw.flat || draw.terrain->material.wireframe || !error) {
        return std::nullopt;
    }
    const auto view = horizon_view(list.camera, list.size, list.world_from_local(draw), *error);
    const scene::TerrainSurface& surface = *draw.terrain->surface;
    return view ? terrain::Horizon::create(surface.heightfield(), surface.pyramid(),
                                           surface.placement(), *view)
                : std::nullopt;
}

} // namespace

void drop_occluded(DrawList& list) {
    std::map<const scene::TerrainNode*, std::optional<terrain::Horizon>> horizons;
    const auto dropped = std::erase_if(list.tiles, [&](const TileDraw& draw) {
        const auto [entry, is_new] = horizons.try_emplace(draw.terrain);
        if (is_new) {
            entry->second = horizon_of(list, draw);
        }
        const auto tile = static_cast<std::size_t>(draw.tile);
        return entry->second && entry->second->hides(draw.terrain->surface->tiles()[tile].bounds);
    });
    const auto streamed =
        std::erase_if(list.streamed_tiles, [](const StreamedDraw& draw) { return draw.is_hidden; });
    list.stats.skipped.tiles_occluded += static_cast<int>(dropped + streamed);
}

} // namespace reljef::view
