#pragma once

namespace reljef::view {

/// What drawing a terrain costs, while the view moves. The defaults are those of llvmpipe on two
/// processors, by `reljef calibrate --context osmesa`. Other programs ran beside it: the choice
/// depends on ratios, which differed by a tenth from run to run, and not on milliseconds.
struct TechniqueCosts {
    double frame_ms = 23.7;         ///< of any frame
    double triangle_ns = 1072.0;    ///< of each triangle: cut, uploaded, drawn
    double covered_pixel_ns = 47.9; ///< of each pixel that triangles cover
    double rays_ms = 24.2;          ///< of the first ray: the pass over blocks of pixels
    double ray_pixel_ns = 277.0;    ///< of each ray through the box around the terrain

    friend bool operator==(const TechniqueCosts&, const TechniqueCosts&) = default;
};

} // namespace reljef::view
