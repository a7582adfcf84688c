#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "engine/core/parallel_for.h"
#include "terrains/generators.h"
#include "terrains/urban/urban_tile.h"

namespace reljef::terrains {
namespace {

using namespace urban;

constexpr int tile_size = 64;
constexpr double default_spacing = 0.5;
constexpr double min_spacing = 0.05;
constexpr double max_spacing = 4.0;
constexpr float min_city = 640.0F; ///< metres; smaller terrains show a part of it

std::optional<Error> urban_option_error(const GeneratorOptions& options) {
    if (options.size < 16 || options.size > 4096) {
        return Error{"urban: size " + std::to_string(options.size) +
                     " is out of range, expected 16 to 4096 samples"};
    }
    const bool own = options.spacing == 0.0;
    if (!own && !(options.spacing >= min_spacing && options.spacing <= max_spacing)) {
        return Error{"urban: spacing " + std::to_string(options.spacing) +
                     " is out of range, expected 0.05 to 4 m, or 0 for 0.5 m"};
    }
    return std::nullopt;
}

Raster raster_of(const GeneratorOptions& options, float spacing, float period) {
    Random random(hash(options.seed, 1, 1));
    const float x = random.unit() * period;
    return {options.size, spacing, {x, random.unit() * period}, hash(options.seed, 2, 2)};
}

/// A copy of a block on the repeating plane.
struct BlockCopy {
    const Block* block;
    glm::vec2 shift;
};

// The copies that touch a tile.
std::vector<BlockCopy> copies_in(const City& city, const Tile& tile) {
    const float period = city.plan.period;
    const auto first = [&](float from, float to) { return std::ceil((from - to) / period); };
    std::vector<BlockCopy> copies;
    for (const Block& block : city.blocks) {
        const Box& b = block.bounds;
        for (float y = first(tile.bounds.low.y, b.high.y);
             b.low.y + y * period <= tile.bounds.high.y; y += 1.0F) {
            for (float x = first(tile.bounds.low.x, b.high.x);
                 b.low.x + x * period <= tile.bounds.high.x; x += 1.0F) {
                copies.push_back({&block, {x * period, y * period}});
            }
        }
    }
    return copies;
}

void paint(Tile& tile, const City& city) {
    const std::vector<BlockCopy> copies = copies_in(city, tile);
    for (const BlockCopy& copy : copies) {
        paint_ground(tile, city.plan, *copy.block, copy.shift);
    }
    const auto paint_each = [&](auto Block::*objects, const auto& paint_object) {
        for (const BlockCopy& copy : copies) {
            for (const auto& object : copy.block->*objects) {
                paint_object(tile, city.plan.warp, object, copy.shift);
            }
        }
    };
    paint_each(&Block::patches, paint_patch);
    paint_each(&Block::buildings, paint_building);
    paint_each(&Block::prisms, paint_prism);
    paint_each(&Block::trees, paint_tree);
}

void store(const Tile& tile, terrain::Terrain& terrain) {
    for (int y = 0; y < tile.rows; ++y) {
        for (int x = 0; x < tile.cols; ++x) {
            const std::size_t i = tile.index(x, y);
            terrain.heightfield.heights(tile.col + x, tile.row + y) = tile.height[i];
            terrain.color(tile.col + x, tile.row + y) = encoded(tile.color[i]);
        }
    }
}

// Paints the tile that begins at a sample.
void paint_tile(terrain::Terrain& terrain, const City& city, const Raster& raster,
                glm::ivec2 first) {
    const glm::ivec2 size = glm::min(raster.size - first, glm::ivec2(tile_size));
    Tile tile = make_tile(raster, city.plan.warp, first.x, first.y, size.x, size.y);
    paint(tile, city);
    store(tile, terrain);
}

} // namespace

Result<terrain::Terrain> generate_urban(const GeneratorOptions& options) {
    if (const auto error = urban_option_error(options)) {
        return *error;
    }
    const double spacing = options.spacing == 0.0 ? default_spacing : options.spacing;
    const auto extent = static_cast<float>(spacing * options.size);
    const float period = options.tileable ? extent : std::max(extent, min_city);
    const City city = build_city(period, hash(options.seed, 3, 3), options.threads);

    terrain::Terrain terrain;
    terrain.name = "urban";
    terrain.heightfield.heights = Grid<float>(options.size, options.size);
    terrain.heightfield.spacing = {spacing, spacing};
    terrain.color = Image(options.size, options.size);
    const Raster raster = raster_of(options, static_cast<float>(spacing), period);
    const int across = (options.size + tile_size - 1) / tile_size;
    const auto paint_nth = [&](int index) {
        paint_tile(terrain, city, raster, tile_size * glm::ivec2(index % across, index / across));
    };
    if (!parallel_for(across * across, paint_nth,
                      {options.threads, options.stop, options.progress})) {
        return Error{"urban: generating was stopped"};
    }
    darken_hollows(terrain, {static_cast<float>(spacing), options.tileable, options.threads});
    terrain.heightfield.range = terrain::height_range(terrain.heightfield.heights, {});
    return terrain;
}

} // namespace reljef::terrains
