#include "app/viewer/appearance/contour_watch.h"

#include <utility>

#include "engine/session/picture/faded_contours.h"

namespace reljef::app {

bool ContourWatch::update(glm::ivec2 size, bool is_moving, session::Log& log) {
    const auto& node = *scene_.terrain->get<scene::TerrainNode>();
    if (scene::shown_contours(node) <= 0.0) {
        last_.reset();
        seen_.reset();
        return !std::exchange(sentence_, {}).empty();
    }
    Seen now{*scene_.camera->get<scene::Camera>(), size, scene::shown_contours(node), node.surface,
             node.material};
    const bool has_changed = last_ != now; // a drag does not rest either
    last_ = now;
    if (is_moving || has_changed || seen_ == now) {
        return false;
    }
    seen_ = std::move(now);
    const auto faded = session::faded_contours(scene_, size);
    std::string sentence = faded ? session::faded_text(*faded, seen_->interval) : std::string();
    if (faded && std::exchange(noted_, seen_->interval) != seen_->interval) {
        log.note(sentence);
    }
    return std::exchange(sentence_, sentence) != sentence;
}

} // namespace reljef::app
