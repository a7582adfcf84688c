#include "engine/cast/frame/sun_tiles.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include <glm/common.hpp>

namespace reljef::cast {
namespace {

Box box_of(const SunSource& source) {
    const terrain::MinMax total = source.tile->total();
    Box box;
    box.add(glm::dvec3(source.first, total.low));
    box.add(glm::dvec3(source.first + source.step * glm::dvec2(source.tile->cells()), total.high));
    return box;
}

// The way along which places of a box first come over another one; empty if none does while it is
// below the other's highest place.
std::optional<double> way_between(const Box& from, const Box& to, glm::dvec3 to_sun) {
    Interval way{0.0, (to.high.z - from.low.z) / to_sun.z};
    for (int axis = 0; axis < 2; ++axis) {
        // The difference of two places, one of each box, is within these.
        const double low = to.low[axis] - from.high[axis];
        const double high = to.high[axis] - from.low[axis];
        if (to_sun[axis] == 0.0) {
            if (low > 0.0 || high < 0.0) {
                return std::nullopt;
            }
            continue;
        }
        const double a = low / to_sun[axis];
        const double b = high / to_sun[axis];
        way = {std::max(way.begin, std::min(a, b)), std::min(way.end, std::max(a, b))};
    }
    return way.begin <= way.end ? std::optional(way.begin) : std::nullopt;
}

SunTile tile_between(const SunSource& from, const SunSource& to, glm::dvec3 to_sun) {
    SunTile made = sun_tile(*to.tile, to_sun / glm::dvec3(to.step, 1.0));
    made.is_of_hits = from.tile == to.tile;
    if (!made.is_of_hits) {
        const glm::dvec2 first = (from.first - to.first) / to.step;
        const glm::dvec2 base = glm::round(first);
        made.base = glm::ivec2(base);
        made.scale = glm::vec2(from.step / to.step);
        made.offset = glm::vec2(first - base);
    }
    return made;
}

// The boxes that places of one may meet on their way to the sun: `first`, then the nearest first.
std::vector<std::size_t> met_from(const Box& from, std::size_t first, const std::vector<Box>& boxes,
                                  glm::dvec3 to_sun) {
    std::vector<std::pair<double, std::size_t>> met;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (const auto way = way_between(from, boxes[i], to_sun)) {
            met.emplace_back(i == first ? -1.0 : *way, i);
        }
    }
    std::sort(met.begin(), met.end());
    std::vector<std::size_t> indices;
    std::transform(met.begin(), met.end(), std::back_inserter(indices),
                   [](const auto& one) { return one.second; });
    return indices;
}

std::vector<Box> boxes_of(std::span<const SunSource> sources) {
    std::vector<Box> boxes(sources.size());
    std::transform(sources.begin(), sources.end(), boxes.begin(), box_of);
    return boxes;
}

} // namespace

std::vector<std::size_t> sun_sources(const Box& box, std::span<const SunSource> sources,
                                     glm::dvec3 to_sun) {
    return met_from(box, sources.size(), boxes_of(sources), to_sun);
}

SunTile sun_tile_from(glm::ivec2 base, const SunSource& source, glm::dvec3 to_sun) {
    return tile_between({nullptr, glm::dvec2(base), glm::dvec2(1.0)}, source, to_sun);
}

void add_sun_tiles(PlacedTiles& placed, std::span<const SunSource> beside, glm::dvec3 to_sun) {
    std::vector<SunSource> sources;
    for (const PlacedTile& tile : placed.tiles) {
        sources.push_back({tile.tile, tile.first, tile.step});
    }
    sources.insert(sources.end(), beside.begin(), beside.end());
    const std::vector<Box> boxes = boxes_of(sources);
    for (std::size_t i = 0; i < placed.tiles.size(); ++i) {
        for (const std::size_t source : met_from(boxes[i], i, boxes, to_sun)) {
            placed.tiles[i].sun_tiles.push_back(tile_between(sources[i], sources[source], to_sun));
        }
    }
}

} // namespace reljef::cast
