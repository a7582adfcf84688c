#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "engine/core/grid.h"
#include "engine/core/hit.h"

namespace reljef::view {

/// A search that may skip thin features, chosen because it seldom does in a view.
struct TypicalChoice {
    std::string technique; ///< as scene::to_string
    double share = 0.0;    ///< of the probed pixels, those within the error bound, 0 to 1

    friend bool operator==(const TypicalChoice&, const TypicalChoice&) = default;
};

/// What `auto` chose in a view.
struct Choice {
    int tiles_as_triangles = 0;
    /// In the view, not counted among the drawn tiles. Hidden ones count where rays are so much
    /// cheaper that none were looked for; so they do for the estimates of triangles.
    int tiles_by_rays = 0;
    double ray_pixels = 0.0; ///< estimated share of the picture, 0 to 1
    double estimated_ms = 0.0;
    double triangles_ms = 0.0;   ///< estimated for triangles alone
    double touched_pixels = 0.0; ///< by edges of triangles, were all triangles; estimated
    std::optional<double> rays_ms =
        {}; ///< estimated for rays alone; absent: no proof of their error
    std::optional<TypicalChoice> typical = {}; ///< of the rays; absent: they are exact

    friend bool operator==(const Choice&, const Choice&) = default;
};

/// Counts and times of one frame.
struct FrameStats {
    int nodes = 0; ///< in the scene, visible or not
    int tiles = 0; ///< terrain tiles drawn
    std::size_t triangles = 0;
    std::size_t slivers = 0; ///< of these, drawn by their corners (view::SliverView)
    int tiles_missing = 0;   ///< streamed tiles that are not loaded; coarser ones are drawn
    int tiles_cut = 0;       ///< tiles with new triangles
    /// Drawn tiles whose error is an estimate, and those that an unproven search shows. Their
    /// pixels, and those of walls beside them, may be farther off than `kept_error`. All tiles of a
    /// terrain whose samples are averages count.
    int tiles_unproven = 0;
    /// No pixel of the other tiles and of meshes is farther off, pixels; absent: there is no error
    /// bound, or no other tile.
    std::optional<double> kept_error;
    /// How far meshes that are drawn with fewer triangles are off at most, pixels; absent: all are
    /// drawn whole.
    std::optional<double> mesh_error;
    /// Whether triangles had larger errors than the bound leaves them, to fit their number, or rays
    /// that miss the bound were drawn instead.
    bool lacks_triangles = false;
    bool exceeded_by_rounding = false; ///< see terrain::ErrorView
    std::optional<Choice> choice;      ///< of `auto`
    int reliefs_as_triangles = 0;      ///< on the ellipsoid, where no rays are precise enough
    std::size_t rays = 0;              ///< cast on the CPU
    int draws = 0;                     ///< draw calls, the sky's included
    int state_changes = 0; ///< programs, vertex arrays, textures, uniform blocks and modes set
    int uploads = 0;       ///< buffers and textures filled
    std::size_t upload_bytes = 0;

    struct Skipped {
        int invisible_nodes = 0; ///< hidden, or below a hidden one
        int nodes_outside_frustum = 0;
        int tiles_outside_frustum = 0;
        int tiles_occluded = 0; ///< behind nearer ground of the same terrain
        std::size_t triangles_outside_frustum = 0;
        std::size_t triangles_under_error = 0; ///< of the samples and meshes, not drawn
        int selections_unchanged = 0;          ///< 1: the last frame's selection was drawn again
        int details_too_small = 0;             ///< terrain tiles too far away for their detail tile
        int cuts_unchanged = 0;                ///< tiles with the triangles of the last frame
        int uploads_unchanged = 0;             ///< tiles and maps that are on the GPU already
        int sky = 0;                           ///< 1: the scene has none
        int point_lights = 0; ///< beyond the maximum, although they reach into the view
    };
    Skipped skipped;

    /// Uploads and submission; with the selection if the caller adds it. In a timed frame of a
    /// software renderer gpu_ms contains the submission, so that cpu_ms + gpu_ms is its time.
    double cpu_ms = 0.0;
    double gpu_ms = 0.0; ///< from submission to the end of drawing; only if measured
};

/// Counts `mesh_error` in `kept_error`, too.
void add_mesh_error(FrameStats& stats);

/// Of two parts of one picture: what was drawn, skipped and spent in both, and the larger kept
/// error. Tiles that both show count twice; what holds for the scene or the whole picture is a's.
FrameStats together(const FrameStats& a, const FrameStats& b);

/// What the colour of a pixel costs.
struct PixelWork {
    std::uint32_t taps = 0;  ///< texels and heights read; of a filtered texture, one tap
    std::uint32_t steps = 0; ///< of searches along rays
    std::uint32_t rays = 0;  ///< that search: from the eye and to the sun

    friend bool operator==(const PixelWork&, const PixelWork&) = default;
};

/// The work of a picture with one sample per pixel. Only terrains count.
struct PictureWork {
    Grid<PixelWork> pixels;
    std::size_t beam_taps = 0; ///< of beams, which pixels share
};

/// Sums over a picture.
struct WorkTotals {
    std::size_t taps = 0; ///< with those of beams
    std::size_t steps = 0;
    std::size_t rays = 0;
};
WorkTotals totals_of(const PictureWork& work);

/// The stats' times are 0.
struct DrawnHits {
    HitBuffer hits;
    FrameStats stats;
};

} // namespace reljef::view
