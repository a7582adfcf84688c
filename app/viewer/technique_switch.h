#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/technique/technique.h"
#include "engine/session/background.h"
#include "engine/session/log.h"
#include "engine/session/prepared_maps.h"

namespace reljef::app {

/// Changes the technique of a scene. Maps that take long to make are made in the background; until
/// they are there the scene keeps the technique it has.
class TechniqueSwitch {
public:
    /// The scene outlives this. `threads` 0: as many as the machine has.
    explicit TechniqueSwitch(session::TerrainScene& scene, int threads = 0);

    /// Shows the technique now, or as soon as its maps are there. Replaces an earlier request.
    void request(const scene::Technique& technique);
    /// Shows a requested technique whose maps are there. Whether the scene changed.
    bool update();

    /// The technique that is requested, else the one that is shown.
    [[nodiscard]] const scene::Technique& target() const;
    [[nodiscard]] bool is_preparing() const { return pending_ != nullptr; }
    /// What is being prepared, and how far it is; an empty label where nothing is.
    [[nodiscard]] session::RelayedLog::Progress progress() const;
    /// Hands on what was reported since the last call.
    void relay_to(session::Log& log);

private:
    struct Pending {
        scene::Technique technique;
        session::RelayedLog log;
        std::optional<session::Background<Result<session::PreparedMaps>>> work; // uses the log
    };

    void show(const scene::Technique& technique);
    void retire();

    session::TerrainScene& scene_;
    int threads_;
    std::unique_ptr<Pending> pending_;
    std::vector<std::unique_ptr<Pending>> retired_; // asked to stop, not waited for
    std::vector<std::string> failures_;
};

} // namespace reljef::app
