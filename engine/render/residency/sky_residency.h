#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/view/draw_list.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// The level of a sky's picture that a view shows, in GPU memory: its stacked faces.
class SkyResidency {
public:
    Result<void> prepare(const view::DrawList& list, view::FrameStats& stats);

    /// Texels along a face without its border; 0: the sky is no picture, and bind() does nothing.
    [[nodiscard]] int side() const { return faces_ ? side_ : 0; }
    void bind() const;

private:
    std::weak_ptr<const material::SkyPicture> picture_;
    std::size_t level_ = 0;
    int side_ = 0;
    std::optional<gl::Texture2D> faces_;
};

} // namespace reljef::render
