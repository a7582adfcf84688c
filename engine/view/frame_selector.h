#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "engine/scene/graph/scene.h"
#include "engine/view/scene_view.h"
#include "engine/view/select.h"

namespace reljef::view {

/// Selects a scene's frames one after the other, each view once: while nothing in a view changes,
/// its frame stays as it is. Holds what the last view shows until another is selected or forget().
class FrameSelector {
public:
    /// `selects_always`: selects unchanged views again, to measure it.
    explicit FrameSelector(const SelectOptions& options = {}, bool selects_always = false)
        : options_(options), selects_always_(selects_always) {}

    /// What the scene's camera sees now, in a picture of that size. Valid until the next call.
    const FrameView& select(const scene::Scene& scene, glm::ivec2 size);
    /// The frame selected last. Precondition: there is one.
    [[nodiscard]] const FrameView& selected() const;

    void forget();

    /// How many views were selected so far.
    [[nodiscard]] int count() const { return count_; }
    /// How long the last selection took.
    [[nodiscard]] double milliseconds() const { return milliseconds_; }

private:
    SelectOptions options_;
    bool selects_always_;
    SceneView view_;
    std::optional<FrameView> frame_;
    int count_ = 0;
    double milliseconds_ = 0.0;
};

} // namespace reljef::view
