#pragma once

#include <optional>
#include <vector>

#include "app/viewer/appearance/background.h"
#include "engine/session/log.h"
#include "engine/session/objects/object_levels.h"
#include "engine/session/scene_setup.h"

namespace reljef::app {

/// Makes the levels of detail of objects in the background, once the ground has an error bound, and
/// shows them. Objects have all triangles meanwhile. The destructor stops.
class LevelSwitch {
public:
    /// The scene outlives this.
    explicit LevelSwitch(session::TerrainScene& scene) : scene_(scene) {}

    /// The next step. Returns whether the scene changed.
    bool update();
    /// The current task; its label is empty if there is none.
    [[nodiscard]] session::RelayedLog::TaskProgress progress() const { return log_.progress(); }
    /// Passes on messages since the last call.
    void relay_to(session::Log& log) { log_.relay_to(log); }

private:
    using Levels = std::vector<session::MadeLevels>;

    session::TerrainScene& scene_;
    session::RelayedLog log_;
    bool has_failed_ = false;
    std::optional<Background<Levels>> making_; // uses the log
};

} // namespace reljef::app
