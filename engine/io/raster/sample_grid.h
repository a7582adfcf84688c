#pragma once

#include <glm/vec2.hpp>

namespace reljef::io {

/// Maps heightfield samples to raster pixels: the centre of sample (col, row) is
/// origin + step·(col, row) in GDAL's pixel coordinates; (0, 0) is the OUTER corner of the first
/// pixel. A negative step mirrors the raster.
struct SampleGrid {
    glm::dvec2 origin{0.5};
    glm::dvec2 step{1.0};
    int cols = 0;
    int rows = 0;
    /// From the middle of the samples to that of the raster, in samples: not 0 where a reduction
    /// leaves out the last pixels.
    glm::dvec2 to_middle{0.0};

    [[nodiscard]] glm::dvec2 pixel_from_sample(glm::dvec2 sample) const {
        return origin + step * sample;
    }
    void flip_cols() {
        origin.x += step.x * (cols - 1);
        step.x = -step.x;
        to_middle.x = -to_middle.x;
    }
    void flip_rows() {
        origin.y += step.y * (rows - 1);
        step.y = -step.y;
        to_middle.y = -to_middle.y;
    }
};

} // namespace reljef::io
