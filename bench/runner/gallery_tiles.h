#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/runner/benchmark_scene.h"
#include "engine/core/result.h"
#include "engine/scene/technique/technique.h"
#include "engine/truth/tile_plane.h"

namespace reljef::bench {

/// The gallery's tile of that name as it is measured: of 256 texels a side, three times along each
/// side of a level square of 4 m, under the gallery's sun. Heights are sunk below the square,
/// sheets lie about it. Fails on an unknown name.
Result<truth::TileSquare> tile_square(std::string_view name, unsigned threads);

/// What `--terrain gallery` measures: brick, and fence, copper and rings, one for each kind of
/// layers.
std::vector<SceneChoice> gallery_scenes();

/// Whether a technique draws there what its tile is: layers the one technique that looks for them,
/// heights all others but polygons, which shows a mesh as texture does; and texture any. Of
/// terrains those that draw any.
bool suits(scene::TechniqueId id, const SceneChoice& scene);

/// Refuses (app/misuse.h) techniques of which none suits any of the terrains; where none are chosen
/// there is nothing to refuse.
void expect_suited(const std::vector<scene::Technique>& techniques,
                   const std::vector<std::string>& terrains);

/// The techniques of the catalogue that suit a stage.
std::vector<scene::TechniqueInfo> techniques_of(const SceneChoice& scene);

} // namespace reljef::bench
