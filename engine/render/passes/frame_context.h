#pragma once

#include <cstdint>

#include "engine/core/result.h"
#include "engine/gl/framebuffer.h"
#include "engine/gl/vertex_array.h"
#include "engine/render/passes/draw_state.h"
#include "engine/render/residency/residency.h"
#include "engine/view/draw_list.h"

namespace reljef::render {

/// One frame as its passes see it: a file for each kind of thing.
struct FrameContext {
    const view::DrawList& list;
    const Residency& residency; ///< prepared for the list
    bool hits;                  ///< what each pixel shows is drawn, instead of its colour
    std::uint32_t features;     ///< of the scene's, see scene_features
    const gl::Framebuffer& picture;
    const gl::Framebuffer& beams; ///< there where a technique has them (beams.h)
    const gl::VertexArray& no_vertices;
    DrawState& state;
};

/// What all of the list's programs are compiled with, for a picture with so many samples a pixel.
std::uint32_t scene_features(const view::DrawList& list, bool hits, int samples = 1);

} // namespace reljef::render
