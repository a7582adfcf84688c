#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "engine/building/building_faces.h"
#include "engine/building/city_form.h"
#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::terrains {

struct GeneratorOptions {
    int size = 1025;        ///< samples a side, 16 to 4096
    std::uint32_t seed = 1; ///< one seed gives the same bits on every machine and thread count
    double spacing = 0.0;   ///< metres between samples; 0: natural 20 m, urban 0.5 m
    bool tileable = false;  ///< urban only: the terrain repeats every `size` samples
    building::CityWalls walls = building::CityWalls::straight; ///< urban only
    unsigned threads = 0;                                      ///< 0: as many as the machine has
    Progress progress = {};
    std::stop_token stop = {}; ///< a stopped generator fails
};

/// Eroded mountains with rivers and lakes, coloured by height, slope and moisture. Errors: a size
/// or spacing out of range, tileable.
Result<terrain::Terrain> generate_natural(const GeneratorOptions& options);

/// A city with streets, buildings, trees and cars. Heights are metres above the street. Errors: a
/// size or spacing out of range.
Result<terrain::Terrain> generate_urban(const GeneratorOptions& options);

/// The same city, whose buildings and what stands on them may be meshes.
struct City {
    terrain::Terrain terrain;
    /// On a plane, metres from the middle of the terrain, and above the street; cut at its border.
    std::vector<building::PaintedFaces> buildings;
    /// Of the form `heights`: where the buildings are meshes, else empty.
    Grid<float> heights;
};
/// The bare ground keeps trees, cars and hedges. On a level plane these are painted only. Colours
/// of the ground get the same darkening in all forms.
Result<City> generate_city(const GeneratorOptions& options, building::CityForm form);

} // namespace reljef::terrains
