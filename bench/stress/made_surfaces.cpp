#include "bench/stress/made_surfaces.h"

#include <cmath>
#include <random>
#include <utility>

namespace reljef::bench {

terrain::Terrain made_terrain(std::string name, glm::ivec2 size, double spacing,
                              const HeightAt& height_at) {
    terrain::Terrain terrain;
    terrain.name = std::move(name);
    terrain::Heightfield& field = terrain.heightfield;
    field.heights = Grid<float>(size.x, size.y);
    for (int row = 0; row < size.y; ++row) {
        for (int col = 0; col < size.x; ++col) {
            field.heights(col, row) = static_cast<float>(height_at(col, row));
        }
    }
    field.range = terrain::height_range(field.heights, field.void_mask);
    field.spacing = glm::dvec2(spacing);
    return terrain;
}

terrain::Terrain made_hills(glm::ivec2 size, double spacing, double height) {
    return made_terrain("hills", size, spacing, [height](int col, int row) {
        return height * (0.6 * std::sin(0.13 * col + 0.4) * std::cos(0.11 * row) +
                         0.4 * std::sin(0.05 * col - 0.07 * row));
    });
}

std::vector<terrain::Terrain> odd_terrains() {
    constexpr double spacing = 2.0; // metres
    std::mt19937 random(3);
    std::vector<terrain::Terrain> all;
    const auto add = [&](const char* name, glm::ivec2 size, const HeightAt& height_at) {
        all.push_back(made_terrain(name, size, spacing, height_at));
    };
    add("level", {40, 30}, [](int, int) { return 7.0; });
    add("spike", {33, 33}, [](int col, int row) { return col == 16 && row == 16 ? 20.0 : 0.0; });
    add("checkerboard", {64, 64}, [](int col, int row) { return (col + row) % 2; });
    add("cliffs", {90, 70},
        [](int col, int row) { return (col / 7 + row / 9) % 3 == 0 ? 15.0 : 0.0; });
    add("noise", {65, 65},
        [&](int, int) { return 8.0 * static_cast<double>(random()) / 4294967296.0; });
    add("2x2", {2, 2}, [](int col, int row) { return 0.3 * col * row; });
    add("2x200", {2, 200}, [](int, int row) { return 0.1 * (row % 13); });
    add("65536x2", {65536, 2}, [](int col, int) { return 30.0 * std::sin(0.01 * col); });
    add("prime", {127, 101},
        [](int col, int row) { return 5.0 * std::sin(0.2 * col) * std::cos(0.3 * row); });
    return all;
}

} // namespace reljef::bench
