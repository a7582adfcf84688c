#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "app/viewer/appearance/appearance_switch.h"
#include "app/viewer/appearance/background.h"
#include "app/viewer/comparing/truth_search.h"
#include "app/viewer/panels/panel_content.h"
#include "engine/core/color.h"
#include "engine/core/event.h"
#include "engine/core/result.h"
#include "engine/scene/technique/technique.h"
#include "engine/session/scene_setup.h"

namespace reljef::app {

/// What the right part of the window shows beside the technique on the left: the truth, its errors,
/// or another technique. Finds the truth of a view at rest in the background.
class Comparison {
public:
    /// The scene outlives this.
    explicit Comparison(session::TerrainScene& scene, const AppearanceSwitchOptions& options = {});
    ~Comparison();
    Comparison(const Comparison&) = delete;
    Comparison& operator=(const Comparison&) = delete;

    /// Fails where there is no truth: in scenes of models.
    Result<void> set(CompareWith with);
    /// Between nothing and what was compared last, at first the truth.
    Result<void> toggle() { return set(is_on() ? CompareWith::nothing : last_); }
    /// The truth, its errors, another technique, the truth, …
    Result<void> next();
    [[nodiscard]] CompareWith with() const { return with_; }
    [[nodiscard]] bool is_on() const { return with_ != CompareWith::nothing; }

    /// The technique on the right. Its maps are made in the background. Fails if it cannot draw the
    /// scene.
    Result<void> choose(const scene::Technique& technique);
    /// The next technique of the catalogue that draws the scene, with the parameters that it had.
    void choose_next();
    [[nodiscard]] const scene::Technique& technique() const { return technique_; }
    /// Whether a frame of that technique can be drawn.
    [[nodiscard]] bool draws_technique() const {
        return with_ == CompareWith::technique && preparing_ == nullptr;
    }

    /// As --compare of render names it; empty: nothing.
    [[nodiscard]] std::string option() const;

    /// The line between the pictures, a share of the width in [0, 1].
    [[nodiscard]] double share() const { return share_; }
    void set_share(double share);
    void move_line(int steps);
    /// A drag of the line. Returns whether it used the event. `size` of the window, pixels.
    bool receive(const Event& event, glm::ivec2 size);

    /// The view changed: its truth is not known.
    void forget_view();
    /// Whether find_errors() would find something new.
    [[nodiscard]] bool awaits_view() const { return is_on() && !asked_ && obstacle_.empty(); }
    /// Begins to find the truth of a view, and the errors of its frames.
    void find_errors(ComparedView view);
    /// Takes finished work. Returns whether a picture or figure is new.
    bool update();
    /// Whether work is done in the background.
    [[nodiscard]] bool is_busy() const { return truth_.is_busy() || preparing_ != nullptr; }
    /// Whether another technique needs new frames since the last call.
    bool take_redraw() { return std::exchange(redraw_, false); }
    /// The truth or the errors; null: not known yet, or not shown.
    [[nodiscard]] const Image* right() const;
    void relay_to(session::Log& log);
    /// The light for the technique on the right, once.
    std::shared_ptr<const view::PreparedLight> take_light() {
        return std::exchange(light_, nullptr);
    }

    /// Without the frame times of techniques.
    [[nodiscard]] CompareContent content(const scene::Technique& left) const;

private:
    struct Preparing {
        session::RelayedLog log;
        std::optional<Background<session::PreparedMaps>> maps; // uses the log
    };
    void prepare_technique();
    bool update_technique();
    [[nodiscard]] std::string state() const;

    session::TerrainScene& scene_;
    AppearanceSwitchOptions options_;
    session::RelayedLog log_;
    CompareWith with_ = CompareWith::nothing;
    CompareWith last_ = CompareWith::truth;
    std::string obstacle_;                     // why there is no truth; empty: there is one
    std::vector<scene::Technique> techniques_; // that draw the scene
    scene::Technique technique_;
    double share_ = 0.5;
    bool is_dragged_ = false;
    bool is_new_ = false; // something, since update()
    bool redraw_ = false;
    bool asked_ = false; // for the truth of the view
    TruthSearch truth_;
    std::shared_ptr<const view::PreparedLight> light_;
    std::unique_ptr<Preparing> preparing_;
    std::vector<std::unique_ptr<Preparing>> retired_maps_; // stopping
};

} // namespace reljef::app
