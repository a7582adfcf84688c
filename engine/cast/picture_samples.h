#pragma once

#include <span>

#include <glm/vec2.hpp>

#include "engine/cast/block_rays.h"
#include "engine/core/color.h"
#include "engine/core/grid.h"

namespace reljef::cast {

/// Places of a pixel's samples, from its middle, pixels. Automatic: 4. Precondition:
/// view::check_samples().
std::span<const glm::ivec2> sixteenths_of(int samples);

/// A picture with one sample per pixel, and how near its hits are: linear in the pixel over a
/// plane. In perspective the inverse depth, 0 for the sky; on a map the negative depth, and less
/// than all else for the sky.
struct FirstSamples {
    Image picture;
    Grid<float> nearness; ///< see nearness_at(); not a number beside the picture
    bool is_perspective = true;
    /// By how much nearness may leave a plane until it is another surface: in perspective relative
    /// to the nearest of three pixels, on a map absolute.
    float disagreement = 0.0F;
    bool samples_all = false; ///< all pixels need several samples

    void resize(glm::ivec2 size);
    /// Of a block; pixels beside `of` have none.
    void write_nearness(const BlockPixels& pixels, const PixelBlock& block, const PixelBlock& of);
    /// Of a pixel; those beside it in its row follow, also beside the picture.
    [[nodiscard]] float* nearness_at(glm::ivec2 pixel) {
        return &nearness(pixel.x + 1, pixel.y + 1);
    }
    [[nodiscard]] const float* nearness_at(glm::ivec2 pixel) const {
        return &nearness(pixel.x + 1, pixel.y + 1);
    }
};

/// The pixels of a block that need several samples: beside them the picture has another colour,
/// because another surface begins or the surface bends sharply. Its `samples` remain.
void choose_sampled(const FirstSamples& first, const BlockKernel& kernel, const PixelBlock& block,
                    SampledPixels& sampled);

} // namespace reljef::cast
