#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "engine/terrain/mesh/bisection.h"
#include "engine/terrain/mesh/bisection_mesh.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::test {

struct MadeTerrain {
    std::string name;
    terrain::Heightfield heightfield;
    double exaggeration = 1.0;
};

/// Smooth hills with noise on them.
inline Grid<float> rough_hills(int cols, int rows, unsigned seed) {
    Grid<float> heights = random_heights(cols, rows, -2.0F, 2.0F, seed);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            heights(col, row) +=
                static_cast<float>(40.0 * std::sin(0.11 * col + 0.3) * std::cos(0.07 * row));
        }
    }
    return heights;
}

struct PlacedTerrain {
    explicit PlacedTerrain(const MadeTerrain& made)
        : PlacedTerrain(made, placed(made.heightfield, made.exaggeration)) {}
    PlacedTerrain(MadeTerrain made, const terrain::Placement& place)
        : name(std::move(made.name)), heightfield(std::move(made.heightfield)), placement(place),
          bisection(heightfield, placement), tiles(terrain::tile_layout(cells_of(heightfield))) {}
    PlacedTerrain(const PlacedTerrain&) = delete;

    std::string name;
    terrain::Heightfield heightfield;
    terrain::Placement placement;
    terrain::Bisection bisection;
    std::vector<terrain::TileCells> tiles;
};

using Triangle = std::array<terrain::Steps, 3>;

/// Of all tiles.
inline std::vector<Triangle> all_triangles(const PlacedTerrain& made,
                                           const terrain::ErrorView& view) {
    std::vector<Triangle> triangles;
    for (const terrain::TileCells& tile : made.tiles) {
        for (const terrain::Triangulation& part :
             terrain::triangulate(made.bisection, tile, view).parts) {
            for (std::size_t i = 0; i < part.indices.size(); i += 3) {
                triangles.push_back({part.vertices[part.indices[i]],
                                     part.vertices[part.indices[i + 1]],
                                     part.vertices[part.indices[i + 2]]});
            }
        }
    }
    return triangles;
}

/// Twice the area, positive where counter-clockwise from above (rows grow downwards).
inline std::int64_t doubled_area(const Triangle& triangle) {
    const terrain::Steps p = triangle[1] - triangle[0];
    const terrain::Steps q = triangle[2] - triangle[0];
    return p.y * q.x - p.x * q.y;
}

/// Edges without their opposite that do not lie on the border of the heightfield.
inline std::size_t open_edges(const PlacedTerrain& made, const std::vector<Triangle>& triangles) {
    using Edge = std::array<std::int64_t, 4>;
    std::vector<Edge> edges;
    std::vector<Edge> opposites;
    const terrain::Steps end = made.bisection.end();
    for (const Triangle& triangle : triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const terrain::Steps a = triangle[i];
            const terrain::Steps b = triangle[(i + 1) % 3];
            const bool on_border = (a.x == b.x && (a.x == 0 || a.x == end.x)) ||
                                   (a.y == b.y && (a.y == 0 || a.y == end.y));
            if (!on_border) {
                edges.push_back({a.x, a.y, b.x, b.y});
                opposites.push_back({b.x, b.y, a.x, a.y});
            }
        }
    }
    std::sort(edges.begin(), edges.end());
    std::sort(opposites.begin(), opposites.end());
    std::vector<Edge> open;
    std::set_symmetric_difference(edges.begin(), edges.end(), opposites.begin(), opposites.end(),
                                  std::back_inserter(open));
    const auto repeated = std::adjacent_find(edges.begin(), edges.end());
    return open.size() + (repeated == edges.end() ? 0 : 1);
}

} // namespace reljef::test
