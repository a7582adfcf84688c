#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/cast/block_rays.h"
#include "engine/core/color.h"
#include "engine/core/grid.h"

namespace reljef::cast {

/// Places of a pixel's samples, from its middle, pixels. Automatic: 4. Precondition:
/// view::check_samples().
std::span<const glm::ivec2> sixteenths_of(int samples);

/// A picture with one sample per pixel, and where its surfaces end. Nearness is linear in the pixel
/// over a plane: in perspective the inverse depth, 0 for the sky; on a map the negative depth, and
/// less than all else for the sky.
struct FirstSamples {
    Image picture;
    bool is_perspective = true;
    /// By how much nearness may leave a plane until it is another surface: in perspective relative
    /// to the nearest of three pixels, on a map absolute.
    float disagreement = 0.0F;
    bool samples_all = false; ///< all pixels need several samples
    /// Bits: pixels inside of blocks that are not on a plane with those around them. By column of
    /// blocks, and row of pixels.
    Grid<std::uint32_t> bends;
    /// Nearness of the two rows along the upper and the lower border of each row of blocks, and of
    /// the two columns along the left and the right border of each column. One value more on each
    /// side. Not a number beside the picture.
    Grid<float> border_rows;
    Grid<float> border_cols; ///< transposed

    void resize(glm::ivec2 size);
    /// Keeps the bends inside of a block, and the nearness along its borders. Pixels beside `of`
    /// are beside the picture: their nearness becomes not a number. Threads may add several blocks.
    void add_nearness(BlockPixels& pixels, const PixelBlock& block, const PixelBlock& of,
                      const BlockKernel& kernel);
};

/// The pixels of a block that need several samples: beside them the picture has another colour,
/// because another surface begins or the surface bends sharply. As SampledPixels::pixels; those of
/// a beam follow each other.
std::vector<std::uint16_t> sampled_pixels(const FirstSamples& first, const BlockKernel& kernel,
                                          const PixelBlock& block);

} // namespace reljef::cast
