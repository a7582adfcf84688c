#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "app/viewer/appearance/background.h"
#include "engine/scene/technique/technique.h"
#include "engine/session/log.h"
#include "engine/session/prepared_maps.h"

namespace reljef::app {

struct AppearanceSwitchOptions {
    int threads = 0;           ///< 0: as many as the machine has
    int largest_side = 16'384; ///< of maps, texels, see SceneRenderer::max_texture_side()
};

/// Changes the technique and the light of a scene. Slow maps are made in the background; the scene
/// changes when they are ready.
class AppearanceSwitch {
public:
    /// The scene outlives this.
    explicit AppearanceSwitch(session::TerrainScene& scene,
                              const AppearanceSwitchOptions& options = {});
    ~AppearanceSwitch();

    /// Shows the technique when its maps are ready. Replaces an earlier request.
    /// `model`: only this one; absent: all.
    void request(const scene::Technique& technique,
                 std::optional<std::size_t> model = std::nullopt);
    /// The same with one for each material of the scene.
    void request(std::vector<scene::Technique> techniques) {
        begin({std::move(techniques), light()});
    }
    void request(const scene::Light& light);
    /// Shows the light after what is being prepared. Replaces an earlier one that has not begun, so
    /// that a light that moves does not restart its work with each move.
    void follow(const scene::Light& light);
    /// Shows the request if its maps are ready. Returns whether the scene changed.
    bool update();
    /// Restores the techniques before the last change, for a technique that cannot be drawn. False
    /// if there is none.
    bool undo();

    /// The requested technique, else the current one; of the first model if there are several.
    [[nodiscard]] const scene::Technique& technique() const;
    /// The requested light, else the current one.
    [[nodiscard]] const scene::Light& light() const;
    [[nodiscard]] bool is_preparing() const { return pending_ != nullptr; }
    /// The current task; its label is empty if there is none.
    [[nodiscard]] session::RelayedLog::TaskProgress progress() const;
    /// Passes on messages since the last call.
    void relay_to(session::Log& log);
    /// The light for SceneRenderer::add_light() if it is new since the last call, else null.
    std::shared_ptr<const view::PreparedLight> take_light() {
        return std::exchange(light_, nullptr);
    }

private:
    struct Appearance {
        std::vector<scene::Technique> techniques; // of the materials; empty: unchanged
        scene::Light light;
    };
    struct Pending {
        Appearance appearance;
        session::RelayedLog log;
        std::optional<Background<session::PreparedMaps>> work; // uses the log
    };

    [[nodiscard]] session::MissingMaps missing(const Appearance& appearance) const;
    void begin(const Appearance& appearance);
    void show(const Appearance& appearance);
    void retire();

    session::TerrainScene& scene_;
    AppearanceSwitchOptions options_;
    session::RelayedLog log_; // of finished work
    std::shared_ptr<const view::PreparedLight> light_;
    std::optional<scene::Light> next_light_;
    std::vector<scene::Technique> before_; // of the materials, before the last change
    std::unique_ptr<Pending> pending_;
    std::vector<std::unique_ptr<Pending>> retired_; // stopping
};

} // namespace reljef::app
