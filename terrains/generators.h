#pragma once

#include <cstdint>
#include <stop_token>
#include <string_view>

#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::terrains {

struct GeneratorOptions {
    int size = 1025; ///< samples a side, 16 to 4096 (natural: 1025 and 1280 are the sources')
    std::uint32_t seed =
        1; ///< the same seed gives the same bits, on every machine and thread count
    double spacing =
        0.0; ///< metres between samples; 0: the generator's own (natural 20 m, urban 0.5 m)
    bool tileable = false; ///< urban: column `size` would equal column 0, likewise rows
    unsigned threads = 0;  ///< 0: as many as the machine has
    Progress progress = {};
    std::stop_token stop = {}; ///< stopped, a generator fails
};

/// Eroded ridges and valleys with rivers; colour from snow, rock, scree, grass and forest by
/// height, slope and moisture. Fails when the size is out of range.
Result<terrain::Terrain> generate_natural(const GeneratorOptions& options);

/// A city from above: streets, blocks, lots, buildings with flat and pitched roofs, courtyards,
/// trees and cars. Heights in metres above the street. Fails when the size is out of range.
Result<terrain::Terrain> generate_urban(const GeneratorOptions& options);

} // namespace reljef::terrains
