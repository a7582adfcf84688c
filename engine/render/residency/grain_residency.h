#pragma once

#include <optional>

#include "engine/core/result.h"
#include "engine/gl/texture_array.h"
#include "engine/view/draw_list.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// The patterns of material::GrainMap in GPU memory, once a terrain with grain is drawn.
class GrainResidency {
public:
    Result<void> prepare(const view::DrawList& list, view::FrameStats& stats);

    /// Preconditions: prepared; a terrain of the list has grain.
    void bind() const;

private:
    std::optional<gl::TextureArray> layers_;
};

} // namespace reljef::render
