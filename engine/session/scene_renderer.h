#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"
#include "engine/render/driver.h"
#include "engine/scene/graph/scene.h"
#include "engine/view/select.h"

namespace reljef::session {

struct SceneRendererOptions {
    render::DriverOptions driver;
    view::SelectOptions select = {};
    bool selects_always = false; ///< selects unchanged views again: to measure it
};

/// Draws a scene frame after frame with OpenGL. Selects each view once: a view in which nothing
/// changed since the last selection is drawn from that selection. Holds what the last view shows
/// until another is selected or forget_scene(). Destroy while its context is current.
class SceneRenderer {
public:
    /// Fails when the size is outside what the driver can draw.
    static Result<SceneRenderer> create(const SceneRendererOptions& options = {});

    /// The frame that the scene's camera sees now. Valid until the next call.
    const view::FrameView& select(const scene::Scene& scene);
    /// Draws the frame that was selected last; FrameStats::cpu_ms has its selection. `wait` also
    /// waits until it is finished. Preconditions: the scene is unchanged since its selection.
    Result<view::FrameStats> draw_selected(bool wait = false);
    /// Draws what each pixel shows. Precondition as draw_selected().
    Result<HitBuffer> draw_selected_hits();

    /// Selects and draws.
    Result<view::FrameStats> draw(const scene::Scene& scene, bool wait = false);
    Result<HitBuffer> draw_hits(const scene::Scene& scene);

    /// Lets go of what the last view shows, before another scene is opened.
    void forget_scene();

    /// How many views were selected so far.
    [[nodiscard]] int selections() const { return selections_; }
    /// The last frame drawn. Waits for it.
    [[nodiscard]] Image read_color() const { return driver_.read_color(); }
    /// Copies the last frame to the window's back buffer.
    void show_in_window(glm::ivec2 window_size) const { driver_.show_in_window(window_size); }
    Result<void> resize(glm::ivec2 size) { return driver_.resize(size); }
    [[nodiscard]] glm::ivec2 size() const { return driver_.size(); }

private:
    SceneRenderer(render::Driver driver, const SceneRendererOptions& options)
        : options_(options), driver_(std::move(driver)) {}

    SceneRendererOptions options_;
    render::Driver driver_;
    view::SceneView view_;
    std::optional<view::FrameView> frame_;
    bool was_drawn_ = false; // the selected frame
    double select_ms_ = 0.0; // of the last call of select()
    int selections_ = 0;
};

} // namespace reljef::session
