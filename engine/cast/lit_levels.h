#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/cast/block_kernel.h"
#include "engine/core/color.h"

namespace reljef::cast {

/// A terrain's lit map (view/terrain_maps.h) and its mip levels, each half as large, to read by
/// packets of rays.
class LitLevels {
public:
    /// `samples`: of the terrain, along each axis. Preconditions: neither is empty.
    LitLevels(const Image& lit, glm::ivec2 samples);

    /// Sets the levels of a paint. Valid as long as these levels.
    void add_to(BlockPaint& paint) const;

    [[nodiscard]] std::size_t bytes() const { return texels_.size() * sizeof(std::uint32_t); }

private:
    struct Level {
        std::size_t first = 0; // texel
        PaintLevel paint;      // its texels are set when it is used
    };

    std::vector<std::uint32_t> texels_;
    std::vector<Level> levels_;
};

} // namespace reljef::cast
