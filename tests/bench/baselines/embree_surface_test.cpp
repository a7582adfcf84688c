#include "bench/baselines/embree/embree_surface.h"

#include <cmath>

#include <gtest/gtest.h>

namespace reljef::bench {
namespace {

// A slope to the east over 5 × 4 samples, 10 m apart; its middle is at the origin.
Grid<glm::vec3> slope() {
    Grid<glm::vec3> vertices(5, 4);
    for (int row = 0; row < 4; ++row) {
        for (int col = 0; col < 5; ++col) {
            vertices(col, row) = {10.0F * static_cast<float>(col) - 20.0F,
                                  15.0F - 10.0F * static_cast<float>(row),
                                  2.0F * static_cast<float>(col)};
        }
    }
    return vertices;
}

scene::Camera camera_above() {
    scene::Camera camera;
    camera.eye = {3.0, -40.0, 60.0};
    camera.target = {0.0, 0.0, 4.0};
    camera.vertical_fov = 60.0;
    return camera;
}

TEST(EmbreeSurface, HitsLieOnTheRaysOfPixels) {
    for (const EmbreeGeometry geometry : {EmbreeGeometry::grid, EmbreeGeometry::quads}) {
        const Grid<glm::vec3> vertices = slope();
        const auto surface = EmbreeSurface::create(vertices.view(), geometry, 2);
        ASSERT_TRUE(surface) << surface.error().message;
        const glm::ivec2 size(50, 39); // no whole packets
        const HitBuffer hits = surface->draw_hits(camera_above(), size);
        int shown = 0;
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                const Hit& hit = hits(x, y);
                if (hit.is_sky()) {
                    continue;
                }
                ++shown;
                const Ray ray = scene::view_ray(camera_above(), size, glm::dvec2(x, y) + 0.5);
                const glm::dvec3 place = ray.at(hit.depth);
                ASSERT_NEAR(hit.place().x, (place.x + 20.0) / 10.0, 1e-4) << to_string(geometry);
                ASSERT_NEAR(hit.place().y, (15.0 - place.y) / 10.0, 1e-4) << to_string(geometry);
                ASSERT_NEAR(hit.height, 2.0 * hit.place().x, 1e-3);
            }
        }
        EXPECT_GT(shown, 200);
        EXPECT_LT(shown, size.x * size.y);
    }
}

TEST(EmbreeSurface, TooLongAGridIsAnError) {
    const Grid<glm::vec3> vertices(32768, 2);
    const auto grid = EmbreeSurface::create(vertices.view(), EmbreeGeometry::grid, 1);
    ASSERT_FALSE(grid);
    EXPECT_NE(grid.error().message.find("32767"), std::string::npos) << grid.error().message;
}

} // namespace
} // namespace reljef::bench
