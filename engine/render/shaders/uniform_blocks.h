#pragma once

#include <cstddef>
#include <string_view>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "engine/render/shaders/bindings.h"

namespace reljef::render {

struct BlockLayout {
    std::string_view name;
    unsigned int binding = 0;
    std::size_t size = 0;
};

// Uniform blocks of the same name, std140. Their content rarely changes between frames.

struct TechniqueBlock {
    static const BlockLayout layout;
#include "shaders/frame/technique_block.inc"
};
static_assert(offsetof(TechniqueBlock, linear_steps) == 0);
static_assert(offsetof(TechniqueBlock, bisection_steps) == 4);
static_assert(offsetof(TechniqueBlock, secant_steps) == 8);
static_assert(offsetof(TechniqueBlock, steps_from_above) == 12);
static_assert(offsetof(TechniqueBlock, steps_along_ground) == 16);
static_assert(offsetof(TechniqueBlock, cone_max_steps) == 20);
static_assert(offsetof(TechniqueBlock, cone_min_step) == 24);
static_assert(offsetof(TechniqueBlock, cone_relaxed) == 28);
static_assert(offsetof(TechniqueBlock, parallax_offset) == 32);
static_assert(offsetof(TechniqueBlock, parallax_iterations) == 36);
static_assert(offsetof(TechniqueBlock, emboss_delta) == 40);
static_assert(offsetof(TechniqueBlock, fade_low) == 44);
static_assert(offsetof(TechniqueBlock, fade_high) == 48);
static_assert(offsetof(TechniqueBlock, fade_power) == 52);
static_assert(offsetof(TechniqueBlock, fade_reference_height) == 56);
static_assert(offsetof(TechniqueBlock, shadow_depth) == 60);
static_assert(offsetof(TechniqueBlock, edge_distance) == 64);
static_assert(sizeof(TechniqueBlock) == 5 * 16);
inline constexpr BlockLayout TechniqueBlock::layout{
    "TechniqueBlock", bindings::technique_block_binding, sizeof(TechniqueBlock)};

struct ReliefBlock {
    using vec4 = glm::vec4;
    static const BlockLayout layout;
#include "shaders/frame/relief_block.inc"
};
static_assert(offsetof(ReliefBlock, box_low) == 0);
static_assert(offsetof(ReliefBlock, box_begin) == 2 * 16);
static_assert(offsetof(ReliefBlock, space_scale) == 4 * 16);
static_assert(offsetof(ReliefBlock, height_span) == 5 * 16);
static_assert(sizeof(ReliefBlock) == 6 * 16);
inline constexpr BlockLayout ReliefBlock::layout{"ReliefBlock", bindings::relief_block_binding,
                                                 sizeof(ReliefBlock)};

struct DetailBlock {
    using vec4 = glm::vec4;
    static const BlockLayout layout;
#include "shaders/frame/detail_block.inc"
};
static_assert(offsetof(DetailBlock, detail_heights) == 0);
static_assert(offsetof(DetailBlock, detail_repeats) == 16);
static_assert(offsetof(DetailBlock, detail_look) == 2 * 16);
static_assert(offsetof(DetailBlock, mean_color) == 3 * 16);
static_assert(offsetof(DetailBlock, seen_pixels) == 4 * 16);
static_assert(sizeof(DetailBlock) == 5 * 16);
inline constexpr BlockLayout DetailBlock::layout{"DetailBlock", bindings::detail_block_binding,
                                                 sizeof(DetailBlock)};

struct OverlayBlock {
    using mat4 = glm::mat4;
    using vec4 = glm::vec4;
    static const BlockLayout layout;
#include "shaders/frame/overlay_block.inc"
};
static_assert(offsetof(OverlayBlock, grain_pattern_0) == 0);
static_assert(offsetof(OverlayBlock, grain_up) == 3 * 16);
static_assert(offsetof(OverlayBlock, grain_turn) == 5 * 16);
static_assert(offsetof(OverlayBlock, grain_light) == 6 * 16);
static_assert(offsetof(OverlayBlock, contours) == 7 * 16);
static_assert(offsetof(OverlayBlock, facade_sun) == 8 * 16);
static_assert(offsetof(OverlayBlock, grain_normal_from_slopes) == 10 * 16);
static_assert(sizeof(OverlayBlock) == 14 * 16);
inline constexpr BlockLayout OverlayBlock::layout{"OverlayBlock", bindings::overlay_block_binding,
                                                  sizeof(OverlayBlock)};

struct PointLightBlock {
    using vec4 = glm::vec4;
    static const BlockLayout layout;
#include "shaders/material/point_lights.inc"
};
static_assert(offsetof(PointLightBlock, point_light_numbers) == 0);
static_assert(offsetof(PointLightBlock, point_light_places) == 16);
static_assert(offsetof(PointLightBlock, point_light_colors) == 17 * 16);
static_assert(sizeof(PointLightBlock) == 33 * 16);
inline constexpr BlockLayout PointLightBlock::layout{
    "PointLightBlock", bindings::point_light_block_binding, sizeof(PointLightBlock)};

struct MeshShadowBlock {
    using mat4 = glm::mat4;
    using vec4 = glm::vec4;
    static const BlockLayout layout;
#include "shaders/material/mesh_shadow.inc"
};
static_assert(offsetof(MeshShadowBlock, mesh_shadow_numbers) == 0);
static_assert(offsetof(MeshShadowBlock, mesh_shadow_maps) == 16);
static_assert(offsetof(MeshShadowBlock, mesh_shadow_texels) == 17 * 16);
static_assert(sizeof(MeshShadowBlock) == 21 * 16);
inline constexpr BlockLayout MeshShadowBlock::layout{
    "MeshShadowBlock", bindings::mesh_shadow_block_binding, sizeof(MeshShadowBlock)};

struct CourseBlock {
    using mat4 = glm::mat4;
    using vec4 = glm::vec4;
    static const BlockLayout layout;
#include "shaders/frame/course_block.inc"
};
static_assert(offsetof(CourseBlock, unit_from_relative) == 0);
static_assert(offsetof(CourseBlock, course_eye) == 64);
static_assert(offsetof(CourseBlock, course_begin) == 64 + 16);
static_assert(offsetof(CourseBlock, course_terms) == 64 + 4 * 16);
static_assert(offsetof(CourseBlock, degree_eye) == 64 + 38 * 16);
static_assert(offsetof(CourseBlock, light_begin) == 64 + 47 * 16);
static_assert(offsetof(CourseBlock, light_terms) == 64 + 49 * 16);
static_assert(sizeof(CourseBlock) == 64 + 84 * 16);
inline constexpr BlockLayout CourseBlock::layout{"CourseBlock", bindings::course_block_binding,
                                                 sizeof(CourseBlock)};

} // namespace reljef::render
