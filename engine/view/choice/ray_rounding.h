#pragma once

#include <memory>
#include <optional>
#include <span>
#include <unordered_map>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/scene/graph/camera.h"
#include "engine/view/draw_list.h"

namespace reljef::view {

/// How heights change from sample to sample, at most; exaggerated.
struct Slopes {
    double steepness = 0.0; ///< metres of height per metre along the ground
    double rise = 0.0;      ///< metres of height between neighbours, of both axes together
};
Slopes slopes_of(const scene::TerrainSurface& surface);
inline double steepest(const scene::TerrainSurface& surface) {
    return slopes_of(surface).steepness;
}

/// Whose floats follow rays. On the CPU they count from the place of the first possible hit.
enum class RayFloats { opengl, cpu };

/// Bounds what floats round of the hits of exact rays over a plane.
class RayRounding {
public:
    /// `bounds`: of the surface; `eye` in the same coordinates, metres.
    RayRounding(const scene::Camera& camera, glm::ivec2 size, const Box& bounds, glm::dvec3 eye,
                RayFloats floats);

    /// A part of the surface, metres.
    struct Part {
        double distance = 0.0; ///< from the eye, at least
        Slopes slopes;
        double cell = 0.0; ///< the longer side of its cells
    };
    /// The largest error of a hit on the part, pixels.
    [[nodiscard]] double at(const Part& part) const;
    /// The part that does not depend on the distance, pixels.
    [[nodiscard]] double from_afar(double steepness) const;
    /// The distance from which on no hit on such a part has a larger error; empty: there is none.
    /// Preconditions: perspective, OpenGL.
    [[nodiscard]] std::optional<double> distance_for(double error, const Part& part) const;

    /// For a surface whose node scales it: metres of the world a local metre, and local metres a
    /// metre of the world, at most.
    void stretch(double world_metres, double local_metres);

private:
    [[nodiscard]] double along_ray(double steepness) const;
    [[nodiscard]] double lengths(const Part& part) const; // that are rounded, metres

    bool by_shader_;
    double rounding_ = 0.0;    // of a direction, pixels
    double lengths_ = 0.0;     // of all parts, metres
    double share_ = 0.0;       // of the operations, those along the ray
    double per_metre_ = 0.0;   // without perspective: pixels
    double longest_ray_ = 0.0; // whose place is rounded, metres
    double depth_ = 0.0;       // without perspective: of a ray, metres
};

/// Bounds the rounding of the rays in a picture. Remembers the slopes of the last surface and of
/// tiles.
class PictureRounding {
public:
    struct Found {
        double error = 0.0;      ///< pixels
        bool is_of_view = false; ///< most of it comes with the angle of a pixel, however near
    };
    /// At most, of what the list's camera sees of a terrain's tiles, the bends of rays on
    /// OpenGL included. Infinite if the surface may be at the eye.
    Found of(const DrawList& list, const TerrainDraw& draw,
             std::span<const std::shared_ptr<const scene::TerrainTile>> tiles, RayFloats floats);

    Slopes slopes_over(const std::shared_ptr<const scene::TerrainSurface>& surface);

private:
    struct KnownTile {
        std::weak_ptr<const scene::TerrainTile> tile;
        Slopes slopes;
    };

    RayRounding::Part part_of(const scene::TerrainNode& terrain, const scene::TerrainTile& tile,
                              glm::dvec3 eye);

    // Remembered while the tile lives.
    Slopes slopes_in_tile(const scene::TerrainNode& terrain,
                          const std::shared_ptr<const scene::TerrainTile>& tile);

    std::weak_ptr<const scene::TerrainSurface> surface_;
    Slopes slopes_;
    std::unordered_map<const scene::TerrainTile*, KnownTile> tile_slopes_;
};

} // namespace reljef::view
