#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/terrain/field/heightfield.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::test {

inline constexpr double house_eaves = 12.0; // metres
inline constexpr int house_side = 81;       // samples, half a metre apart

inline std::uint32_t nearest_wall(const std::vector<terrain::Facade>& walls, glm::dvec2 sample) {
    double least = 2.25; // samples
    std::uint32_t nearest = 0;
    for (std::size_t i = 0; i < walls.size(); ++i) {
        const glm::dvec2 way = walls[i].end - walls[i].begin;
        const double part = glm::dot(sample - walls[i].begin, way) / glm::dot(way, way);
        const double away =
            glm::distance(sample, walls[i].begin + glm::clamp(part, 0.0, 1.0) * way);
        if (away < least) {
            least = away;
            nearest = static_cast<std::uint32_t>(i + 1);
        }
    }
    return nearest;
}

/// A turned house with a flat roof in the middle of level ground, whose walls rise over a sample.
inline terrain::Terrain made_house() {
    const glm::dvec2 middle(40.0, 40.0);
    const glm::dvec2 axis = glm::normalize(glm::dvec2(3.0, 1.0));
    const glm::dvec2 across(-axis.y, axis.x);
    const glm::dvec2 half(20.0, 12.0);
    const auto at = [&](double x, double y) { return middle + axis * x + across * y; };
    terrain::Terrain made;
    made.name = "house";
    made.heightfield = plane_heightfield(
        made_heights(
            house_side, house_side,
            [&](int col, int row) {
                const glm::dvec2 from = glm::dvec2(col, row) - middle;
                const glm::dvec2 inside =
                    half - glm::abs(glm::dvec2(glm::dot(from, axis), glm::dot(from, across)));
                return house_eaves * std::clamp(std::min(inside.x, inside.y) + 0.5, 0.0, 1.0);
            }),
        {0.5, 0.5});
    const std::array corners{at(-half.x, -half.y), at(half.x, -half.y), at(half.x, half.y),
                             at(-half.x, half.y)};
    made.facades.wall_at = Grid<std::uint32_t>(house_side, house_side);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        terrain::Facade wall;
        wall.begin = corners.at(i);
        wall.end = corners.at((i + 1) % corners.size());
        wall.windows = {0.0, i % 2 == 0 ? 6.0 : 4.0};
        wall.eaves = house_eaves;
        wall.storeys = 4.0;
        wall.rise = 1.0;
        made.facades.walls.push_back(wall);
    }
    for (int row = 0; row < house_side; ++row) {
        for (int col = 0; col < house_side; ++col) {
            made.facades.wall_at(col, row) = nearest_wall(made.facades.walls, {col, row});
        }
    }
    return made;
}

} // namespace reljef::test
