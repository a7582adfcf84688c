#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "engine/io/raster/raster.h"
#include "engine/io/terrain_file.h"
#include "tests/app/command_line.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef {
namespace {

// Everything below is written out here on its own: no placement, camera or interpolation of the
// engine.
class HitFile : public testing::Test {
protected:
    static constexpr int width = 640;
    static constexpr int height = 480;
    static constexpr double fov = 57.3;

    static glm::dvec2 projected(glm::dvec3 eye, glm::dvec3 look, glm::dvec3 point) {
        const glm::dvec3 forward = unit(look - eye);
        const glm::dvec3 right = unit(cross(forward, {0.0, 0.0, 1.0}));
        const glm::dvec3 up = cross(right, forward);
        const glm::dvec3 p = point - eye;
        const double scale = height / (2.0 * std::tan(fov * M_PI / 360.0)) / dot(p, forward);
        return {0.5 * width + scale * dot(p, right), 0.5 * height - scale * dot(p, up)};
    }
    static double dot(glm::dvec3 a, glm::dvec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    static glm::dvec3 cross(glm::dvec3 a, glm::dvec3 b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    /// How much ground one pixel covers, in metres: the furthest hit of its four neighbours.
    static double footprint(const HitBuffer& hits, glm::ivec2 pixel, glm::dvec2 spacing) {
        const Hit& here = hits(pixel.x, pixel.y);
        double furthest = 0.0;
        for (const glm::ivec2 step :
             {glm::ivec2(-1, 0), glm::ivec2(1, 0), glm::ivec2(0, -1), glm::ivec2(0, 1)}) {
            const glm::ivec2 next =
                glm::clamp(pixel + step, glm::ivec2(0), glm::ivec2(width - 1, height - 1));
            const Hit& there = hits(next.x, next.y);
            if (!there.is_sky()) {
                furthest = std::max(furthest, std::hypot((there.col - here.col) * spacing.x,
                                                         (there.row - here.row) * spacing.y));
            }
        }
        return furthest;
    }
    /// The steepest edge of a cell and its eight neighbours.
    static double steepest(const Grid<float>& z, glm::ivec2 cell, glm::dvec2 spacing) {
        double slope = 0.0;
        for (int r = std::max(cell.y - 1, 0); r <= std::min(cell.y + 2, z.rows() - 2); ++r) {
            for (int c = std::max(cell.x - 1, 0); c <= std::min(cell.x + 2, z.cols() - 2); ++c) {
                slope = std::max({slope, std::abs(z(c + 1, r) - z(c, r)) / spacing.x,
                                  std::abs(z(c, r + 1) - z(c, r)) / spacing.y});
            }
        }
        return slope;
    }
    static glm::dvec3 unit(glm::dvec3 a) { return a / std::sqrt(dot(a, a)); }
};

TEST_F(HitFile, agrees_with_the_heightfield_at_the_shown_points) {
    RELJEF_NEED_DATA("natural/srtm3/N45E006.hgt");
    const auto dem = test::data_path("natural/srtm3/N45E006.hgt");
    const test::TemporaryFolder folder;
    const auto file = (folder.path() / "hit.exr").string();
    const auto run =
        test::reljef({"render", dem.string(), "--placement", "plane", "--eye", "2000,-60000,14000",
                      "--look", "0,-20000,1000", "--size", "640x480", "--max-error", "none",
                      "--context", "osmesa", "--hit", file});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto hits = io::read_hits(file);
    ASSERT_TRUE(hits) << hits.error().message;
    const auto terrain = io::read_terrain(dem);
    ASSERT_TRUE(terrain);
    const Grid<float>& z = terrain->heightfield.heights;
    const glm::dvec2 spacing = terrain->heightfield.spacing;
    int shown = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Hit hit = (*hits)(x, y);
            if (hit.is_sky()) {
                EXPECT_EQ(hit.col, -1.0F);
                continue;
            }
            ++shown;
            const int c = std::min(static_cast<int>(hit.col), 1199);
            const int r = std::min(static_cast<int>(hit.row), 1199);
            const double u = static_cast<double>(hit.col) - c;
            const double v = static_cast<double>(hit.row) - r;
            const double twist = z(c, r) - z(c + 1, r) - z(c, r + 1) + z(c + 1, r + 1);
            const double bilinear =
                z(c, r) + (z(c + 1, r) - z(c, r)) * u + (z(c, r + 1) - z(c, r)) * v + twist * u * v;
            // Two triangles leave the bilinear patch by a quarter of its twist. A rasterizer that
            // snaps vertices to 1/256 pixel shows a place up to that far (under 0.01 px) beyond the
            // triangle, on its plane, which parts from the next one by twice the steepest slope.
            // Places relative to the camera are rounded to float a few times.
            const double beyond = 0.01 * footprint(*hits, {x, y}, spacing);
            ASSERT_NEAR(hit.height, bilinear,
                        0.25 * std::abs(twist) + 2.0 * beyond * steepest(z, {c, r}, spacing) +
                            4.0 * 6e-8 * hit.depth)
                << x << ',' << y;
            const glm::dvec3 place{(hit.col - 600.0) * spacing.x, (600.0 - hit.row) * spacing.y,
                                   hit.height};
            const glm::dvec2 pixel =
                projected({2000.0, -60000.0, 14000.0}, {0.0, -20000.0, 1000.0}, place);
            ASSERT_NEAR(pixel.x, x + 0.5, 0.01) << x << ',' << y;
            ASSERT_NEAR(pixel.y, y + 0.5, 0.01) << x << ',' << y;
        }
    }
    EXPECT_GT(shown, width * height / 3);
}

TEST_F(HitFile, texture_shows_the_flat_reference_surface) {
    RELJEF_RELEASE_ONLY("hits of real tiles are written by the same lines");
    const test::TemporaryFolder folder;
    const auto file = (folder.path() / "hit.exr").string();
    const auto run = test::reljef({"render", test::small_terrain(folder, "natural"), "--technique",
                                   "texture", "--eye", "0,-1200,2200", "--look", "0,0,1000",
                                   "--size", "640x480", "--context", "osmesa", "--hit", file});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto hits = io::read_hits(file);
    ASSERT_TRUE(hits);
    const Hit middle = (*hits)(width / 2, height / 2);
    ASSERT_FALSE(middle.is_sky());
    int shown = 0;
    for (const Hit& hit : hits->samples()) {
        shown += hit.is_sky() ? 0 : 1;
        // One height all over, but for the last bits of its interpolation.
        ASSERT_TRUE(hit.is_sky() || std::abs(hit.height - middle.height) <= 1e-6F * middle.height)
            << hit.height << " and " << middle.height;
    }
    EXPECT_GT(shown, width * height / 3);
}

} // namespace
} // namespace reljef
