#include "engine/cast/frame/sun_tiles.h"

#include <algorithm>
#include <cstddef>
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

// Chords, the first and the last of which meet something.
struct Chords {
    int first = 0;
    int last = -1;
};

bool may_meet(const Box& ray, const Box& ground) {
    return ray.low.x <= ground.high.x && ray.high.x >= ground.low.x && ray.low.y <= ground.high.y &&
           ray.high.y >= ground.low.y && ray.low.z <= ground.high.z;
}

// `chords`: boxes around each.
Chords chords_over(const Box& ground, const std::vector<Box>& chords) {
    Chords found;
    for (int i = 0; i < static_cast<int>(chords.size()); ++i) {
        if (may_meet(chords[static_cast<std::size_t>(i)], ground)) {
            found.first = found.last < 0 ? i : found.first;
            found.last = i;
        }
    }
    return found;
}

std::vector<Box> chords_from(const Box& places, const SunCourse& course) {
    std::vector<Box> chords = course.ends_from(places);
    for (std::size_t i = 0; i + 1 < chords.size(); ++i) {
        chords[i].add(chords[i + 1]);
    }
    chords.pop_back();
    return chords;
}

Box around(const std::vector<Box>& boxes) {
    Box all;
    for (const Box& box : boxes) {
        all.add(box);
    }
    return all;
}

// A source that places may meet on their way to the sun.
struct Met {
    double way = 0.0; // the nearest first
    std::size_t source = 0;
    Chords chords = {};
};

std::vector<Met> met_by_chords(const Box& from, const std::vector<Box>& boxes,
                               const SunCourse& course) {
    const std::vector<Box> chords = chords_from(from, course);
    const Box all = around(chords);
    std::vector<Met> met;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Chords found = may_meet(all, boxes[i]) ? chords_over(boxes[i], chords) : Chords();
        if (found.last >= 0) {
            met.push_back({static_cast<double>(found.first), i, found});
        }
    }
    return met;
}

std::vector<Met> met_straight(const Box& from, const std::vector<Box>& boxes, glm::dvec3 to_sun) {
    std::vector<Met> met;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (const auto way = way_between(from, boxes[i], to_sun)) {
            met.push_back({*way, i, {}});
        }
    }
    return met;
}

// The sources that places of a box may meet on their way to the sun: `first`, then the nearest
// first.
std::vector<Met> met_from(const Box& from, std::size_t first, const std::vector<Box>& boxes,
                          const TowardSun& sun) {
    std::vector<Met> met = sun.bent != nullptr ? met_by_chords(from, boxes, *sun.bent)
                                               : met_straight(from, boxes, sun.straight);
    for (Met& one : met) {
        one.way = one.source == first ? -1.0 : one.way;
    }
    std::sort(met.begin(), met.end(), [](const Met& a, const Met& b) {
        return std::pair(a.way, a.source) < std::pair(b.way, b.source);
    });
    return met;
}

SunTile tile_between(const SunSource& from, const SunSource& to, const TowardSun& sun,
                     const Chords& chords) {
    SunTile made = sun_tile(*to.tile, sun.straight / glm::dvec3(to.step, 1.0));
    made.is_of_hits = from.tile == to.tile;
    made.bend_scale = glm::vec2(1.0 / to.step);
    made.first_chord = chords.first;
    made.last_chord = chords.last;
    if (!made.is_of_hits) {
        const glm::dvec2 first = (from.first - to.first) / to.step;
        const glm::dvec2 base = glm::round(first);
        made.base = glm::ivec2(base);
        made.scale = glm::vec2(from.step / to.step);
        made.offset = glm::vec2(first - base);
    }
    return made;
}

std::vector<Box> boxes_of(std::span<const SunSource> sources) {
    std::vector<Box> boxes(sources.size());
    std::transform(sources.begin(), sources.end(), boxes.begin(), box_of);
    return boxes;
}

} // namespace

std::vector<SunSource> sun_sources(const PlacedTiles& placed) {
    std::vector<SunSource> sources;
    for (const PlacedTile& tile : placed.tiles) {
        sources.push_back(placed.curve != nullptr
                              ? SunSource{tile.tile, -tile.by / tile.scale, 1.0 / tile.scale}
                              : SunSource{tile.tile, tile.first, tile.step});
    }
    return sources;
}

std::vector<SunTile> sun_tiles_from(const Box& box, glm::ivec2 base,
                                    std::span<const SunSource> sources, const TowardSun& sun) {
    const SunSource from{nullptr, glm::dvec2(base), glm::dvec2(1.0)};
    std::vector<SunTile> tiles;
    for (const Met& met : met_from(box, sources.size(), boxes_of(sources), sun)) {
        tiles.push_back(tile_between(from, sources[met.source], sun, met.chords));
    }
    return tiles;
}

void add_sun_tiles(PlacedTiles& placed, std::span<const SunSource> beside, const TowardSun& sun) {
    std::vector<SunSource> sources = sun_sources(placed);
    sources.insert(sources.end(), beside.begin(), beside.end());
    const std::vector<Box> boxes = boxes_of(sources);
    placed.sun_course = sun.bent;
    for (std::size_t i = 0; i < placed.tiles.size(); ++i) {
        for (const Met& met : met_from(boxes[i], i, boxes, sun)) {
            placed.tiles[i].sun_tiles.push_back(
                tile_between(sources[i], sources[met.source], sun, met.chords));
        }
    }
}

} // namespace reljef::cast
