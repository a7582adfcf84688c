#include "app/viewer/appearance/appearance_switch.h"

#include "engine/session/gallery.h"
#include "engine/session/scene_daylight.h"

namespace reljef::app {
namespace {

bool is_of_another_surface(const session::PreparedMaps& maps, const scene::TerrainNode& node) {
    const auto* const light = maps.light != nullptr ? maps.light->request.surface.get() : nullptr;
    return (maps.surface != nullptr && maps.surface != node.surface) ||
           (light != nullptr && light != node.surface.get());
}

void shadow_floor_of(session::TerrainScene& scene) {
    if (scene.is_gallery) {
        session::shadow_floor(*scene.terrain->get<scene::TerrainNode>(), scene.models);
    }
}

} // namespace

AppearanceSwitch::AppearanceSwitch(session::TerrainScene& scene,
                                   const AppearanceSwitchOptions& options)
    : scene_(scene), options_(options) {}

// Requests the stop of all work before it waits.
AppearanceSwitch::~AppearanceSwitch() {
    retire();
}

void AppearanceSwitch::request(const scene::Technique& technique,
                               std::optional<std::size_t> model) {
    std::vector<scene::Technique> techniques;
    if (pending_ != nullptr) {
        techniques = pending_->appearance.techniques;
    }
    const std::vector<scene::Material*> materials = scene_.materials();
    for (std::size_t i = techniques.size(); i < materials.size(); ++i) {
        techniques.push_back(materials[i]->technique);
    }
    for (std::size_t i = 0; i < techniques.size(); ++i) {
        techniques[i] = model.value_or(i) == i ? technique : techniques[i];
    }
    request(std::move(techniques));
}

void AppearanceSwitch::request(const scene::Light& light) {
    Appearance appearance;
    if (pending_ != nullptr) {
        appearance = pending_->appearance;
    }
    appearance.light = light;
    begin(appearance);
}

void AppearanceSwitch::follow(const scene::Light& light) {
    if (pending_ != nullptr) {
        next_light_ = light;
    } else {
        request(light);
    }
}

bool AppearanceSwitch::update() {
    std::erase_if(retired_, [&](const auto& retired) {
        const bool is_done = retired->work->is_done();
        if (is_done) {
            retired->log.relay_to(log_);
        }
        return is_done;
    });
    if (pending_ == nullptr || !pending_->work->is_done()) {
        return false;
    }
    const auto maps = pending_->work->take();
    pending_->log.relay_to(log_);
    const Appearance appearance = std::exchange(pending_, nullptr)->appearance;
    if (!maps) {
        log_.note(maps.error().message);
        next_light_.reset();
        return false;
    }
    if (is_of_another_surface(*maps, *scene_.terrain->get<scene::TerrainNode>())) {
        const auto next = next_light_;
        begin(appearance); // the surface has changed meanwhile
        next_light_ = next;
        return pending_ == nullptr;
    }
    session::apply_maps(scene_, *maps);
    light_ = maps->light != nullptr ? maps->light : light_;
    show(appearance);
    if (next_light_) {
        request(*std::exchange(next_light_, std::nullopt));
    }
    return true;
}

bool AppearanceSwitch::undo() {
    const std::vector<scene::Technique> before = std::exchange(before_, {});
    const std::vector<scene::Material*> materials = scene_.materials();
    for (std::size_t i = 0; i < before.size(); ++i) {
        materials[i]->technique = before[i];
    }
    shadow_floor_of(scene_);
    return !before.empty();
}

const scene::Technique& AppearanceSwitch::technique() const {
    return pending_ != nullptr && !pending_->appearance.techniques.empty()
               ? pending_->appearance.techniques.front()
               : scene_.materials().front()->technique;
}

const scene::Light& AppearanceSwitch::light() const {
    if (next_light_) {
        return *next_light_;
    }
    return pending_ != nullptr ? pending_->appearance.light : *scene_.light->get<scene::Light>();
}

session::RelayedLog::TaskProgress AppearanceSwitch::progress() const {
    return pending_ != nullptr ? pending_->log.progress() : session::RelayedLog::TaskProgress{};
}

void AppearanceSwitch::relay_to(session::Log& log) {
    log_.relay_to(log);
    if (pending_ != nullptr) {
        pending_->log.relay_to(log);
    }
}

session::MissingMaps AppearanceSwitch::missing(const Appearance& appearance) const {
    const scene::Technique& shown = scene_.materials().front()->technique;
    const std::vector<scene::Technique>& techniques = appearance.techniques;
    const scene::Technique& technique = techniques.empty() ? shown : techniques.front();
    session::MissingMaps missing = techniques.empty() ? session::missing_maps(scene_)
                                                      : session::missing_maps(scene_, techniques);
    const bool is_lit_so = appearance.light == *scene_.light->get<scene::Light>() &&
                           technique.options.shadow.has_value() == shown.options.shadow.has_value();
    if (!is_lit_so) {
        missing.light =
            session::light_request(scene_, appearance.light, technique, options_.largest_side);
    }
    return missing;
}

void AppearanceSwitch::begin(const Appearance& appearance) {
    retire();
    next_light_.reset();
    session::MissingMaps missing = this->missing(appearance);
    if (missing.empty()) {
        show(appearance);
        return;
    }
    pending_ = std::make_unique<Pending>();
    pending_->appearance = appearance;
    pending_->work.emplace([missing = std::move(missing), &log = pending_->log,
                            threads = options_.threads](const std::stop_token& stop) {
        return session::prepare_maps(missing, threads, log, stop);
    });
}

void AppearanceSwitch::show(const Appearance& appearance) {
    session::set_daylight(scene_, appearance.light);
    if (!appearance.techniques.empty()) {
        before_.clear();
        const std::vector<scene::Material*> materials = scene_.materials();
        for (std::size_t i = 0; i < materials.size(); ++i) {
            before_.push_back(materials[i]->technique);
            materials[i]->technique = appearance.techniques[i];
        }
        shadow_floor_of(scene_);
    }
}

// The window does not wait for work that stops.
void AppearanceSwitch::retire() {
    if (pending_ != nullptr) {
        pending_->work->request_stop();
        retired_.push_back(std::move(pending_));
    }
}

} // namespace reljef::app
