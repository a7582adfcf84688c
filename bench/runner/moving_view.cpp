#include "bench/runner/moving_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reljef::bench {
namespace {

constexpr double frames_over_the_width = 20.0 * 25.0;
constexpr int steps_to_a_side = MovingView::half_period / 2;

// 0, 1, ..., 10, 9, ..., -10, -9, ..., 0 and so on.
int steps_of(int frame) {
    const int in_period = (frame + steps_to_a_side) % (4 * steps_to_a_side);
    return steps_to_a_side - std::abs(in_period - 2 * steps_to_a_side);
}

} // namespace

MovingView::MovingView(const scene::Camera& camera, const Box& bounds, GroundHeight ground)
    : camera_(camera), ground_(std::move(ground)),
      clearance_(camera.eye.z - ground_(camera.eye.x, camera.eye.y)) {
    const glm::dvec3 size = bounds.size();
    step_ = std::max(size.x, size.y) / frames_over_the_width * scene::view_axes(camera).right;
}

scene::Camera MovingView::at(int frame) const {
    scene::Camera moved = camera_;
    glm::dvec3 way = static_cast<double>(steps_of(frame)) * step_;
    const glm::dvec3 beside = camera_.eye + way;
    way.z += std::max(ground_(beside.x, beside.y) + clearance_ - beside.z, 0.0);
    moved.eye += way;
    moved.target += way;
    return moved;
}

} // namespace reljef::bench
