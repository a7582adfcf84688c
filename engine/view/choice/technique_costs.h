#pragma once

namespace reljef::view {

/// What drawing a terrain costs, while the view moves. The defaults are those of llvmpipe on two
/// threads, measured by `reljef calibrate --context osmesa`.
struct TechniqueCosts {
    double frame_ms = 2.0;          ///< of any frame
    double triangle_ns = 150.0;     ///< of each triangle: cut, uploaded, drawn
    double covered_pixel_ns = 12.0; ///< of each pixel that triangles cover
    double rays_ms = 4.0;           ///< of the first ray: the pass over blocks of pixels
    double ray_pixel_ns = 55.0;     ///< of each ray through the box around the terrain

    friend bool operator==(const TechniqueCosts&, const TechniqueCosts&) = default;
};

} // namespace reljef::view
