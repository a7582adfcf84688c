#include "app/viewer/technique_switch.h"

#include <utility>

namespace reljef::app {

TechniqueSwitch::TechniqueSwitch(session::TerrainScene& scene, int threads)
    : scene_(scene), threads_(threads) {}

void TechniqueSwitch::request(const scene::Technique& technique) {
    retire();
    session::MissingMaps missing = session::missing_maps(scene_, technique);
    if (missing.empty()) {
        show(technique);
        return;
    }
    pending_ = std::make_unique<Pending>();
    pending_->technique = technique;
    pending_->work.emplace([missing = std::move(missing), &log = pending_->log,
                            threads = threads_](const std::stop_token& stop) {
        return session::prepare_maps(missing, threads, log, stop);
    });
}

bool TechniqueSwitch::update() {
    std::erase_if(retired_, [](const auto& pending) { return pending->work->is_done(); });
    if (pending_ == nullptr || !pending_->work->is_done()) {
        return false;
    }
    const auto maps = pending_->work->take();
    const bool is_ready = maps.has_value();
    if (is_ready) {
        session::apply_maps(scene_, *maps);
        show(pending_->technique);
    } else {
        failures_.push_back(maps.error().message);
    }
    pending_.reset();
    return is_ready;
}

const scene::Technique& TechniqueSwitch::target() const {
    return pending_ != nullptr ? pending_->technique : scene_.materials().front()->technique;
}

session::RelayedLog::Progress TechniqueSwitch::progress() const {
    return pending_ != nullptr ? pending_->log.progress() : session::RelayedLog::Progress{};
}

void TechniqueSwitch::relay_to(session::Log& log) {
    if (pending_ != nullptr) {
        pending_->log.relay_to(log);
    }
    for (const std::string& failure : std::exchange(failures_, {})) {
        log.note(failure);
    }
}

void TechniqueSwitch::show(const scene::Technique& technique) {
    for (scene::Material* const material : scene_.materials()) {
        material->technique = technique;
    }
}

// A step of the work may still take a while: the window does not wait for it.
void TechniqueSwitch::retire() {
    if (pending_ != nullptr) {
        pending_->work->request_stop();
        retired_.push_back(std::move(pending_));
    }
}

} // namespace reljef::app
