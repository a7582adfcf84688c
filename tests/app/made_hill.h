#pragma once

#include <utility>

#include "engine/session/scene_setup.h"
#include "engine/terrain/field/heightfield.h"
#include "tests/session/made_session.h"

namespace reljef::app {

/// Draws every sample where neither a technique nor a bound is named: no map is to be made.
inline session::TerrainScene scene_of(Grid<float> heights, session::SceneOptions view = {}) {
    if (!view.technique) {
        view.max_error = view.max_error.value_or(0.0);
    }
    session::TerrainSource source;
    source.terrain.name = "hill";
    auto& heightfield = source.terrain.heightfield;
    heightfield.heights = std::move(heights);
    heightfield.spacing = {10.0, 10.0};
    heightfield.range = terrain::height_range(heightfield.heights, {});
    return test::make_scene(std::move(source), {}, view).value();
}

inline session::TerrainScene hill_scene(const session::SceneOptions& view = {}) {
    Grid<float> heights(33, 33, 10.0F);
    heights(16, 16) = 60.0F;
    return scene_of(std::move(heights), view);
}

} // namespace reljef::app
