#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include <glm/mat4x4.hpp>

#include "engine/core/grid.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"
#include "engine/scene/graph/camera.h"
#include "engine/terrain/field/placement.h"

namespace reljef::truth {

/// The surface that a frame's hits refer to, and the camera.
struct SurfaceView {
    GridView<const float> heights; ///< metres, not empty; must outlive the view
    const terrain::Placement& placement;
    glm::dmat4 world_from_local{1.0}; ///< of the terrain's node
    scene::Camera camera;             ///< world metres
};

/// Distribution of an error over pixels, in the error's unit.
struct Distribution {
    std::size_t count = 0; ///< pixels, >= 1
    double median = 0.0;
    double p95 = 0.0;
    double p99 = 0.0;
    double max = 0.0;
    double rms = 0.0;
};

struct PixelErrors {
    Grid<float> map;           ///< NaN: no error; infinity: unbounded error
    std::size_t unbounded = 0; ///< pixels with an infinite error; not in the distribution
    std::optional<Distribution> distribution; ///< of the finite errors; absent without any
};

/// Two hits at most so far apart show one place, texels.
inline constexpr double max_texels_off = 1.0;

/// A pixel of a technique compared with the truth.
enum class Verdict : unsigned char {
    no_terrain, ///< neither shows terrain
    right,      ///< the hits are at most one texel apart
    wrong,      ///< the hits are more than one texel apart, or only the technique shows terrain
    hole,       ///< only the truth shows terrain; also counts as wrong
};

struct GeometricErrors {
    PixelErrors reprojection; ///< pixels
    PixelErrors hit;          ///< texels; of a globe, those in the terrain's middle
    Grid<Verdict> verdicts;
    std::size_t wrong = 0; ///< pixels, including holes
    std::size_t holes = 0;
    double wrong_percent = 0.0;            ///< of all pixels of the frame, including sky
    double wrong_of_terrain_percent = 0.0; ///< of the pixels where either shows terrain
};

/// Whether a pixel shows the heightfield. Sky and meshes (col and row −1) do not. A hit with a col
/// or row that is not finite counts as terrain.
bool shows_terrain(const Hit& hit);

/// Whether any pixel shows the heightfield.
bool has_terrain(const HitBuffer& hits);

/// Distance in pixels between the pixel's centre and the projection of its hit: the texel
/// (hit.col, hit.row) at its bilinear height (clamped at the border). Infinity behind the eye and
/// for values that are not finite. Ignores the hit's height and depth. Precondition:
/// shows_terrain(hit).
double reprojection_error(const SurfaceView& view, glm::ivec2 size, glm::ivec2 pixel,
                          const Hit& hit);

/// Distance in pixels between the pixel's centre and the projection of a place; infinity behind the
/// eye.
double distance_to_pixel(const scene::Camera& camera, glm::ivec2 size, glm::ivec2 pixel,
                         glm::dvec3 world);

/// Distance of two hits on the heightfield, texels; infinity if one is not finite.
double hit_error(const Hit& shown, const Hit& true_hit);

/// The error functions of one pixel. Values that are not finite count as unbounded.
struct PixelMeasure {
    /// Pixels; empty for a hit that has no such error.
    std::function<std::optional<double>(glm::ivec2 pixel, const Hit& hit)> reprojection;
    std::function<double(const Hit& shown, const Hit& true_hit)> hit; ///< texels
};

/// The errors of a frame: reprojection error over the pixels where the technique shows terrain; hit
/// error over the pixels where both show terrain; wrong surfaces and holes over all pixels.
/// `threads` 0: as many as the machine has; no influence on the result. Fails when the frames
/// differ in size or neither shows any terrain.
Result<GeometricErrors> geometric_errors(const SurfaceView& view, const HitBuffer& shown,
                                         const HitBuffer& truth, unsigned threads = 0);

/// The same for any surface.
Result<GeometricErrors> geometric_errors(const PixelMeasure& measure, const HitBuffer& shown,
                                         const HitBuffer& truth, unsigned threads = 0);

} // namespace reljef::truth
