#include "terrains/gallery/detail_cells.h"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "terrains/natural/noise.h"

namespace reljef::terrains {
namespace {

glm::ivec2 wrapped_cell(glm::ivec2 cell, int period) {
    const glm::ivec2 rest = cell % period;
    return {rest.x < 0 ? rest.x + period : rest.x, rest.y < 0 ? rest.y + period : rest.y};
}

glm::vec2 seed_place(std::uint32_t seed, glm::ivec2 cell, int period, float jitter) {
    const glm::ivec2 id = wrapped_cell(cell, period);
    const glm::vec2 random(unit_hash(seed, id.x, id.y), unit_hash(seed + 1, id.x, id.y));
    return glm::vec2(cell) + 0.5F + jitter * (random - 0.5F);
}

// Calls `visit(cell)` for the squares up to `reach` around one.
template <class Visit> void around(glm::ivec2 middle, int reach, const Visit& visit) {
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            visit(middle + glm::ivec2(x, y));
        }
    }
}

} // namespace

VoronoiCell voronoi(std::uint32_t seed, glm::vec2 point, int period, float jitter) {
    const glm::ivec2 square(glm::floor(point));
    glm::ivec2 nearest = square;
    glm::vec2 place = seed_place(seed, square, period, jitter);
    around(square, 1, [&](glm::ivec2 cell) {
        const glm::vec2 other = seed_place(seed, cell, period, jitter);
        if (glm::distance(point, other) < glm::distance(point, place)) {
            nearest = cell;
            place = other;
        }
    });
    float to_edge = std::numeric_limits<float>::max();
    around(nearest, 2, [&](glm::ivec2 cell) {
        if (cell != nearest) {
            const glm::vec2 other = seed_place(seed, cell, period, jitter);
            const glm::vec2 across = glm::normalize(other - place);
            to_edge = std::min(to_edge, glm::dot(0.5F * (place + other) - point, across));
        }
    });
    return {wrapped_cell(nearest, period), point - place, to_edge};
}

} // namespace reljef::terrains
