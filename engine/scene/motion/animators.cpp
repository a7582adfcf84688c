#include "engine/scene/motion/animators.h"

#include <cmath>
#include <optional>

#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::scene {

Camera at_key(Camera camera, const Keyframe& key) {
    camera.eye = key.eye;
    camera.target = key.target;
    camera.up = {0.0, 0.0, 1.0};
    return camera;
}

Animator camera_path_animator(CameraPath path) {
    return [path = std::move(path)](Node& node, double time) {
        if (auto* camera = node.get<Camera>()) {
            const double lap = path.duration();
            const double rest = lap > 0.0 && std::isfinite(time) ? std::fmod(time, lap) : 0.0;
            *camera = at_key(*camera, path.at(path.begin() + (rest < 0.0 ? rest + lap : rest)));
        }
    };
}

Animator rotation_animator(double degrees_per_second) {
    return [degrees_per_second, start = std::optional<glm::dmat3>()](Node& node,
                                                                     double time) mutable {
        const glm::dmat4& now = node.parent_from_local();
        if (!start) {
            start = glm::dmat3(now);
        }
        const glm::dmat4 turn = glm::rotate(
            glm::dmat4(1.0), glm::radians(degrees_per_second * time), glm::dvec3(0.0, 0.0, 1.0));
        glm::dmat4 turned = glm::dmat4(*start) * turn;
        turned[3] = now[3];
        node.set_parent_from_local(turned);
    };
}

} // namespace reljef::scene
