#pragma once

#include <array>
#include <cstddef>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "engine/render/shaders/uniform_blocks.h"
#include "engine/view/draw_list.h"

namespace reljef::render {

/// The uniform block of every shader, std140.
struct FrameBlock {
    using mat4 = glm::mat4;
    using vec4 = glm::vec4;
    static const BlockLayout layout;
#include "shaders/frame/frame_block.inc"
};
static_assert(offsetof(FrameBlock, clip_from_relative) == 0);
static_assert(offsetof(FrameBlock, view_forward) == 64);
static_assert(offsetof(FrameBlock, sky_horizon) == 64 + 5 * 16);
static_assert(offsetof(FrameBlock, ray_from_pixel) == 64 + 6 * 16);
static_assert(offsetof(FrameBlock, vertex_grid) == 64 + 7 * 16);
static_assert(offsetof(FrameBlock, projection) == 64 + 8 * 16);
static_assert(offsetof(FrameBlock, ray_up) == 64 + 11 * 16);
static_assert(offsetof(FrameBlock, sky_plane) == 64 + 14 * 16);
static_assert(offsetof(FrameBlock, air_up) == 64 + 15 * 16);
static_assert(sizeof(FrameBlock) == 64 + 17 * 16);
inline constexpr BlockLayout FrameBlock::layout{"FrameBlock", bindings::frame_block_binding,
                                                sizeof(FrameBlock)};

inline constexpr std::array block_layouts{
    FrameBlock::layout,  TechniqueBlock::layout, ReliefBlock::layout,     DetailBlock::layout,
    CourseBlock::layout, OverlayBlock::layout,   PointLightBlock::layout, MeshShadowBlock::layout};

FrameBlock frame_block(const view::DrawList& list);

/// Of the list's point lights.
PointLightBlock point_light_block(const view::DrawList& list);

} // namespace reljef::render
