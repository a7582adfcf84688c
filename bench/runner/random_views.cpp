#include "bench/runner/random_views.h"

#include <cmath>

namespace reljef::bench {
namespace {

constexpr double beyond = 0.2;     // of the width, beside the terrain
constexpr double min_above = 0.02; // of the width, × e^-1 … e^3
constexpr double usual_fov = 57.3; // degrees

// The same numbers from every standard library, unlike its distributions.
double between(std::mt19937& random, double low, double high) {
    return low +
           (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
}

} // namespace

scene::Camera random_view(std::mt19937& random, const scene::TerrainSurface& surface, double near) {
    const Box& bounds = surface.bounds();
    const glm::dvec3 size = bounds.size();
    scene::Camera camera;
    const double x =
        between(random, bounds.low.x - beyond * size.x, bounds.high.x + beyond * size.x);
    const double y =
        between(random, bounds.low.y - beyond * size.y, bounds.high.y + beyond * size.y);
    const double above = min_above * size.x * std::exp(between(random, -1.0, 3.0));
    camera.eye = {x, y, surface.height_at(x, y).value_or(bounds.high.z) + above};
    camera.target.x = between(random, bounds.low.x, bounds.high.x);
    camera.target.y = between(random, bounds.low.y, bounds.high.y);
    camera.target.z = bounds.center().z;
    const double chosen_fov = between(random, 10.0, 120.0);
    camera.vertical_fov = between(random, 0.0, 3.0) < 1.0 ? chosen_fov : usual_fov;
    camera.near = near;
    return camera;
}

} // namespace reljef::bench
