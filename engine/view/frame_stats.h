#pragma once

#include <cstddef>

namespace reljef::view {

/// What one frame took and what it did not need.
struct FrameStats {
    int nodes = 0; ///< in the scene, visible or not
    int tiles = 0; ///< terrain tiles drawn
    std::size_t triangles = 0;
    int tiles_missing = 0; ///< of streamed terrains, not there yet: coarser ones are drawn
    int tiles_cut = 0;     ///< whose triangles were chosen anew for this frame
    int draws = 0;         ///< draw calls, the sky's included
    int state_changes = 0; ///< programs, vertex arrays, textures, uniform blocks and modes set
    int uploads = 0;       ///< buffers and textures filled
    std::size_t upload_bytes = 0;

    struct Skipped {
        int invisible_nodes = 0; ///< hidden, or below a hidden one
        int nodes_outside_frustum = 0;
        int tiles_outside_frustum = 0;
        int tiles_occluded = 0; ///< behind nearer ground of the same terrain
        std::size_t triangles_outside_frustum = 0;
        std::size_t triangles_under_error = 0; ///< that the samples have more than was drawn
        int selections_unchanged = 0;          ///< 1: what to draw was decided for the frame before
        int details_too_small = 0; ///< terrain tiles too far for the tile of detail on them
        int cuts_unchanged = 0;    ///< tiles whose triangles are those of the frame before
        int uploads_unchanged = 0; ///< tiles and maps already where they are drawn from
        int sky = 0;               ///< 1: the scene has none
    };
    Skipped skipped;

    double cpu_ms = 0.0; ///< uploads and submission, and the selection where the caller adds it
    double gpu_ms = 0.0; ///< from submission until all is drawn; only when asked for
};

} // namespace reljef::view
