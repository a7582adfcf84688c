#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "terrains/generators.h"

namespace reljef::terrains {
namespace {

using building::CityForm;

City city_of(CityForm form, const GeneratorOptions& options) {
    auto city = generate_city(options, form);
    EXPECT_TRUE(city);
    return std::move(*city);
}

double cross(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

// Raises samples to the triangle above them.
void raise(Grid<float>& tops, const std::array<glm::dvec3, 3>& corners, double spacing) {
    const double half = 0.5 * (tops.cols() - 1);
    const auto sample_of = [&](glm::dvec3 at) {
        return glm::dvec2(at.x / spacing + half, half - at.y / spacing);
    };
    const glm::dvec2 a = sample_of(corners[0]);
    const glm::dvec2 b = sample_of(corners[1]);
    const glm::dvec2 c = sample_of(corners[2]);
    const double area = cross(b - a, c - a);
    if (area == 0.0) {
        return; // upright
    }
    const glm::dvec2 low = glm::min(glm::min(a, b), c);
    const glm::dvec2 high = glm::max(glm::max(a, b), c);
    for (int row = static_cast<int>(std::ceil(low.y)); row <= static_cast<int>(high.y); ++row) {
        for (int col = static_cast<int>(std::ceil(low.x)); col <= static_cast<int>(high.x); ++col) {
            const glm::dvec2 place(col, row);
            const double u = cross(b - place, c - place) / area;
            const double v = cross(c - place, a - place) / area;
            if (u >= 0.0 && v >= 0.0 && u + v <= 1.0) {
                const double z = u * corners[0].z + v * corners[1].z + (1.0 - u - v) * corners[2].z;
                tops(col, row) = std::max(tops(col, row), static_cast<float>(z));
            }
        }
    }
}

constexpr float nothing = -100.0F;

// z of the highest face over each sample.
Grid<float> tops_of(const City& city) {
    const auto& field = city.terrain.heightfield;
    Grid<float> tops(field.heights.cols(), field.heights.rows(), nothing);
    for (const building::PaintedFaces& building : city.buildings) {
        for (const building::Face& face : building.faces) {
            for (std::size_t i = 1; i + 1 < face.corners.size(); ++i) {
                raise(tops,
                      {building.origin + face.corners[0], building.origin + face.corners[i],
                       building.origin + face.corners[i + 1]},
                      field.spacing.x);
            }
        }
    }
    return tops;
}

TEST(UrbanMeshes, AreAsHighAsTheHeightsOfTheSameCity) {
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        const GeneratorOptions options{
            .size = 600, .seed = seed, .walls = building::CityWalls::stepped};
        const City heights = city_of(CityForm::heights, options);
        const City meshes = city_of(CityForm::meshes, options);
        const Grid<float> tops = tops_of(meshes);
        const auto& full = heights.terrain.heightfield.heights;
        const auto& bare = meshes.terrain.heightfield.heights;
        int buildings = 0;
        int ground = 0;
        int wrong = 0;
        for (int row = 1; row < 599; ++row) {
            for (int col = 1; col < 599; ++col) {
                int raised = 0; // of the samples around
                for (int i = 0; i < 9; ++i) {
                    const glm::ivec2 at(col + i % 3 - 1, row + i / 3 - 1);
                    raised += full(at.x, at.y) > bare(at.x, at.y) + 1.0F ? 1 : 0;
                }
                const float top = std::max(tops(col, row), bare(col, row));
                buildings += raised == 9 ? 1 : 0;
                ground += raised == 0 ? 1 : 0;
                wrong += (raised == 9 || raised == 0) && std::abs(top - full(col, row)) > 0.5F;
            }
        }
        EXPECT_GT(buildings, 50'000) << seed;
        EXPECT_GT(ground, 50'000) << seed;
        // Trees over roofs, borders of boxes on roofs, and what the warp bends.
        EXPECT_LT(wrong, (buildings + ground) / 50) << seed;
    }
}

TEST(UrbanMeshes, EndAtTheBorderOfTheTerrain) {
    const City city = city_of(CityForm::meshes, {.size = 300, .seed = 7});
    const double half = 0.5 * 299 * 0.5;
    for (const building::PaintedFaces& building : city.buildings) {
        for (const building::Face& face : building.faces) {
            EXPECT_TRUE(face.facade.empty() || face.facade.size() == face.corners.size());
            for (const glm::dvec3 corner : face.corners) {
                EXPECT_LE(std::abs(building.origin.x + corner.x), half + 1e-9);
                EXPECT_LE(std::abs(building.origin.y + corner.y), half + 1e-9);
            }
        }
    }
}

TEST(UrbanMeshes, HaveTheSameBitsOnAnyNumberOfThreads) {
    const City one = city_of(CityForm::meshes, {.size = 200, .seed = 5, .threads = 1});
    const City two = city_of(CityForm::meshes, {.size = 200, .seed = 5, .threads = 2});
    EXPECT_EQ(one.terrain.heightfield.heights, two.terrain.heightfield.heights);
    EXPECT_EQ(one.terrain.color, two.terrain.color);
    ASSERT_EQ(one.buildings.size(), two.buildings.size());
    for (std::size_t i = 0; i < one.buildings.size(); ++i) {
        ASSERT_EQ(one.buildings[i].faces.size(), two.buildings[i].faces.size());
        EXPECT_EQ(one.buildings[i].faces[0].corners, two.buildings[i].faces[0].corners);
    }
}

TEST(UrbanMeshes, AloneStandOnALevelPlane) {
    const GeneratorOptions options{.size = 200, .seed = 5};
    const City alone = city_of(CityForm::meshes_only, options);
    const City ground = city_of(CityForm::meshes, options);
    const auto samples = alone.terrain.heightfield.heights.samples();
    EXPECT_TRUE(std::all_of(samples.begin(), samples.end(), [](float h) { return h == 0.0F; }));
    EXPECT_EQ(alone.terrain.color, ground.terrain.color);
    EXPECT_EQ(alone.buildings.size(), ground.buildings.size());
    EXPECT_TRUE(city_of(CityForm::heights, options).buildings.empty());
}

} // namespace
} // namespace reljef::terrains
