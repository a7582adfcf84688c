#pragma once

#include <cstdint>
#include <optional>
#include <random>

#include "engine/scene/graph/camera.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::bench {

/// Evenly in [low, high]; the same on every machine, unlike the standard library's distributions.
double between(std::mt19937& random, double low, double high);

/// The generators of random numbers of successive views. That of a view depends on the seed and the
/// number of the view only, so that a long run can be continued.
class ViewGenerators {
public:
    /// `skip`: the views that are left out at the beginning.
    ViewGenerators(std::uint32_t seed, std::int64_t skip) : seed_(seed), skip_(skip) {}

    /// Of the next view; empty: it is left out.
    std::optional<std::mt19937> next();

private:
    std::uint32_t seed_;
    std::int64_t skip_;
    std::int64_t count_ = 0;
};

/// An eye above a terrain on a plane or on the ellipsoid, 1e-5 to 0.4 of its width above the
/// ground: towards another place of the terrain, or in any direction, pitched -90 to 5 degrees.
/// On a plane also from beside the terrain. Every third view has a field of view of 10 to 120
/// degrees.
scene::Camera random_view(std::mt19937& random, const scene::TerrainSurface& surface);

/// An eye 0.3 to 3 m above the ground at a random place, heading anywhere, pitched -30 to 5
/// degrees.
scene::Camera view_near_the_ground(std::mt19937& random, const scene::TerrainSurface& surface);

} // namespace reljef::bench
