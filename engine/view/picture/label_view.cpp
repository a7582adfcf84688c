#include "engine/view/picture/label_view.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::view {

LabelView::LabelView(const scene::Camera& camera, glm::ivec2 size)
    : camera_(camera), axes_(scene::view_axes(camera)), size_(size),
      is_perspective_(camera.projection == scene::ProjectionKind::perspective),
      half_height_(is_perspective_ ? std::tan(0.5 * glm::radians(camera.vertical_fov))
                                   : 0.5 * camera.view_height) {}

scene::Projected LabelView::project(glm::dvec3 world) const {
    const glm::dvec3 relative = world - camera_.eye;
    const double depth = glm::dot(relative, axes_.forward);
    const double width = pixel_width(depth);
    const double pixels_per_metre = width != 0.0 ? 1.0 / width : 0.0;
    return {0.5 * size_ + pixels_per_metre * glm::dvec2(glm::dot(relative, axes_.right),
                                                        -glm::dot(relative, axes_.up)),
            depth};
}

double LabelView::pixel_width(double depth) const {
    const double half = is_perspective_ ? depth * half_height_ : half_height_;
    return 2.0 * half / size_.y;
}

LabelView::Sight LabelView::sight_from(glm::dvec3 world) const {
    return is_perspective_
               ? Sight{{world, camera_.eye - world}, {0.0, 1.0}}
               : Sight{{world, -axes_.forward}, {0.0, std::numeric_limits<double>::infinity()}};
}

} // namespace reljef::view
