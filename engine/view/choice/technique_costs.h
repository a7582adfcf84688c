#pragma once

namespace reljef::view {

/// What drawing a terrain costs, while the view moves. The defaults are those of llvmpipe on two
/// processors, the middle of runs that drew all triangles anew in each frame: of triangles of five,
/// which differed by at most 7 %, of rays of seven, by at most 10 % of their sum. `reljef calibrate
/// --context osmesa`, which moves as a flight does, found 6.7 to 7.3, 404 to 431, 18.5 to 21.1, 0.9
/// to 1.5 and 92 to 99 there. It found 39 to 41 and 2.5 to 2.6 for searches, whose estimates are
/// nearly those of the defaults with 3 ms instead of 1.4 ms of the first ray.
struct TechniqueCosts {
    double frame_ms = 7.2;          ///< of any frame
    double triangle_ns = 375.0;     ///< of each triangle: cut, uploaded, drawn
    double covered_pixel_ns = 19.7; ///< of each pixel that triangles cover
    double rays_ms = 3.0;           ///< of the first ray: the pass over blocks of pixels
    double ray_pixel_ns = 94.0;     ///< of each ray through the box around the terrain
    double search_pixel_ns = 36.0;  ///< the same of a search by steps
    double search_step_ns = 3.0;    ///< and of each of its steps

    friend bool operator==(const TechniqueCosts&, const TechniqueCosts&) = default;
};

} // namespace reljef::view
