#include "engine/render/triangles/bisections.h"

#include <utility>

namespace reljef::render {

const terrain::Bisection* Bisections::of(const view::TileDraw& draw) {
    return draw.tile->borrows ? &of_surface(*draw.terrain) : nullptr;
}

void Bisections::forget_unused() {
    std::erase_if(entries_, [](const auto& entry) { return entry.second.owner.expired(); });
}

const terrain::Bisection& Bisections::of_surface(const scene::TerrainNode& terrain) {
    if (terrain.bisection != nullptr) {
        return *terrain.bisection;
    }
    const auto [entry, is_new] = entries_.try_emplace(terrain.surface.get());
    if (is_new) {
        entry->second = {terrain.surface,
                         std::make_unique<const terrain::Bisection>(terrain.surface->heightfield(),
                                                                    terrain.surface->placement())};
    }
    return *entry->second.bisection;
}

TileBisection::TileBisection(std::shared_ptr<const scene::TerrainTile> of)
    : tile(std::move(of)),
      bisection(tile->heightfield, *tile->placement, {.threads = 1, .stop = {}, .progress = {}}) {}

} // namespace reljef::render
