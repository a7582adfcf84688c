#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace reljef::cast {

// Between the code that is compiled once and block_kernel.cpp, which Highway compiles for each
// instruction set: numbers only.

/// Side of the blocks of pixels that a thread casts at a time.
inline constexpr int block_side = 32;

/// Pixels that share a beam: those of the widest packet of rays.
inline constexpr int beam_cols = 8;
inline constexpr int beam_rows = 2;
inline constexpr int beams_a_row = block_side / beam_cols;
inline constexpr int beam_count = beams_a_row * (block_side / beam_rows);

/// A RayTile.
struct TileSamples {
    const float* heights = nullptr;
    int height_stride = 0;
    const float* maxima = nullptr;
    int stride = 0;
    int rows = 0;
    int top_level = 0;
    glm::ivec2 cells{0};
};

/// The rays of a block of pixels in floats: sample coordinates relative to a base, t relative to
/// the anchor. Linear in the offset of the pixel from the block's middle.
struct BlockRays {
    struct Vectors {
        glm::vec3 middle{0.0F};
        glm::vec3 right{0.0F};
        glm::vec3 down{0.0F};
    };
    glm::ivec2 base{0};       ///< col, row
    float base_height = 0.0F; ///< metres
    Vectors origin;
    Vectors direction;
    float begin = 0.0F;   ///< of t
    float end = 0.0F;     ///< of t
    float lowest = 0.0F;  ///< metres above the base height: no surface is below, despite rounding
    float highest = 0.0F; ///< no surface is above
    float lift = 0.0F;    ///< metres by which a rounded ray may be above a maximum and still hit
};

/// The hits of a block, row after row. A pixel without a hit has t = infinity.
struct BlockHits {
    static constexpr std::size_t count = static_cast<std::size_t>(block_side) * block_side;
    alignas(64) std::array<float, count> t;
    alignas(64) std::array<std::int32_t, count> col; ///< cell
    alignas(64) std::array<std::int32_t, count> row;
    alignas(64) std::array<float, count> col_part; ///< in the cell, [0, 1]
    alignas(64) std::array<float, count> row_part;
    alignas(64) std::array<float, count> height; ///< metres above the base height
};

struct BlockJob {
    TileSamples tile;
    BlockRays rays;
    /// The t at which the rays may begin; infinity: they hit nothing.
    float start = 0.0F;
    bool has_beams = true; ///< finds later starts for the rays of each beam
};

/// A level of a map of colours: texels of three times 10 bits, the square roots of linear light.
struct PaintLevel {
    const std::uint32_t* texels = nullptr; ///< the last column and row lie there twice
    int stride = 0;
    glm::vec2 last{0.0F};              ///< col and row of the last texel
    glm::vec2 texels_per_sample{1.0F}; ///< place of a texel = sample · texels_per_sample + first
    glm::vec2 first{0.0F};
};
inline constexpr std::size_t max_paint_levels = 20;

/// What hits and misses look like.
struct BlockPaint {
    std::array<PaintLevel, max_paint_levels> levels{};
    int level_count = 0;
    /// Texels of level 0 along a pixel, at most: x, plus y per metre of distance.
    glm::vec2 longest_texels{0.0F};
    BlockRays::Vectors view; ///< world directions of the rays, metres per t
    float anchor = 0.0F;     ///< depth at t = 0, metres
    float extinction = 0.0F; ///< of the air, 1/metre; 0 without air, and on maps
    bool has_sky = false;
    glm::vec3 horizon{0.0F}; ///< linear
    glm::vec3 zenith{0.0F};
    glm::vec3 sun{0.0F}; ///< 0 without a sun
    glm::vec3 to_sun{0.0F};
};

/// Colours of a block as bytes r, g, b, a, row after row.
struct BlockPixels {
    alignas(64) std::array<std::uint32_t, BlockHits::count> rgba;
};

/// The functions of an instruction set.
struct BlockKernel {
    void (*cast)(const BlockJob& job, BlockHits& hits) = nullptr;
    /// The same, and the colours instead of the hits.
    void (*paint)(const BlockJob& job, const BlockPaint& paint, BlockPixels& pixels) = nullptr;
};

/// Those of the fastest of Highway's targets (SimdTarget::bit); 0: of the machine's.
BlockKernel block_kernel(std::int64_t targets);

/// Highway's bits of the instruction sets in this program.
std::int64_t compiled_targets();

} // namespace reljef::cast
