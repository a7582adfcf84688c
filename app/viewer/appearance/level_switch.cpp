#include "app/viewer/appearance/level_switch.h"

#include <utility>

#include "engine/session/prepared_maps.h"

namespace reljef::app {
namespace {

constexpr unsigned making_threads = 1; // drawing has the others

} // namespace

bool LevelSwitch::update() {
    if (making_) {
        if (!making_->is_done()) {
            return false;
        }
        auto made = making_->take();
        making_.reset();
        has_failed_ = !made;
        if (!made) {
            log_.note(made.error().message);
            return false;
        }
        session::set_levels(scene_.objects, *made);
        return true;
    }
    auto meshes =
        has_failed_ ? std::vector<session::ObjectMesh>() : session::missing_levels(scene_);
    if (!meshes.empty()) {
        making_.emplace([meshes = std::move(meshes), this](const std::stop_token& stop) {
            const auto task = log_.start("making levels of detail of objects");
            return session::make_levels(meshes, {making_threads, stop, task->callback()});
        });
    }
    return false;
}

} // namespace reljef::app
