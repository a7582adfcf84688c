#pragma once

#include <cstddef>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/core/hit.h"
#include "engine/core/parallel_for.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/streaming/terrain_surface.h"
#include "engine/truth/geometric_error.h"

namespace reljef::bench {

/// Every step-th pixel of a frame in both directions.
struct PixelLattice {
    glm::ivec2 first{0};
    int step = 1;
};

/// What is wrong in a frame with an error bound.
struct FrameErrors {
    std::size_t pixels = 0;     ///< that show terrain
    std::size_t violations = 0; ///< of these, farther off than the frame states
    std::size_t holes = 0;      ///< pixels without terrain, away from silhouettes
    double worst = 0.0;         ///< the largest error, pixels

    void add(const FrameErrors& other);
};

/// Whether a ray in the local frame starts over a terrain on a plane, or is more than `metres`
/// above its border where it enters: beneath the triangles of the border it meets no front face.
bool enters_above(const scene::TerrainSurface& surface, const Ray& ray, double metres = 0.0);

/// Compares hits with the samples of a terrain in memory.
class FrameChecker {
public:
    /// The surface outlives this object.
    FrameChecker(const scene::TerrainSurface& surface, const glm::dmat4& world_from_local,
                 glm::ivec2 size, ParallelOptions parallel);

    /// `stated`: the error of the frame, pixels. Incomplete after a stop.
    [[nodiscard]] FrameErrors check_frame(const scene::Camera& camera, const HitBuffer& hits,
                                          double stated, const PixelLattice& lattice) const;

private:
    void check_pixel(const truth::SurfaceView& view, glm::ivec2 pixel, const Hit& hit,
                     double stated, FrameErrors& errors) const;
    [[nodiscard]] bool is_hole(const scene::Camera& camera, glm::ivec2 pixel, double stated) const;
    [[nodiscard]] Ray local_ray(const scene::Camera& camera, glm::dvec2 place) const;
    [[nodiscard]] bool is_surrounded(const scene::Camera& camera, glm::ivec2 pixel, double reach,
                                     int side) const;
    [[nodiscard]] double distance_to_end(const scene::Camera& camera, glm::ivec2 pixel) const;
    [[nodiscard]] double distance_to_line(const scene::Camera& camera, glm::ivec2 pixel,
                                          glm::dvec3 first, glm::dvec3 last) const;

    const scene::TerrainSurface& surface_;
    glm::dmat4 world_from_local_;
    glm::ivec2 size_;
    ParallelOptions parallel_;
};

} // namespace reljef::bench
