// Windows of a folder whose files are in several coordinate systems.
#include "engine/io/tile_set.h"

#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

constexpr double step = 30.0; // metres
constexpr int side = 200;     // samples

/// Rough ground in a zone of UTM.
void write_tile(const test::TemporaryFolder& folder, const std::string& name, int zone,
                glm::dvec2 corner) {
    auto raster = test::made_raster(side, side, [](int col, int row) {
        return 700.0 + 300.0 * std::sin(1.7 * col) * std::cos(2.3 * row);
    });
    raster.crs = fmt::format("EPSG:{}", 32600 + zone);
    raster.geotransform = {corner.x, step, 0.0, corner.y, 0.0, -step};
    ASSERT_TRUE(test::write(raster, folder.path() / name));
}

TEST(TileWindow, ASampleHasTheSameHeightInAllWindowsToTheLastDigit) {
    const test::TemporaryFolder folder;
    write_tile(folder, "west.tif", 32, {735000.0, 5030000.0});
    write_tile(folder, "east.tif", 33, {263000.0, 5030000.0});
    const auto tiles = TileSet::open(folder.path());
    ASSERT_TRUE(tiles) << tiles.error().message;
    const TileGrid whole = tiles->grid();
    const Grid<double> heights = tiles->read(whole, Gaps::holes).heights;
    std::mt19937 random(9);
    const auto below = [&](int count) {
        return std::uniform_int_distribution<int>(0, count - 1)(random);
    };
    int compared = 0;
    for (int i = 0; i < 200; ++i) {
        TileGrid window = whole;
        const glm::ivec2 first(below(whole.cols), below(whole.rows));
        window.first = whole.first + whole.step * glm::dvec2(first);
        window.cols = std::min(1 + below(70), whole.cols - first.x);
        window.rows = std::min(1 + below(70), whole.rows - first.y);
        const Grid<double> found = tiles->read(window, Gaps::holes).heights;
        for (int row = 0; row < window.rows; ++row) {
            for (int col = 0; col < window.cols; ++col) {
                const double expected = heights(first.x + col, first.y + row);
                if (!std::isnan(expected) || !std::isnan(found(col, row))) {
                    ASSERT_EQ(found(col, row), expected) << i << ": " << col << ", " << row;
                    ++compared;
                }
            }
        }
    }
    EXPECT_GT(compared, 50'000);
}

} // namespace
} // namespace reljef::io
