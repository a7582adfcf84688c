#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/viewer/appearance/appearance_switch.h"
#include "app/viewer/panels/panel_content.h"
#include "engine/scene/technique/technique.h"
#include "engine/session/scene_setup.h"

namespace reljef::app {

/// The technique until the scene's maps are ready: levels by distance, which need no maps. The
/// scene's own technique if no maps are missing.
scene::Technique first_technique(const session::TerrainScene& scene);

/// Chooses the techniques of a scene, or of one of its models, and changes their parameters. A
/// technique that is left keeps its parameters for the next time.
class TechniqueEditor {
public:
    /// The scene and the switch outlive this. `requested`: of the scene when its maps are ready.
    TechniqueEditor(const session::TerrainScene& scene, AppearanceSwitch& changes,
                    const scene::Technique& requested);

    /// Shows a technique on the selected model, or on all. Fails if it cannot draw them.
    Result<void> request(const scene::Technique& technique);
    /// The next technique that draws the selected model, or all.
    void next();
    /// The technique with this number among those of next(), from 0; nothing without it.
    void choose(std::size_t index);

    /// Absent: all models. Precondition: it exists. The choices are those that draw it.
    void select_model(std::optional<std::size_t> model);
    /// The parameter that step_parameter() changes.
    void select_parameter(std::size_t index) { parameter_ = index; }
    /// Another parameter; from the last to the first.
    void select_next_parameter(int steps);
    /// Changes the selected parameter by some steps, see scene::stepped().
    void step_parameter(int steps);

    [[nodiscard]] TechniqueContent content() const;

private:
    [[nodiscard]] const scene::Technique& edited() const;
    void check_choices();
    // By all models that are edited.
    [[nodiscard]] bool is_shown(const scene::Technique& technique) const;
    [[nodiscard]] Result<void> check(const scene::Technique& technique) const;
    [[nodiscard]] std::vector<std::string> option_reasons() const;

    const session::TerrainScene& scene_;
    AppearanceSwitch& switch_;
    std::vector<TechniqueChoice> choices_; // in the catalogue's order
    std::vector<std::size_t> drawing_;     // the choices that draw what is edited
    std::optional<std::size_t> model_;
    std::size_t parameter_ = 0;
};

} // namespace reljef::app
