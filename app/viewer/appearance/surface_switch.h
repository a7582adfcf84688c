#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "app/viewer/appearance/background.h"
#include "engine/core/color.h"
#include "engine/session/log.h"
#include "engine/session/prepared_maps.h"
#include "engine/session/scene_setup.h"
#include "engine/session/streaming.h"
#include "engine/terrain/field/color_ramp.h"

namespace reljef::app {

/// Changes the vertical exaggeration of a terrain, its colours by height, and how fine it is in
/// memory. The surface and its maps are made in the background, and the tiles of the view are read
/// anew if it is streamed; the scene changes when they are ready.
class SurfaceSwitch {
public:
    /// The scene outlives this. `largest_side`: as in AppearanceSwitchOptions.
    SurfaceSwitch(session::TerrainScene& scene, int threads, int largest_side)
        : scene_(scene), threads_(threads), largest_side_(largest_side) {}

    /// Why nothing can change; empty: all can.
    [[nodiscard]] std::string obstacle() const;
    /// Shows a factor after the one that is being prepared. Precondition: no obstacle; the factor
    /// is in (0, terrain::max_exaggeration].
    void request(double factor) {
        next_ = now();
        next_->factor = factor;
    }
    /// The same with other colours. `imagery_share`: scene::TerrainOptions.
    void request(terrain::ColorRamp ramp, double imagery_share) {
        next_ = now();
        next_->ramp = std::move(ramp);
        next_->imagery_share = imagery_share;
    }
    /// The same with colours over all others: scene::TerrainOptions::overlay.
    void request(std::shared_ptr<const Image> overlay) {
        next_ = now();
        next_->overlay = std::move(overlay);
    }
    /// The same with finer samples of the same ground.
    void request(std::shared_ptr<const terrain::Terrain> finer) {
        next_ = now();
        next_->finer = std::move(finer);
    }
    /// Begins and ends the work, for a picture of `size` pixels of a scene with this technique and
    /// light. Returns whether the scene changed.
    bool update(const scene::Technique& technique, const scene::Light& light, glm::ivec2 size);

    /// The requested factor, else the current one.
    [[nodiscard]] double factor() const;
    /// The requested colours, else the current ones.
    [[nodiscard]] const terrain::ColorRamp& ramp() const;
    [[nodiscard]] double imagery_share() const;
    [[nodiscard]] std::shared_ptr<const Image> overlay() const { return now().overlay; }
    [[nodiscard]] bool is_preparing() const { return is_working() || next_.has_value(); }
    /// The current task; its label is empty if there is none.
    [[nodiscard]] session::RelayedLog::TaskProgress progress() const { return log_.progress(); }
    void relay_to(session::Log& log) { log_.relay_to(log); }
    /// The light for SceneRenderer::add_light() if it is new since the last call, else null.
    std::shared_ptr<const view::PreparedLight> take_light() {
        return std::exchange(light_, nullptr);
    }

private:
    struct Shape {
        double factor = 1.0;
        terrain::ColorRamp ramp;
        double imagery_share = 1.0;
        std::shared_ptr<const Image> overlay;
        std::shared_ptr<const terrain::Terrain> finer; // null: the terrain that is shown
    };
    struct Made {
        session::StreamedSurface shown;                       // without a stream: in memory
        std::shared_ptr<const session::TerrainSource> source; // of the stream
        session::PreparedMaps maps;
    };
    [[nodiscard]] bool is_working() const { return work_.has_value() || made_.has_value(); }
    // Whether the shown terrain has the same heights.
    [[nodiscard]] bool has_ground(const Shape& shape) const;
    // The shown terrain with the maps that stay right.
    [[nodiscard]] scene::TerrainNode kept_for(const Shape& shape) const;
    void begin(Shape shape, const scene::Technique& technique, const scene::Light& light);
    void end();
    [[nodiscard]] bool is_outdated() const;
    [[nodiscard]] bool is_loaded(glm::ivec2 size) const;
    [[nodiscard]] const scene::TerrainSurface& surface() const {
        return *scene_.terrain->get<scene::TerrainNode>()->surface;
    }
    // What was requested last, else what is shown. With the finer terrain if it is not shown yet.
    [[nodiscard]] Shape now() const;
    void show();

    session::TerrainScene& scene_;
    int threads_;
    int largest_side_;
    std::optional<Shape> next_;
    Shape preparing_; // of the work
    session::RelayedLog log_;
    std::shared_ptr<const view::PreparedLight> light_;
    std::optional<Background<Made>> work_; // uses the log
    std::optional<Made> made_;             // its tiles are read
};

} // namespace reljef::app
