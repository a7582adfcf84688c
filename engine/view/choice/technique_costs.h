#pragma once

namespace reljef::view {

/// What drawing a terrain costs, while the view moves. Rasterizers draw blocks of pixels; those at
/// a triangle's edges take longest. A triangle of A pixels has about √A of them, so N triangles
/// that cover P pixels touch about √(N P). The defaults are those of llvmpipe on two processors:
/// of an Intel Xeon, where those of triangles were fitted to twelve moving views, and of an AMD
/// EPYC for further samples. docs/techniques/choice.md compares estimates with what frames took.
struct TechniqueCosts {
    double frame_ms = 7.2;           ///< of any frame
    double triangle_ns = 110.0;      ///< of each triangle: cut, uploaded, drawn
    double touched_pixel_ns = 122.0; ///< of each pixel that their edges touch
    double covered_pixel_ns = 8.0;   ///< of each pixel that they cover
    double rays_ms = 3.0;            ///< of the first ray: the pass over blocks of pixels
    double ray_pixel_ns = 94.0;      ///< of each ray through the box around the terrain
    double search_pixel_ns = 36.0;   ///< the same of a search by steps
    double search_step_ns = 3.0;     ///< and of each of its steps
    double frame_sample_ms = 4.0;    ///< of each further sample of all pixels
    double touched_sample_ns = 75.0; ///< of each further sample of a touched pixel
    double covered_sample_ns = 0.0;  ///< of each further sample of a covered pixel

    friend bool operator==(const TechniqueCosts&, const TechniqueCosts&) = default;
};

} // namespace reljef::view
