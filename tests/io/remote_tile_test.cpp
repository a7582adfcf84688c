// Tiles from a server on the loopback that is slow, fails, lies, and recovers.
#include <algorithm>
#include <atomic>
#include <optional>

#include <cpl_conv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/parallel_for.h"
#include "engine/io/image/image.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/tree_tile.h"
#include "tests/io/made_raster.h"
#include "tests/support/nginx.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;

class RemoteTiles : public ::testing::Test {
protected:
    RemoteTiles() : tree_(side, side) {
        register_drivers();
        CPLSetConfigOption("GDAL_HTTP_RETRY_DELAY", "0.01"); // seconds
    }
    ~RemoteTiles() override { CPLSetConfigOption("GDAL_HTTP_RETRY_DELAY", "1"); }
    void SetUp() override {
        RELJEF_NEED_NGINX();
        // Another reader of TIFFs takes none of GDAL's errors away.
        static_cast<void>(read_image(folder_.write("another.tif", "no picture")));
        write("dem.tif");
        server_.emplace(folder_.path());
    }
    void write(const std::string& name) const {
        auto raster = test::made_raster(side, side, [](int col, int row) { return col + 2 * row; });
        raster.crs = "EPSG:32631";
        raster.geotransform = {300000.0, 10.0, 0.0, 5600000.0, 0.0, -10.0};
        raster.options = {"TILED=YES", "BLOCKXSIZE=128", "BLOCKYSIZE=128"};
        raster.overviews = {2, 4};
        ASSERT_TRUE(test::write(raster, folder_.path() / name));
    }
    [[nodiscard]] static TileSet open(const std::filesystem::path& name) {
        auto tiles = TileSet::open(name);
        EXPECT_TRUE(tiles) << (tiles ? "" : tiles.error().message);
        return std::move(*tiles);
    }
    [[nodiscard]] TileWindow read(const TileSet& tiles, terrain::TreeTile tile) const {
        return read_tree_tile(tiles, {tiles.grid()}, tree_, tile, Gaps::holes);
    }
    void expect_good(const TileSet& tiles) const {
        const auto window = read(tiles, {0, 5, 5});
        ASSERT_TRUE(window.errors.empty()) << window.errors.front().message;
        EXPECT_EQ(window.heights(1, 1), (5 + 2 * 5) * terrain::tree_tile_cells);
    }
    void expect_fault(const TileSet& tiles, const std::string& name) const {
        const auto window = read(tiles, {0, 5, 5});
        ASSERT_EQ(window.errors.size(), 1U);
        EXPECT_THAT(window.errors.front().message, HasSubstr(name));
    }

    static constexpr int side = 1000;
    test::TemporaryFolder folder_;
    std::optional<test::Nginx> server_;
    terrain::TileTree tree_;
};

TEST_F(RemoteTiles, AreThoseOfTheLocalFileToTheBitAndOnlyTheirPartsAreFetched) {
    const TileSet local = open(folder_.path() / "dem.tif");
    const TileSet remote = open(server_->url("dem.tif"));
    for (const terrain::TreeTile tile : {terrain::TreeTile{0, 6, 6}, {1, 2, 3}, {2, 0, 0}}) {
        const auto there = read(local, tile);
        const auto come = read(remote, tile);
        ASSERT_TRUE(come.errors.empty()) << come.errors.front().message;
        EXPECT_TRUE(std::ranges::equal(come.heights.samples(), there.heights.samples()));
    }
    EXPECT_GT(server_->bytes_sent(), 128U * 128U * 4U);
    // Once, the coarsest overview is searched for undeclared voids.
    constexpr std::size_t overview_bytes = sizeof(float) * (side / 4) * (side / 4);
    EXPECT_LT(server_->bytes_sent(),
              std::filesystem::file_size(folder_.path() / "dem.tif") / 2 + overview_bytes);
}

TEST_F(RemoteTiles, AreFaultsWhileTheServerFailsAndThereOnceItHasRecovered) {
    int number = 0;
    for (const std::string fault : {"return 404;", "return 500;", "return 444;"}) {
        const std::string name = "dem" + std::to_string(number++) + ".tif"; // nothing is cached
        std::filesystem::copy_file(folder_.path() / "dem.tif", folder_.path() / name);
        const TileSet tiles = open(server_->url(name));
        server_->serve_by(fault);
        expect_fault(tiles, name);
        server_->serve_by("");
        expect_good(tiles);
    }
}

TEST_F(RemoteTiles, AreFaultsWhereTheServerHangs) {
    RELJEF_RELEASE_ONLY("waits for seconds");
    CPLSetConfigOption("GDAL_HTTP_LOW_SPEED_TIME", "1"); // seconds
    const TileSet tiles = open(server_->url("dem.tif"));
    server_->serve_by("location = /dem.tif { limit_rate 1; }"); // byte a second
    expect_fault(tiles, "dem.tif");                             // all of it would come within days
    CPLSetConfigOption("GDAL_HTTP_LOW_SPEED_TIME", "10");
}

TEST_F(RemoteTiles, AreFaultsWhileTheServerLiesAboutTheLength) {
    server_->serve_by(test::remembered_lengths);
    const TileSet tiles = open(server_->url("dem.tif"));
    const auto file = folder_.path() / "dem.tif";
    const std::string whole = test::read_bytes(file);
    std::filesystem::resize_file(file, whole.size() / 3);
    expect_fault(tiles, "dem.tif");
    folder_.write("dem.tif", whole);
    expect_good(tiles);
}

// One short outage that many threads meet at once is one failure, not as many as they are.
TEST_F(RemoteTiles, AreThereAtOnceAfterAShortOutageThatManyThreadsMet) {
    const TileSet tiles = open(server_->url("dem.tif"));
    server_->serve_by("return 404;");
    std::atomic<int> failed{0};
    parallel_for(16,
                 [&](int i) {
                     const TileWindow window = read(tiles, {0, i % 4, i / 4});
                     failed += window.errors.empty() ? 0 : 1;
                     if (window.errors.empty()) { // all that is needed has come before
                         EXPECT_EQ(window.heights(1, 1), (i % 4) * 128 + 2 * (i / 4) * 128);
                         EXPECT_EQ(window.heights(128, 128),
                                   (i % 4) * 128 + 127 + 2 * ((i / 4) * 128 + 127));
                     }
                 },
                 {.threads = 4, .stop = {}, .progress = {}});
    EXPECT_GE(failed, 4);
    server_->serve_by("");
    expect_good(tiles);
}

} // namespace
} // namespace reljef::io
