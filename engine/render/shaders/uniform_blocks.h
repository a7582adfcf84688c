#pragma once

#include <cstddef>
#include <string_view>

#include <glm/vec4.hpp>

#include "engine/render/shaders/bindings.h"

namespace reljef::render {

/// What a shader's uniform block must be like to be read from a struct of C++.
struct BlockLayout {
    std::string_view name;
    unsigned int binding = 0;
    std::size_t size = 0;
};

/// Uniform blocks of the same name, std140. Their members stand in shaders/frame. What they hold
/// stays as it is from frame to frame.

struct TechniqueBlock {
    using vec4 = glm::vec4;
    static const BlockLayout layout;
#include "shaders/frame/technique_block.inc"
};
static_assert(offsetof(TechniqueBlock, search_values) == 0);
static_assert(offsetof(TechniqueBlock, fade_values) == 16);
static_assert(offsetof(TechniqueBlock, option_values) == 2 * 16);
static_assert(sizeof(TechniqueBlock) == 3 * 16);
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

} // namespace reljef::render
