#include "engine/render/residency/tile_residency.h"

#include "engine/render/residency/uploads.h"

namespace reljef::render {

std::optional<material::LayerKind> layers_for(scene::TechniqueId id) {
    switch (id) {
    case scene::TechniqueId::lattice:
        return material::LayerKind::symmetric;
    case scene::TechniqueId::dual_layer:
        return material::LayerKind::dual;
    case scene::TechniqueId::multi_layer:
        return material::LayerKind::multi;
    default:
        return std::nullopt;
    }
}

Result<void> TileResidency::prepare(const Set& set, const TileSide& side,
                                    scene::TechniqueId technique, view::FrameStats& stats) {
    if (auto done = prepare_tile(set, side.wraps, stats); !done) {
        return done;
    }
    return prepare_surface(set, side, technique, stats);
}

void TileResidency::forget_unused() {
    const auto is_gone = [](const auto& entry) { return entry.second.owner.expired(); };
    std::erase_if(tiles_, is_gone);
    std::erase_if(surfaces_, is_gone);
}

Result<void> TileResidency::prepare_tile(const Set& set, bool wraps, view::FrameStats& stats) {
    const TileKey key{set.get(), wraps};
    if (tiles_.contains(key)) {
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    auto tile = resident_tile(*set, wraps, stats);
    if (!tile) {
        return tile.error();
    }
    tiles_.emplace(key, Tile{set, std::move(*tile)});
    return {};
}

Result<void> TileResidency::prepare_surface(const Set& set, const TileSide& side,
                                            scene::TechniqueId technique, view::FrameStats& stats) {
    const SurfaceKey key{set.get(), side};
    auto found = surfaces_.find(key);
    if (found == surfaces_.end()) {
        auto surface = resident_surface(*set, side, stats);
        if (!surface) {
            return surface.error();
        }
        found = surfaces_.emplace(key, Surface{set, std::move(*surface)}).first;
    }
    ResidentSurface& surface = found->second.resident;
    if (technique == scene::TechniqueId::exact && !surface.max_mipmap) {
        return keep(max_mipmap_texture(*set, side, stats), surface.max_mipmap);
    }
    if (technique == scene::TechniqueId::cone && !surface.cones) {
        return keep(tile_cone_texture(*set, side, stats), surface.cones);
    }
    return {};
}

const ResidentTile& TileResidency::tile(const Set& set, const TileSide& side) const {
    return tiles_.at({set.get(), side.wraps}).resident;
}

const ResidentSurface& TileResidency::surface(const Set& set, const TileSide& side) const {
    return surfaces_.at({set.get(), side}).resident;
}

} // namespace reljef::render
