#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/cast/packet/block_kernel.h"
#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {

/// A terrain's lit map (view/terrain_maps.h) and its mip levels, each half as large, to read by
/// packets of rays.
class LitLevels {
public:
    /// `samples`: of the terrain, along each axis. Preconditions: neither is empty. `threads`: as
    /// parallel_for(); for small maps one is the fastest.
    LitLevels(const Image& lit, glm::ivec2 samples, unsigned threads = 0);

    /// Of normals (unit vectors) instead: their lengths are lost.
    LitLevels(const Grid<glm::vec3>& normals, glm::ivec2 samples, unsigned threads = 0);

    /// The levels over a part of the terrain that begins at a sample. Valid as long as these.
    [[nodiscard]] TilePaint paint(glm::vec2 first_sample = glm::vec2(0.0F)) const;

    [[nodiscard]] std::size_t bytes() const { return texels_.size() * sizeof(std::uint32_t); }

private:
    void place(glm::ivec2 size, glm::ivec2 samples);
    template <class Pack>
    void add_coarse_levels(Grid<glm::vec3> level, const Pack& pack, unsigned threads);
    void repeat_last_level();

    std::vector<std::uint32_t> texels_;
    TilePaint paint_; // its texels are set when it is used
};

/// A texel of paints: the square roots of a linear colour in [0, 1], three times 10 bits.
std::uint32_t packed_roots(glm::vec3 linear);

/// A texel of maps of normals.
std::uint32_t packed_normal(glm::vec3 normal);

/// TilePaint::longest_texels of a paint. `spacing`: of the samples, metres.
glm::vec2 longest_texels(const view::DrawList& list, const TilePaint& paint, glm::dvec2 spacing);

} // namespace reljef::cast
