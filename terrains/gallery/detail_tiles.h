#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "engine/core/result.h"
#include "engine/material/relief_material.h"

namespace reljef::terrains {

struct DetailOptions {
    int size = 512; ///< texels a side, 16 to 4096
    std::uint32_t seed = 1;
    unsigned threads = 0; ///< 0: as many as the machine has
};

/// brick, rock, cobble; of sheets: fence, rings, copper.
std::span<const std::string_view> detail_names();

/// A tile of surface detail whose opposite borders fit together, its heights in [0,1]: a wall of
/// bricks, cracked rock, cobbles in sand; a fence of wires with holes, a curtain of rings in
/// layers, hammered copper with ribs on its back. The same seed gives the same bits. Fails on an
/// unknown name, with the known ones, and on a size out of range.
Result<material::ReliefMaterial> generate_detail(std::string_view name,
                                                 const DetailOptions& options = {});

} // namespace reljef::terrains
