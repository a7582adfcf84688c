#include "engine/scene/animators.h"

#include <cmath>

#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::scene {

Animator fly_path_animator(FlyPath path) {
    return [path = std::move(path)](Node& node, double time) {
        if (auto* camera = node.get<Camera>()) {
            const double lap = path.duration();
            const double rest = lap > 0.0 && std::isfinite(time) ? std::fmod(time, lap) : 0.0;
            const FlyKey key = path.at(path.begin() + (rest < 0.0 ? rest + lap : rest));
            camera->eye = key.eye;
            camera->look = key.look;
        }
    };
}

Animator rotation_animator(double degrees_per_second) {
    return [degrees_per_second](Node& node, double time) {
        const glm::dvec3 position(node.parent_from_local()[3]);
        node.set_parent_from_local(glm::rotate(glm::translate(glm::dmat4(1.0), position),
                                               glm::radians(degrees_per_second * time),
                                               glm::dvec3(0.0, 0.0, 1.0)));
    };
}

} // namespace reljef::scene
