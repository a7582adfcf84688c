#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/terrain/field/heightfield.h"
#include "terrains/generators.h"
#include "terrains/urban/urban_city.h"

namespace reljef::terrains::urban {

struct Raster {
    int size = 0;
    float spacing = 0.5F;
    glm::vec2 origin{0.0F, 0.0F}; ///< ground position of sample (0,0), metres
    std::uint32_t seed = 0;
    double spacing_in_metres = 0.5; ///< the same, not rounded
    building::CityWalls walls = building::CityWalls::straight;
};

/// The part of the city that a raster shows.
Box city_bounds(const Raster& raster, const Warp& warp);

/// A rectangle of samples while it is painted; all arrays row after row.
struct Tile {
    int col = 0;
    int row = 0;
    int cols = 0;
    int rows = 0;
    float spacing = 0.5F;
    building::CityWalls walls = building::CityWalls::straight;
    glm::vec2 origin{0.0F, 0.0F}; ///< ground position of the first sample
    Box bounds;                   ///< of `place`
    std::vector<glm::vec2> place; ///< city position
    std::vector<Color> color;
    std::vector<float> height;
    std::vector<float> bare;           ///< share of each sample that no building covers
    std::vector<float> built;          ///< the buildings' part of `height`
    std::vector<std::uint8_t> planted; ///< 1: a tree, a hedge or a car is the highest
    std::vector<float> grain;          ///< white noise, [-1, 1]
    std::vector<float> fine;           ///< clumps of about 2 m, about [-1, 1]
    std::vector<float> broad;          ///< stains of about 14 m, about [-1, 1]

    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(cols) +
               static_cast<std::size_t>(x);
    }
};

/// An empty tile with its positions and noises; the noises repeat with the raster.
Tile make_tile(const Raster& raster, const Warp& warp, int col, int row, int cols, int rows);

/// The samples of a tile that a box of the city can touch.
struct Span {
    int x0 = 0;
    int y0 = 0;
    int x1 = 0; ///< one past the last
    int y1 = 0;
};
Span span_of(const Tile& tile, const Warp& warp, const Box& box);

/// Calls `body(i)` with the index of each sample of span_of().
template <class Body>
void for_each_sample(const Tile& tile, const Warp& warp, const Box& box, const Body& body) {
    const Span span = span_of(tile, warp, box);
    for (int y = span.y0; y < span.y1; ++y) {
        for (int x = span.x0; x < span.x1; ++x) {
            body(tile.index(x, y));
        }
    }
}

/// Share of a sample that lies inside an edge at this signed distance.
inline float coverage(const Tile& tile, float distance) {
    return std::clamp(distance / tile.spacing + 0.5F, 0.0F, 1.0F);
}

inline void blend(Color& under, const Color& over, float amount) {
    under += (over - under) * amount;
}

/// The colour of a ground cover without its pattern.
Color surface_color(Surface surface, const Tile& tile, std::size_t i);

/// Paints streets, sidewalks and the bare ground of a block. `shift` moves the block.
void paint_ground(Tile& tile, const StreetPlan& plan, const Block& block, glm::vec2 shift);
void paint_patch(Tile& tile, const Warp& warp, const Patch& patch, glm::vec2 shift);
void paint_building(Tile& tile, const Warp& warp, const Building& building, glm::vec2 shift);
void paint_prism(Tile& tile, const Warp& warp, const Prism& prism, glm::vec2 shift);
void paint_tree(Tile& tile, const Warp& warp, const Tree& tree, glm::vec2 shift);

/// The nearest 8-bit colour; clamps channels to [0,1].
Rgba8 encoded(const Color& color);

struct HollowOptions {
    float spacing = 0.5F;  ///< metres between samples
    bool tileable = false; ///< the terrain repeats; else its edge samples continue outwards
    unsigned threads = 0;
};

/// Soft ambient occlusion. Samples get darker by walls 1.6 m away and by the averages of the
/// heights over about 10 m and 32 m.
void darken_hollows(terrain::Terrain& terrain, const HollowOptions& options);

} // namespace reljef::terrains::urban
