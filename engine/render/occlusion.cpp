#include "engine/render/occlusion.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "engine/terrain/horizon.h"

namespace reljef::render {
namespace {

// Whether angles are the same on both sides.
bool is_rigid(const glm::dmat4& transform) {
    constexpr double rounding = 0x1p-40;
    const glm::dmat3 axes(transform);
    const glm::dmat3 product = glm::transpose(axes) * axes;
    double most = 0.0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            most = std::max(most, std::abs(product[i][j] - (i == j ? 1.0 : 0.0)));
        }
    }
    return most <= rounding;
}

// Pixels that what is drawn may be seen off; nothing where that is not known.
std::optional<double> error_of(const DrawList& list, const scene::TerrainNode& terrain) {
    for (const CoarseTerrain& coarse : list.coarse_terrains) {
        if (coarse.terrain == &terrain) {
            const auto* const view = std::get_if<terrain::ErrorView>(&coarse.coarseness);
            return view != nullptr ? std::optional(view->most_error) : std::nullopt;
        }
    }
    return 0.0;
}

std::optional<terrain::Horizon> horizon_of(const DrawList& list, const TileDraw& draw) {
    const auto error = error_of(list, *draw.terrain);
    if (draw.flat || draw.terrain->material.wireframe || !error ||
        !is_rigid(draw.world_from_local)) {
        return std::nullopt;
    }
    // A radian is seen as so many pixels at least, in the picture's middle.
    const double half_height = std::tan(0.5 * glm::radians(list.camera.vertical_fov));
    const double focal = 0.5 * list.size.y / half_height;
    const double half_width = half_height * list.size.x / list.size.y;
    constexpr double rasterized = 1.0; // pixels that a pixel's ray and its corners lie apart
    const scene::TerrainSurface& surface = *draw.terrain->surface;
    terrain::HorizonView view;
    view.eye = glm::dvec3(glm::inverse(draw.world_from_local) * glm::dvec4(list.camera.eye, 1.0));
    view.near =
        list.camera.near * std::sqrt(1.0 + half_height * half_height + half_width * half_width);
    view.margin = (*error + rasterized) / focal;
    return terrain::Horizon::create(surface.heightfield(), surface.pyramid(), surface.placement(),
                                    view);
}

} // namespace

void drop_occluded(DrawList& list) {
    if (list.camera.projection != scene::ProjectionKind::perspective) {
        return;
    }
    std::map<const scene::TerrainNode*, std::optional<terrain::Horizon>> horizons;
    const auto dropped = std::erase_if(list.tiles, [&](const TileDraw& draw) {
        const auto [entry, is_new] = horizons.try_emplace(draw.terrain);
        if (is_new) {
            entry->second = horizon_of(list, draw);
        }
        const auto tile = static_cast<std::size_t>(draw.tile);
        return entry->second && entry->second->hides(draw.terrain->surface->tiles()[tile].bounds);
    });
    list.stats.skipped.tiles_occluded += static_cast<int>(dropped);
}

} // namespace reljef::render
