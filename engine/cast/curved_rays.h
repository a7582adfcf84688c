#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/cast/beam.h"
#include "engine/cast/earth_map.h"
#include "engine/cast/height_bounds.h"
#include "engine/cast/packet/block_kernel.h"
#include "engine/cast/picture_rays.h"
#include "engine/cast/ray_fan.h"
#include "engine/cast/sample_map.h"
#include "engine/core/geometry.h"
#include "engine/scene/graph/camera.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/placement.h"

namespace reljef::cast {

/// The rays of a block of pixels between two depths, straight in samples.
struct RayPiece {
    PixelBlock block;       ///< of whole beams, or in one
    PictureRays rays;       ///< over the range
    double error = 0.0;     ///< how far these are off at checked places, pixels
    glm::dvec3 metres{1.0}; ///< of a column, a row and a metre of height there, at most
};

/// The rays of a picture over a terrain on the ellipsoid, in samples. They are bent there, so those
/// of a block of pixels are cut into pieces, each so short that its chords have no visible error.
/// Where the rays of a block are not linear in the pixel, they are of second degree, and where that
/// is not enough, the block is divided, down to one ray for all of a pixel.
class CurvedRays {
public:
    struct Terrain {
        terrain::Placement placement;
        glm::dmat4 world_from_local{1.0};
        Box local;   ///< around the surface, metres
        Box samples; ///< the same in samples with even rows (EarthMap), and metres of height
        HeightBounds heights = {};
        bool begins_above = true;   ///< rays that begin over or under the ground begin over it
        geo::WrappedRows rows = {}; ///< of the placement's georeference
    };

    struct Options {
        unsigned threads = 0;      ///< 0: one per hardware thread
        bool middles_only = false; ///< no other rays of the pixels are cast
    };
    /// Preconditions: an invertible transform, a placement on the ellipsoid.
    CurvedRays(const scene::Camera& camera, glm::ivec2 size, const Terrain& terrain,
               const Options& options);

    /// Of all parts of the block, one after the other; of each, front to back. They cover all of
    /// the surface that the block may show.
    [[nodiscard]] std::span<const RayPiece> pieces(const PixelBlock& block) const {
        const glm::ivec2 at = block.first / block_side;
        const int index = at.y * cols_ + at.x;
        return blocks_[static_cast<std::size_t>(index)];
    }
    /// How far the rays are off at the checked places, pixels: their chords, their differences from
    /// rays that are linear in the pixel, and the map.
    [[nodiscard]] double error() const { return error_; }

    /// By which rays of a piece may be moved at a depth, along both axes: error() counts it.
    [[nodiscard]] glm::dvec2 unseen_samples(const RayPiece& piece, double t) const;
    /// Whether linear rays (made_linear) are as good as those of a piece.
    [[nodiscard]] bool is_linear(const RayPiece& piece) const;

    [[nodiscard]] const PictureRays& local() const { return local_; }

private:
    class Pieces;

    void cut(const PixelBlock& block, std::vector<RayPiece>& pieces) const;
    [[nodiscard]] std::optional<glm::dvec3> sample_at(glm::dvec2 pixel, double t) const;
    [[nodiscard]] bool is_unseen(glm::dvec3 found, glm::dvec3 sample, double t) const;
    [[nodiscard]] Interval turns_of(const Box& box) const;
    [[nodiscard]] double track_length(double t) const;
    [[nodiscard]] double tolerance_at(double t) const; // of chords, metres
    [[nodiscard]] double pixel_at(double t) const;     // metres

    PictureRays local_;
    Terrain terrain_;
    bool middles_only_;
    Interval depths_; // of the surface
    EarthMap earth_;
    std::optional<SampleMap> map_;
    bool is_globe_;
    double columns_around_; // the Earth; 0 where columns are no meridians
    glm::dvec2 pixel_{0.0}; // scene::metres_a_pixel()
    double width_ = 0.0;    // of a whole block at the farthest surface, metres
    int cols_;              // of blocks
    std::vector<std::vector<RayPiece>> blocks_;
    double error_ = 0.0;
};

} // namespace reljef::cast
