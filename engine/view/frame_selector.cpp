#include "engine/view/frame_selector.h"

#include "engine/core/check.h"
#include "engine/core/stopwatch.h"

namespace reljef::view {

const FrameView& FrameSelector::select(const scene::Scene& scene, glm::ivec2 size) {
    const Stopwatch watch;
    const bool has_changed = view_.look(scene, size);
    if (has_changed || !frame_ || selects_always_) {
        frame_ = view::select(view_, options_);
        ++count_;
        milliseconds_ = watch.milliseconds();
    }
    return *frame_;
}

const FrameView& FrameSelector::selected() const {
    check(frame_.has_value(), "a selected frame was expected");
    return *frame_;
}

void FrameSelector::forget() {
    view_ = {};
    frame_.reset();
}

} // namespace reljef::view
