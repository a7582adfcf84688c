#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/scene/technique/technique.h"
#include "engine/session/background.h"
#include "engine/session/log.h"
#include "engine/session/prepared_maps.h"

namespace reljef::app {

struct AppearanceSwitchOptions {
    int threads = 0;           ///< 0: as many as the machine has
    int largest_side = 16'384; ///< of maps, texels; SceneRenderer::max_texture_side()
};

/// Changes the technique and the light of a scene. Maps that take long to make are made in the
/// background; until they are there the scene looks as it does.
class AppearanceSwitch {
public:
    /// The scene outlives this.
    explicit AppearanceSwitch(session::TerrainScene& scene,
                              const AppearanceSwitchOptions& options = {});
    AppearanceSwitch(const AppearanceSwitch&) = delete;
    AppearanceSwitch& operator=(const AppearanceSwitch&) = delete;
    ~AppearanceSwitch();

    /// Shows the technique now, or as soon as its maps are there. Replaces an earlier request of a
    /// technique.
    void request(const scene::Technique& technique);
    /// The same for the light.
    void request(const scene::Light& light);
    /// Shows what was requested if its maps are there. Whether the scene changed.
    bool update();
    /// Goes back to the techniques before the last change, as the new one cannot be drawn. False if
    /// there is no way back.
    bool undo();

    /// The technique that is requested, else the one that is shown.
    [[nodiscard]] const scene::Technique& technique() const;
    /// The light that is requested, else the one that is shown.
    [[nodiscard]] const scene::Light& light() const;
    [[nodiscard]] bool is_preparing() const { return pending_ != nullptr; }
    /// The task under way; an empty label if there is none.
    [[nodiscard]] session::RelayedLog::TaskProgress progress() const;
    /// Hands on what was reported since the last call.
    void relay_to(session::Log& log);
    /// The scene's light, if it was made since the last call, for SceneRenderer::add_light(); else
    /// null.
    std::shared_ptr<const render::PreparedLight> take_light();

private:
    struct Appearance {
        std::optional<scene::Technique> technique; // absent: the materials keep theirs
        scene::Light light;
    };
    struct Pending {
        Appearance appearance;
        session::RelayedLog log;
        std::optional<session::Background<session::PreparedMaps>> work; // uses the log
    };

    [[nodiscard]] session::MissingMaps missing(const Appearance& appearance) const;
    void begin(const Appearance& appearance);
    void show(const Appearance& appearance);
    void retire();

    session::TerrainScene& scene_;
    AppearanceSwitchOptions options_;
    session::RelayedLog log_; // of work that is done
    std::shared_ptr<const render::PreparedLight> light_;
    std::vector<scene::Technique> before_; // of the materials, before the last change
    std::unique_ptr<Pending> pending_;
    std::vector<std::unique_ptr<Pending>> retired_; // asked to stop, not waited for
};

} // namespace reljef::app
