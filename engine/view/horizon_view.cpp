#include "engine/view/horizon_view.h"

#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::view {
namespace {

// Whether angles are the same on both sides.
bool is_rigid(const glm::dmat4& transform) {
    constexpr double rounding = 0x1p-40;
    const glm::dmat3 axes(transform);
    const glm::dmat3 product = glm::transpose(axes) * axes;
    double most = 0.0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            most = std::max(most, std::abs(product[i][j] - (i == j ? 1.0 : 0.0)));
        }
    }
    return most <= rounding;
}

} // namespace

std::optional<terrain::HorizonView> horizon_view(const scene::Camera& camera, glm::ivec2 size,
                                                 const glm::dmat4& world_from_local, double error) {
    if (camera.projection != scene::ProjectionKind::perspective || !is_rigid(world_from_local)) {
        return std::nullopt;
    }
    // A radian is seen as so many pixels at least, in the picture's middle.
    const double half_height = std::tan(0.5 * glm::radians(camera.vertical_fov));
    const double focal = 0.5 * size.y / half_height;
    const double half_width = half_height * size.x / size.y;
    constexpr double rasterized = 1.0; // pixels that a pixel's ray and its corners lie apart
    terrain::HorizonView view;
    view.eye = glm::dvec3(glm::inverse(world_from_local) * glm::dvec4(camera.eye, 1.0));
    view.near = camera.near * std::sqrt(1.0 + half_height * half_height + half_width * half_width);
    view.margin = (error + rasterized) / focal;
    return view;
}

} // namespace reljef::view
