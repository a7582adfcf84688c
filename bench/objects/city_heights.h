#pragma once

#include <stop_token>
#include <string>

#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/session/scene_setup.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::bench {

/// The heights of a surface model of a city: at every sample of its bare ground the highest of the
/// ground and of the meshes that stand there, by vertical rays, metres. Walls are as in surface
/// models: samples lie inside or outside. Fails as truth::MeshCaster::create(), and where the
/// ground does not fit into memory or `stop` was requested.
Result<Grid<float>> heights_of_city(const session::TerrainScene& city, unsigned threads,
                                    const std::stop_token& stop);

/// How far a scanned surface model of the same grid is from heights_of_city(), as a sentence; says
/// so if the grids differ. Voids of the scan are left out.
std::string scan_difference(const std::string& city, const terrain::Heightfield& scanned,
                            const terrain::Heightfield& heights);

} // namespace reljef::bench
