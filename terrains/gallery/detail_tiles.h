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

/// brick, rock, cobble; and the sheets fence, rings, copper.
std::span<const std::string_view> detail_names();

/// A detail texture that repeats without seams, with heights in [0,1]. Fence and rings have holes,
/// rings has layers, copper has a back with ribs. The same seed gives the same bits. Errors: an
/// unknown name, a size out of range.
Result<material::ReliefMaterial> generate_detail(std::string_view name,
                                                 const DetailOptions& options = {});

} // namespace reljef::terrains
