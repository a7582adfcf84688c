#pragma once

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
    const view::FrameView& select(const scene::Scene& scene) {
        return selector_.select(scene, size());
    }
    /// Draws the frame that was selected last; `wait` also waits until it is
    /// finished. Preconditions: the scene is unchanged since its selection.
    Result<view::FrameStats> draw_selected(bool wait = false);
    /// Draws what each pixel shows. Precondition as draw_selected().
    Result<HitBuffer> draw_selected_hits();

    /// Selects and draws; FrameStats::cpu_ms has the selection, too.
    Result<view::FrameStats> draw(const scene::Scene& scene, bool wait = false);
    Result<HitBuffer> draw_hits(const scene::Scene& scene);

    /// Lets go of what the last view shows, before another scene is opened.
    void forget_scene() { selector_.forget(); }

    /// What select() selects with.
    [[nodiscard]] view::FrameSelector& selector() { return selector_; }
    /// The last frame drawn. Waits for it.
    [[nodiscard]] Image read_color() const { return driver_.read_color(); }
    /// Copies the last frame to the window's back buffer.
    void show_in_window(glm::ivec2 window_size) const { driver_.show_in_window(window_size); }
    /// Takes the light of a terrain that the next frame shows, so that drawing need not make it.
    Result<void> add_light(const render::PreparedLight& light) { return driver_.add_light(light); }
    [[nodiscard]] int max_texture_side() const { return driver_.max_texture_side(); }
    Result<void> resize(glm::ivec2 size) { return driver_.resize(size); }
    /// For the frames to come, as render::DriverOptions::samples.
    void set_samples(int samples) { driver_.set_samples(samples); }
    [[nodiscard]] glm::ivec2 size() const { return driver_.size(); }

private:
    SceneRenderer(render::Driver driver, const SceneRendererOptions& options)
        : driver_(std::move(driver)), selector_(options.select, options.selects_always) {}

    render::Driver driver_;
    view::FrameSelector selector_;
    int drawn_ = 0; // the selection that was drawn last, counted from 1
};

} // namespace reljef::session
