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

/// The surface whose samples a frame's hits name, and who looked at it.
struct SurfaceView {
    GridView<const float> heights; ///< metres, not empty; valid as long as the view is used
    const terrain::Placement& placement;
    glm::dmat4 world_from_local{1.0}; ///< of the terrain's node
    scene::Camera camera;             ///< world metres
};

/// Summary of an error's distribution over pixels, in the error's unit.
struct Distribution {
    std::size_t count = 0; ///< pixels it rests on, at least 1
    double median = 0.0;
    double p95 = 0.0;
    double p99 = 0.0;
    double max = 0.0;
    double rms = 0.0;
};

/// One error at every pixel of a frame.
struct PixelErrors {
    Grid<float> map;           ///< NaN where there is none, infinity where it has no bound
    std::size_t unbounded = 0; ///< pixels whose error is infinite; not in the distribution
    std::optional<Distribution> distribution; ///< of the finite errors; absent where none is
};

/// What a technique shows at a pixel, held against the truth.
enum class Verdict : unsigned char {
    no_terrain, ///< and the truth shows none either
    right,      ///< the hit is at most one texel off
    wrong,      ///< the hit is more than one texel off, or the truth shows no terrain there
    hole,       ///< the truth shows terrain, the technique none: counts as wrong too
};

struct GeometricErrors {
    PixelErrors reprojection;   ///< pixels
    PixelErrors hit;            ///< texels
    Grid<Verdict> verdicts;     ///< one a pixel
    std::size_t wrong = 0;      ///< pixels that show a wrong surface, holes among them
    std::size_t holes = 0;      ///< pixels
    double wrong_percent = 0.0; ///< share of all pixels of the frame, sky too
};

/// Whether a pixel shows a place on the heightfield: sky does not, nor does a mesh (col and row
/// −1). A col or row that is not finite is shown all the same, and wrong.
bool shows_terrain(const Hit& hit);

/// How far from the centre of pixel (col, row) of a picture of `size` the place falls that the hit
/// claims to be there: the texel (hit.col, hit.row) at its bilinear height (beyond the border the
/// border's), placed, moved and projected in double precision. In pixels; infinity where the place
/// is behind the eye or anything on the way is not finite. The hit's own height and depth are not
/// looked at. Precondition: shows_terrain(hit).
double reprojection_error(const SurfaceView& view, glm::ivec2 size, glm::ivec2 pixel,
                          const Hit& hit);

/// How far two hits lie apart on the heightfield, texels; infinity where one is not finite.
double hit_error(const Hit& shown, const Hit& true_hit);

/// How the errors of one pixel are given.
struct PixelMeasure {
    /// How far from a pixel's centre the place falls that it shows, pixels.
    std::function<double(glm::ivec2 pixel, const Hit& hit)> reprojection;
    /// How far two places lie apart, texels.
    std::function<double(const Hit& shown, const Hit& true_hit)> hit;
};

/// The errors of a technique's frame, by the definitions that hold for every technique and for
/// polygons: reprojection error over the pixels where the technique shows terrain, whatever the
/// truth shows there; hit error over the pixels where both show terrain; wrong surface, and holes,
/// over all pixels. `threads` 0: as many as the machine has; the result does not depend on it.
/// Fails where the two frames differ in size and where neither shows terrain at any pixel: such a
/// frame has no error, not a small one.
Result<GeometricErrors> geometric_errors(const SurfaceView& view, const HitBuffer& shown,
                                         const HitBuffer& truth, unsigned threads = 0);

/// The same of a surface that is no heightfield. What `measure` gives that is not finite has no
/// bound.
Result<GeometricErrors> geometric_errors(const PixelMeasure& measure, const HitBuffer& shown,
                                         const HitBuffer& truth, unsigned threads = 0);

} // namespace reljef::truth
