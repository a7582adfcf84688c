#pragma once

#include <optional>
#include <string>

#include <glm/vec2.hpp>

#include "engine/session/log.h"
#include "engine/session/scene_setup.h"

namespace reljef::app {

/// Says when the contours of a view at rest are too close to each other to be drawn.
class ContourWatch {
public:
    /// The scene outlives this.
    explicit ContourWatch(const session::TerrainScene& scene) : scene_(scene) {}

    /// Looks at a view of `size` pixels once it is as it was at the last call. Notes a faded
    /// interval once. Returns whether the sentence changed.
    bool update(glm::ivec2 size, bool is_moving, session::Log& log);
    /// On the last view at rest; empty: contours show, or there are none.
    [[nodiscard]] const std::string& sentence() const { return sentence_; }

private:
    struct Seen {
        scene::Camera camera;
        glm::ivec2 size{0};
        double interval = 0.0;
        std::shared_ptr<const scene::TerrainSurface> surface;
        scene::Material material;

        friend bool operator==(const Seen&, const Seen&) = default;
    };

    const session::TerrainScene& scene_;
    std::optional<Seen> last_; // at the last call
    std::optional<Seen> seen_; // that the sentence is on
    std::string sentence_;
    double noted_ = 0.0; // interval, metres
};

} // namespace reljef::app
