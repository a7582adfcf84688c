#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "engine/core/parallel_for.h"
#include "terrains/generators.h"
#include "terrains/urban/urban_facades.h"
#include "terrains/urban/urban_meshes.h"
#include "terrains/urban/urban_tile.h"

namespace reljef::terrains {
namespace {

using namespace urban;

constexpr int tile_size = 64;
constexpr double default_spacing = 0.5;
constexpr double min_spacing = 0.05;
constexpr double max_spacing = 4.0;
constexpr double max_facade_spacing = 1.5; ///< metres; windows are as wide
constexpr float min_city = 640.0F;         ///< metres; smaller terrains show a part of it

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

Raster raster_of(const GeneratorOptions& options, double spacing, float period) {
    Random random(material::hash(options.seed, 1, 1));
    const float x = random.unit() * period;
    return {options.size,
            static_cast<float>(spacing),
            {x, random.unit() * period},
            material::hash(options.seed, 2, 2),
            spacing,
            options.walls};
}

// `with_buildings`: and what stands on them.
void paint(Tile& tile, const CityPlan& city, bool with_buildings) {
    const std::vector<BlockCopy> copies = copies_in(city, tile.bounds);
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
    if (with_buildings) {
        paint_each(&Block::buildings, paint_building);
    }
    paint_each(&Block::prisms,
               [&](Tile& into, const Warp& warp, const Prism& prism, glm::vec2 shift) {
                   if (with_buildings || stands_on_ground(prism.kind)) {
                       paint_prism(into, warp, prism, shift);
                   }
               });
    paint_each(&Block::trees, paint_tree);
}

struct Painted {
    terrain::Terrain terrain;
    Grid<std::uint8_t> planted; // Tile::planted
};

void store(const Tile& tile, Painted& painted) {
    terrain::Terrain& terrain = painted.terrain;
    for (int y = 0; y < tile.rows; ++y) {
        for (int x = 0; x < tile.cols; ++x) {
            const std::size_t i = tile.index(x, y);
            terrain.heightfield.heights(tile.col + x, tile.row + y) = tile.height[i];
            terrain.color(tile.col + x, tile.row + y) = encoded(tile.color[i]);
            painted.planted(tile.col + x, tile.row + y) = tile.planted[i];
        }
    }
}

// Paints the tile that begins at a sample.
void paint_tile(Painted& painted, const CityPlan& city, const Raster& raster, glm::ivec2 first,
                bool with_buildings) {
    const glm::ivec2 size = glm::min(raster.size - first, glm::ivec2(tile_size));
    Tile tile = make_tile(raster, city.plan.warp, first.x, first.y, size.x, size.y);
    paint(tile, city, with_buildings);
    store(tile, painted);
}

// Without the darkening of hollows; empty if it was stopped.
std::optional<Painted> painted(const CityPlan& city, const Raster& raster,
                               const GeneratorOptions& options, bool with_buildings) {
    Painted made{{}, Grid<std::uint8_t>(options.size, options.size)};
    terrain::Terrain& terrain = made.terrain;
    terrain.name = "urban";
    terrain.heightfield.heights = Grid<float>(options.size, options.size);
    terrain.heightfield.spacing = glm::dvec2(raster.spacing_in_metres);
    terrain.color = Image(options.size, options.size);
    const int across = (options.size + tile_size - 1) / tile_size;
    const auto paint_nth = [&](int index) {
        paint_tile(made, city, raster, tile_size * glm::ivec2(index % across, index / across),
                   with_buildings);
    };
    const bool is_whole =
        parallel_for(across * across, paint_nth, {options.threads, options.stop, options.progress});
    return is_whole ? std::optional(std::move(made)) : std::nullopt;
}

} // namespace

Result<City> generate_city(const GeneratorOptions& options, building::CityForm form) {
    if (const auto error = urban_option_error(options)) {
        return *error;
    }
    const double spacing = options.spacing == 0.0 ? default_spacing : options.spacing;
    const auto extent = static_cast<float>(spacing * options.size);
    const float period = options.tileable ? extent : std::max(extent, min_city);
    const CityPlan city = build_city(period, material::hash(options.seed, 3, 3), options.threads);
    const Raster raster = raster_of(options, spacing, period);
    auto all = painted(city, raster, options, true);
    const bool has_meshes = form != building::CityForm::heights;
    auto bare = all && has_meshes ? painted(city, raster, options, false) : std::nullopt;
    if (!all || (has_meshes && !bare)) {
        return Error{"urban: generating was stopped"};
    }
    if (bare) {
        std::swap(all->terrain.color, bare->terrain.color); // buildings darken the bare ground, too
    }
    darken_hollows(all->terrain, {raster.spacing, options.tileable, options.threads});
    City made;
    if (bare) {
        std::swap(all->terrain.color, bare->terrain.color);
        made.buildings = mesh_buildings(city, raster);
        made.heights = std::move(all->terrain.heightfield.heights);
    }
    made.terrain = bare ? std::move(bare->terrain) : std::move(all->terrain);
    if (form == building::CityForm::heights && options.walls == building::CityWalls::straight &&
        spacing <= max_facade_spacing) {
        made.terrain.facades =
            facades_of(city, raster, made.terrain.heightfield.heights.view(), all->planted);
    }
    if (form == building::CityForm::meshes_only) {
        made.terrain.heightfield.heights = Grid<float>(options.size, options.size, 0.0F);
    }
    made.terrain.heightfield.range = terrain::height_range(made.terrain.heightfield.heights, {});
    return made;
}

Result<terrain::Terrain> generate_urban(const GeneratorOptions& options) {
    auto city = generate_city(options, building::CityForm::heights);
    return city ? Result<terrain::Terrain>(std::move(city->terrain)) : city.error();
}

} // namespace reljef::terrains
