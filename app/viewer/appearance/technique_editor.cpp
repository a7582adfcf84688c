#include "app/viewer/appearance/technique_editor.h"

#include <algorithm>

#include "engine/session/prepared_maps.h"

namespace reljef::app {
namespace {

constexpr int digits = 9;        // 1 to 9
constexpr int coarse_levels = 5; // until the maps of a technique are ready

// An option that is on, to ask whether a technique takes it.
scene::Technique with_option(const scene::Technique& technique, const scene::OptionInfo& option) {
    scene::Technique with = technique;
    if (!option.chosen(with.options)) {
        option.choose(with.options, option.words.empty() ? 0 : option.words.size() - 1);
    }
    return with;
}

scene::Technique usual_technique(scene::TechniqueId id) {
    return id == scene::TechniqueId::polygons ? session::technique_of({})
                                              : scene::make_technique(id);
}

} // namespace

scene::Technique first_technique(const session::TerrainScene& scene) {
    const std::vector<scene::Material*> materials = scene.materials();
    const scene::Technique own = materials.front()->technique;
    const bool is_one =
        std::all_of(materials.begin(), materials.end(),
                    [&](const scene::Material* material) { return material->technique == own; });
    return is_one && !session::missing_maps(scene).empty()
               ? scene::Technique{scene::Polygons{.max_levels = coarse_levels}}
               : own;
}

TechniqueEditor::TechniqueEditor(const session::TerrainScene& scene, AppearanceSwitch& changes,
                                 const scene::Technique& requested)
    : scene_(scene), switch_(changes) {
    for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
        choices_.push_back({info.id == requested.id() ? requested : usual_technique(info.id), {}});
    }
    check_choices();
}

void TechniqueEditor::select_model(std::optional<std::size_t> model) {
    model_ = model;
    check_choices();
}

void TechniqueEditor::check_choices() {
    drawing_.clear();
    for (std::size_t i = 0; i < choices_.size(); ++i) {
        TechniqueChoice& choice = choices_[i];
        const auto good = check(scene::make_technique(choice.technique.id()));
        choice.reason = good ? std::string() : good.error().message;
        choice.digit.reset();
        if (good) {
            drawing_.push_back(i);
            const int number = static_cast<int>(drawing_.size());
            choice.digit = number <= digits ? std::optional(number) : std::nullopt;
        }
    }
}

const scene::Technique& TechniqueEditor::edited() const {
    return model_ ? scene_.materials().at(*model_)->technique : switch_.technique();
}

Result<void> TechniqueEditor::check(const scene::Technique& technique) const {
    return model_ ? scene::check_technique(technique,
                                           *scene_.models.at(*model_)->get<scene::MeshNode>())
                  : scene_.check(technique);
}

bool TechniqueEditor::is_shown(const scene::Technique& technique) const {
    const std::vector<scene::Material*> materials = scene_.materials();
    for (std::size_t i = 0; i < materials.size(); ++i) {
        if (model_.value_or(i) == i && materials[i]->technique != technique) {
            return false;
        }
    }
    return true;
}

Result<void> TechniqueEditor::request(const scene::Technique& technique) {
    if (auto good = check(technique); !good) {
        return good;
    }
    const auto known = std::find_if(choices_.begin(), choices_.end(), [&](const auto& choice) {
        return choice.technique.id() == technique.id();
    });
    known->technique = technique;
    if (switch_.is_preparing() || !is_shown(technique)) {
        switch_.request(technique, model_);
    }
    return {};
}

void TechniqueEditor::next() {
    const auto found = std::find_if(drawing_.begin(), drawing_.end(), [&](std::size_t index) {
        return choices_[index].technique.id() == edited().id();
    });
    const auto index = static_cast<std::size_t>(found - drawing_.begin());
    choose((index + 1) % drawing_.size());
}

void TechniqueEditor::choose(std::size_t index) {
    if (index < drawing_.size()) {
        static_cast<void>(request(choices_[drawing_[index]].technique)); // it draws the scene
    }
}

void TechniqueEditor::select_next_parameter(int steps) {
    const auto count = static_cast<int>(scene::technique_info(edited().id()).parameters.size());
    if (count > 0) {
        const int now = std::min(static_cast<int>(parameter_), count - 1);
        parameter_ = static_cast<std::size_t>(((now + steps) % count + count) % count);
    }
}

void TechniqueEditor::step_parameter(int steps) {
    const auto parameters = scene::technique_info(edited().id()).parameters;
    if (parameters.empty()) {
        return;
    }
    const auto& parameter = parameters[std::min(parameter_, parameters.size() - 1)];
    const double value = scene::stepped(parameter, parameter.get(edited()), steps);
    static_cast<void>(request(scene::with_parameter(edited(), parameter, value)));
}

std::vector<std::string> TechniqueEditor::option_reasons() const {
    std::vector<std::string> reasons;
    for (const scene::OptionInfo& option : scene::option_catalogue()) {
        std::string reason(option.reason_against(edited().id()));
        if (reason.empty()) {
            const auto good = check(with_option(edited(), option));
            reason = good ? std::string() : good.error().message;
        }
        reasons.push_back(std::move(reason));
    }
    return reasons;
}

TechniqueContent TechniqueEditor::content() const {
    TechniqueContent content;
    content.requested = switch_.technique();
    content.choices = choices_;
    for (const scene::Node* const model : scene_.models) {
        content.models.push_back(
            {model->name(), model->get<scene::MeshNode>()->material.technique});
    }
    content.usual = usual_technique(edited().id());
    content.model = model_;
    content.option_reasons = option_reasons();
    const auto parameters = scene::technique_info(edited().id()).parameters;
    content.parameter = parameters.empty() ? 0 : std::min(parameter_, parameters.size() - 1);
    content.wireframe = scene_.materials().front()->wireframe;
    return content;
}

} // namespace reljef::app
