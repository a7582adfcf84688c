#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace reljef::cast {

// Between the code that is compiled once and block_kernel.cpp, which Highway compiles for each
// instruction set: numbers only.

/// Side of the blocks of pixels that a thread casts at a time.
inline constexpr int block_side = 32;
inline constexpr std::size_t block_pixels = static_cast<std::size_t>(block_side) * block_side;

/// Pixels that share a beam: those of the widest packet of rays.
inline constexpr int beam_cols = 8;
inline constexpr int beam_rows = 2;
inline constexpr int beams_a_row = block_side / beam_cols;
inline constexpr int beam_count = beams_a_row * (block_side / beam_rows);
/// Wide beams search first. Each beam begins its search where that of its wide beam has ended.
inline constexpr int wide_beam_rows = 8;
inline constexpr int rows_of_wide_beams = block_side / wide_beam_rows;
inline constexpr int wide_beam_count = beams_a_row * rows_of_wide_beams;
inline constexpr unsigned all_wide_beams = (1U << static_cast<unsigned>(rows_of_wide_beams)) - 1U;

/// All pixels of a beam as bits.
inline constexpr std::uint16_t whole_beam = 0xFFFF;
static_assert(beam_cols * beam_rows == 16);

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
/// the anchor. Linear in the offset of the pixel from the block's middle, or of second degree.
struct BlockRays {
    struct Vectors {
        glm::vec3 middle{0.0F};
        glm::vec3 right{0.0F};
        glm::vec3 down{0.0F};
        /// Factors of right², right · down and down².
        std::array<glm::vec3, 3> bends{};
        bool is_bent = false;           ///< else these are 0
        glm::vec3 half_beam{0.0F};      ///< half the extent of a beam in the block, at most
        glm::vec3 half_wide_beam{0.0F}; ///< the same of a wide beam
    };
    glm::ivec2 base{0};       ///< col, row
    float base_height = 0.0F; ///< metres
    Vectors origin;
    Vectors direction;
    float speed = 0.0F;   ///< samples along columns or rows for a t of 1, of any ray at most
    float begin = 0.0F;   ///< of t
    float end = 0.0F;     ///< of t
    float lowest = 0.0F;  ///< metres above the base height: no surface is below, despite rounding
    float highest = 0.0F; ///< no surface is above
    float lift = 0.0F;    ///< metres by which a rounded ray may be above a maximum and still hit
};

/// The hits of a block, row after row. A pixel without a hit has t = infinity.
struct BlockHits {
    alignas(64) std::array<std::int32_t, block_pixels> job; ///< whose tile is hit

    alignas(64) std::array<float, block_pixels> t;
    alignas(64) std::array<std::int32_t, block_pixels> col; ///< cell
    alignas(64) std::array<std::int32_t, block_pixels> row;
    alignas(64) std::array<float, block_pixels> col_part; ///< in the cell, [0, 1]
    alignas(64) std::array<float, block_pixels> row_part;
    alignas(64) std::array<float, block_pixels> height; ///< metres above the base height
};

inline constexpr std::size_t max_paint_levels = 20;

/// In a texel of a map of normals: three times 10 bits, each normal_zero · (1 + component).
inline constexpr int normal_zero = 511;

/// What a tile looks like: the levels of a map of colours. Texels are three times 10 bits below two
/// that are 0, the square roots of linear light; or of a map of normals. One of level l covers 2^l
/// × 2^l of level 0.
struct TilePaint {
    const std::uint32_t* texels = nullptr; ///< row after row; the last column and row lie twice
    std::array<std::int32_t, max_paint_levels> begin{}; ///< of a level, and of all behind the last
    int level_count = 0;
    glm::ivec2 last{0};                ///< col and row of the last texel of level 0
    glm::vec2 texels_per_sample{1.0F}; ///< place of a texel = sample · texels_per_sample + first
    glm::vec2 first{0.0F};
    /// Texels of level 0 along a pixel, at most: x, plus y per metre of distance.
    glm::vec2 longest_texels{0.0F};
    /// For grain and façades, along its axes: normal = z − slope along columns · x − slope along
    /// rows · y.
    glm::mat3 normal_from_slopes{1.0F};
};

/// The fine structure of near ground (view::GrainView), and how bright it is.
struct GrainPaint {
    static constexpr int max_patterns = 3;
    static constexpr int max_levels = 8;

    const std::uint32_t* texels = nullptr;        ///< material::GrainMap::texels()
    std::array<std::int32_t, max_levels> begin{}; ///< of a level in its layer
    int layer_texels = 0;
    int side = 0; ///< of level 0, a power of two
    int level_count = 0;
    float strength = 0.0F;
    int pattern_count = 0;
    /// xyz: the eye's place, in widths of the pattern; w: widths in a metre.
    std::array<glm::vec4, max_patterns> patterns{};
    glm::vec2 turn{1.0F, 0.0F};     ///< view::GrainView::turn
    glm::vec3 up{0.0F};             ///< at the eye, along the turned axes
    glm::vec3 to_sun{0.0F};         ///< along the turned axes; 0 without a sun
    glm::vec3 level_light{1.0F};    ///< view::GrainView::level_light
    glm::vec2 metres_a_pixel{0.0F}; ///< see scene::metres_a_pixel()
};

/// A map that repeats, and its mip levels, each half as large: square roots of colours or normals,
/// as in TilePaint. Each level has a texel more on each side, those of its other side.
struct RepeatedMap {
    static constexpr int max_levels = 16;

    const std::uint32_t* texels = nullptr;
    std::array<std::int32_t, max_levels> begin{}; ///< of a level
    glm::ivec2 size{1};                           ///< of level 0, texels
    int level_count = 1;
};

/// How a ray looks for the surface of a detail texture (scene::Technique).
struct DetailSearch {
    int steps_from_above = 0; ///< seen from straight above; 0: no search
    int steps_along_ground = 0;
    int bisection_steps = 0;
    int secant_steps = 0; ///< including the last one
    bool shifts = false;  ///< by the height at the place, instead of a search
    bool is_limited = false;
    int iterations = 0;
};

/// A texture with relief that repeats over near ground (scene::TerrainDetail), below its surface.
struct DetailPaint {
    RepeatedMap color;
    RepeatedMap normals;
    const float* heights = nullptr; ///< [0, 1], row after row; one col and row more: the first ones
    glm::ivec2 samples{1};          ///< without these
    DetailSearch search;
    float width = 1.0F;            ///< of a copy, metres
    float lift = 0.0F;             ///< height of 1, metres
    float steeper = 1.0F;          ///< factor of the slopes of the normals
    glm::vec3 mean_color{1.0F};    ///< linear
    float specular = 0.0F;         ///< reflectance
    float shininess = 1.0F;        ///< exponent (Blinn 1977)
    glm::vec3 copies_at_eye{0.0F}; ///< the eye's place, in copies, modulo 1; local axes
    glm::mat3 local_from_world{1.0F};
    glm::vec3 up{0.0F, 0.0F, 1.0F}; ///< at the eye, in the world
    glm::vec2 seen_width{0.0F};     ///< widths between which it fades in, pixels
    glm::vec2 seen_height{0.0F};    ///< heights between which its relief does, pixels
    glm::vec2 metres_a_pixel{0.0F}; ///< see scene::metres_a_pixel()
};

/// The façades of a terrain in memory (view::FacadeMap), whose samples are those of its tile.
struct FacadePaint {
    static constexpr int wall_values = 16; ///< view::FacadeTexels

    const float* samples = nullptr; ///< pairs, row after row
    int stride = 0;                 ///< samples in a row
    const float* walls = nullptr;
    glm::vec3 sun{0.0F}; ///< at albedo 1 and share 1, linear
    glm::vec3 sky{0.0F};
    float exaggeration = 1.0F;
    glm::vec2 turn{1.0F, 0.0F};     ///< view::GrainView::turn
    glm::vec2 metres_a_pixel{0.0F}; ///< see scene::metres_a_pixel()
};

/// A scene::PointLight.
struct PointLightPaint {
    glm::vec3 from_eye{0.0F};       ///< world metres
    glm::vec3 color{0.0F};          ///< linear radiance at albedo 1 and a metre
    float per_squared_range = 1.0F; ///< 1 / metres²
    float nearest_square = 0.0F;    ///< metres²: nearer, light grows no further
};

/// The stacked faces of a level of material::SkyPicture.
struct SkyPaint {
    const std::uint32_t* texels = nullptr; ///< packed_roots(), row after row
    int side = 0;                          ///< of a face, texels without the border
    glm::mat3 picture_from_world{1.0F};    ///< a rotation
};

/// What is certain of the sun in a cell; 0: nothing.
inline constexpr std::int32_t sun_certain = 1;
inline constexpr std::int32_t shadow_certain = 2;

/// Rays to the sun over the ellipsoid: straight on the Earth, bent in samples of the surface. Each
/// leads from a place to that one plus a polynomial in the part of the ray, whose factors are
/// polynomials in the unit place (-1 to 1 over the surface along each axis).
struct SunBends {
    /// Terms of the factors of part to part^4, one after the other; x^i·y^j at j · side + i. After
    /// those of each factor, the same of what is multiplied with z.
    static constexpr std::array<int, 4> sides{5, 4, 3, 2};
    static constexpr std::array<int, 4> height_sides{5, 1, 0, 0};
    static constexpr int term_count = 2 * 5 * 5 + 4 * 4 + 1 + 3 * 3 + 2 * 2;

    std::array<glm::vec3, term_count> terms{}; ///< col, row, true metres of height
    glm::vec2 unit_per_sample{1.0F};
    float unit_per_metre = 1.0F; ///< of height above the ellipsoid
    float unit_height = 0.0F;    ///< the unit place at height 0
    /// Where the chords that replace a ray begin, and where the last one ends; the first is 0.
    std::span<const float> parts = {};
    /// Heights of the geoid above the ellipsoid, true metres, row after row: two columns and rows
    /// at least. Null: none.
    const float* zeros = nullptr;
    glm::ivec2 zero_count{0};
    glm::vec2 zero_scale{1.0F}; ///< place among them = scale · unit place + first
    glm::vec2 zero_first{0.0F};
};

/// A tile that may hide the sun from hits on another one, or on itself.
struct SunTile {
    TileSamples tile;
    float highest = 0.0F;   ///< no surface is above, metres
    float lift = 0.0F;      ///< as BlockRays::lift
    bool is_of_hits = true; ///< places are relative to the base of their rays
    /// Sample − base = scale · sample of the hits' tile + offset.
    glm::ivec2 base{0};
    glm::vec2 scale{1.0F};
    glm::vec2 offset{0.0F};
    glm::vec3 to_sun{0.0F, 0.0F, 1.0F}; ///< samples and metres of height; it rises
    // Where rays bend:
    glm::vec2 bend_scale{1.0F}; ///< samples of the tile in one of the surface
    int first_chord = 0;        ///< the first and the last chords that may meet it
    int last_chord = -1;
};

/// The sides of a tile: bits of BlockJob::walls.
inline constexpr unsigned west_wall = 1;
inline constexpr unsigned east_wall = 2;
inline constexpr unsigned north_wall = 4;
inline constexpr unsigned south_wall = 8;
/// Rays begin where their last piece has ended, which may be rounded to the other side.
inline constexpr unsigned begin_wall = 16;

/// The rays of a block at a tile.
struct BlockJob {
    TileSamples tile;
    BlockRays rays;
    const TilePaint* paint = nullptr; ///< not needed for hits
    /// What the sun adds to it where none of its tiles hides it; null: `paint` has its light.
    const TilePaint* sun = nullptr;
    const TilePaint* albedo = nullptr;    ///< null: no point light reaches it, and no detail
    const TilePaint* normals = nullptr;   ///< local ones, as large as the albedo
    const TilePaint* sun_share = nullptr; ///< of its disc that is visible; null: all, or by `sun`
    std::span<const SunTile> sun_tiles = {}; ///< of hits on a tile, that one first
    const SunBends* bends = nullptr;         ///< null: rays to the sun are straight
    glm::vec2 unit_scale{1.0F};              ///< unit place = scale · sample of the hits + first
    glm::vec2 unit_first{0.0F};
    /// What is certain of the sun in each cell: 2 bits, 16 cells of a row in a word.
    /// Null: nothing.
    const std::int32_t* certain_sun = nullptr;
    int certain_stride = 0; ///< words from row to row
    /// Sides at which other tiles begin. A ray that was above the tile before hits a wall where it
    /// comes in below the surface: neighbours may have other heights at their common border.
    unsigned walls = 0;
    /// Metres above the base height: rays that come in below have never been above any tile.
    float wall_floor = -std::numeric_limits<float>::infinity();
    /// The t at which the rays may begin; infinity: they hit nothing.
    float start = 0.0F;
    bool has_beams = true;     ///< finds later starts for the rays of each beam
    bool skips_blocks = true;  ///< rays pass over whole blocks of the maximum mipmap
    bool skips_cells = true;   ///< and over cells whose maximum is below them
    unsigned found_starts = 0; ///< the rows of wide beams for which they are found: bits
    std::size_t beam_taps = 0; ///< maxima that this took
    /// The pixels of the beams whose rays these are: bits, row after row. Others hit nothing.
    std::uint16_t beam_pixels = whole_beam;
    alignas(64) std::array<float, static_cast<std::size_t>(beam_count)> starts;
    alignas(64) std::array<float, static_cast<std::size_t>(wide_beam_count)> wide_starts;
};

/// The tiles that the rays of a block may hit, front to back.
struct BlockJobs {
    std::span<BlockJob> tiles;
    bool has_walls = false;
};

/// A triangle of a wall below the terrain. Functions that are linear on the picture: the value at a
/// place is xy · place + z; places are pixels from the block's middle.
struct WallTriangle {
    std::array<glm::vec3, 3> sides; ///< pixels inside of each side
    glm::vec3 depth{0.0F};          ///< 1/metre: the inverse; on maps metres
    glm::vec3 color{0.0F};          ///< linear, lit
    glm::vec2 low{0.0F};            ///< it covers no places beside these
    glm::vec2 high{0.0F};
};

/// What meshes look like in a block: a value for each of its pixels, row after row, or for each of
/// its samples.
struct BlockMeshes {
    static constexpr std::size_t padding = 32; ///< values after the last one; kernels may read them

    const float* t = nullptr;            ///< of the hits, as BlockHits::t
    std::array<const float*, 3> color{}; ///< linear, lit
    /// Times the inverse depth: differs from surface to surface, so that their borders get several
    /// samples. In (0, 1).
    const float* nearness = nullptr;
};

/// Meshes that may hide the sun from ground.
struct MeshShadow {
    const void* meshes = nullptr;
    /// The lanes, as bits, that meshes hide. Places: metres from the eye. Null: none.
    std::uint32_t (*hidden)(const void* meshes, std::array<const float*, 3> places,
                            std::uint32_t lanes) = nullptr;
};

/// Lines of equal height.
struct ContourPaint {
    float interval = 0.0F; ///< metres of height from one line to the next; 0: none
    float scale = 1.0F;    ///< view::contour_scale()
};

/// What all of a block looks like.
struct BlockPaint {
    BlockRays::Vectors view;    ///< world directions of the rays, metres per t
    BlockRays::Vectors origin;  ///< of the rays, metres from the eye; 0 in perspective
    float anchor = 0.0F;        ///< depth at t = 0, metres
    bool has_air = false;       ///< not on maps
    glm::vec3 extinction{0.0F}; ///< of the air at the base, 1/metre
    float eye_above = 0.0F;     ///< as scene::AirSeen
    float eye_density = 1.0F;
    float per_height = 0.0F;
    glm::vec3 up{0.0F, 0.0F, 1.0F};
    float bend = 0.0F;
    bool is_perspective = true;
    bool needs_nearness = false;
    bool needs_t = false;
    bool has_sky = false;
    const SkyPaint* sky = nullptr; ///< null: no picture, but the colours that follow
    glm::vec3 horizon{0.0F};       ///< linear
    glm::vec3 zenith{0.0F};
    glm::vec3 glow{0.0F};
    float curve = 1.0F;
    float plane_air = 0.0F; ///< as scene::AirSeen; 0: no plane
    glm::vec3 plane{0.0F};
    bool has_sun = false;
    /// The middle of the block in pixels from the lower left corner of the picture.
    glm::vec2 from_corner{0.0F};
    glm::vec3 sun{0.0F}; ///< 0 without a sun
    glm::vec3 to_sun{0.0F};
    std::span<const WallTriangle> walls = {}; ///< in front of all ground
    const BlockMeshes* meshes = nullptr;      ///< null: none
    std::span<const PointLightPaint> point_lights = {};
    glm::mat3 world_from_normal{1.0F};    ///< of BlockJob::normals
    const DetailPaint* detail = nullptr;  ///< null: none
    const GrainPaint* grain = nullptr;    ///< null: none
    const FacadePaint* facades = nullptr; ///< null: none
    ContourPaint contours = {};
    MeshShadow mesh_shadow = {};
};

/// Colours of a block as bytes r, g, b, a, row after row.
struct BlockPixels {
    alignas(64) std::array<std::uint32_t, block_pixels> rgba;
    alignas(64) std::array<float, block_pixels> nearness; ///< of the hits; see FirstSamples
    alignas(64) std::array<float, block_pixels> t; ///< of the hits, as BlockHits::t; not of walls
};

/// What the rays of a block cost, row after row.
struct BlockWork {
    alignas(64) std::array<std::int32_t, block_pixels> taps;  ///< maxima, corners of cells, texels
    alignas(64) std::array<std::int32_t, block_pixels> steps; ///< to a block or a cell; solved ones
    alignas(64) std::array<std::int32_t, block_pixels> rays; ///< that search; those to the sun, too
    std::size_t beam_taps = 0;                               ///< maxima, for all beams of the block
};

/// The nearness of 32 pixels in each of several rows. One pixel more on each side of a row, and one
/// row above and below. Beside the picture it is not a number.
struct NearnessRows {
    const float* first = nullptr;
    int stride = 0; ///< from row to row
    bool is_perspective = true;
    float disagreement = 0.0F; ///< see FirstSamples
};

inline constexpr int max_samples = 16;

/// Pixels of a block with several rays each.
struct SampledPixels {
    std::span<const std::uint16_t> pixels;       ///< row · block_side + column
    std::array<glm::vec2, max_samples> places{}; ///< from the middle of a pixel, pixels
    int samples = 1;

    [[nodiscard]] int count() const { return static_cast<int>(pixels.size()); }
};

/// Places from which the sun may be seen: cells of a terrain relative to a base, and parts.
struct SunPlaces {
    alignas(64) std::array<std::int32_t, block_pixels> col;
    alignas(64) std::array<std::int32_t, block_pixels> row;
    alignas(64) std::array<float, block_pixels> col_part;
    alignas(64) std::array<float, block_pixels> row_part;
    alignas(64) std::array<float, block_pixels> height; ///< metres above the job's base height
    int count = 0;
};

/// The functions of an instruction set.
struct BlockKernel {
    void (*cast)(const BlockJobs& jobs, BlockHits& hits) = nullptr;
    /// The same, and the colours instead of the hits.
    void (*paint)(const BlockJobs& jobs, const BlockPaint& paint, BlockPixels& pixels) = nullptr;
    /// Counts the work of the same colours. Precondition: the starts are not found yet.
    void (*count)(const BlockJobs& jobs, const BlockPaint& paint, BlockWork& work) = nullptr;
    /// Paints these pixels again: the mean of their samples, in linear light.
    void (*sample)(const BlockJobs& jobs, const BlockPaint& paint, const SampledPixels& sampled,
                   BlockPixels& pixels) = nullptr;
    /// The pixels of rows that are not on a plane with those beside them, or above and below: bits
    /// of each row.
    void (*bends)(const NearnessRows& rows, std::span<std::uint32_t> bits) = nullptr;
    /// Whether the job's `sun_tiles` hide the sun from places; 1: they do.
    void (*hide)(const BlockJob& job, const SunPlaces& places,
                 std::array<std::uint8_t, block_pixels>& hidden) = nullptr;
};

/// Those of the fastest of Highway's targets (SimdTarget::bit); 0: of the machine's.
BlockKernel block_kernel(std::int64_t targets);

/// Highway's bits of the instruction sets in this program.
std::int64_t compiled_targets();

} // namespace reljef::cast
