#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/runner/benchmark_scene.h"
#include "engine/scene/technique/technique.h"

namespace reljef::bench {

/// A detail texture of the gallery, 256 texels a side, three copies along each side of a level
/// square of 4 m. Heightfields lie below the square, layers around it. Fails on an unknown name.
Result<truth::DetailSquare> detail_square(std::string_view name, unsigned threads);

/// The scenes of `--terrain gallery`: a heightfield and each kind of layers.
std::vector<SceneChoice> gallery_scenes();

/// Whether a technique draws the surface of a scene: on layers, the one technique for their kind;
/// on heightfield textures, all others except polygons; on terrains, those that draw terrains.
/// Texture suits every scene.
bool suits(scene::TechniqueId id, const SceneChoice& scene);

/// Throws a usage error (CLI::ParseError) if techniques are given and none suits any terrain.
void check_suited(const std::vector<scene::Technique>& techniques,
                  const std::vector<std::string>& terrains);

/// The techniques of the catalogue that suit a scene.
std::vector<scene::TechniqueInfo> techniques_of(const SceneChoice& scene);

} // namespace reljef::bench
