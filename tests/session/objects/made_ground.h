#pragma once

#include <memory>
#include <utility>

#include "engine/scene/streaming/terrain_surface.h"

namespace reljef::test {

inline scene::TerrainSurface ground_of(terrain::Heightfield field, double exaggeration = 1.0) {
    auto terrain = std::make_shared<terrain::Terrain>();
    terrain->name = "made";
    terrain->heightfield = std::move(field);
    scene::TerrainOptions options;
    options.exaggeration = exaggeration;
    return scene::TerrainSurface::create(terrain, options).value();
}

} // namespace reljef::test
