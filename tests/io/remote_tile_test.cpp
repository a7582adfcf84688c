// Tiles from a server on the loopback that is slow, fails, and recovers.
#include <atomic>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/worker_pool.h"
#include "engine/io/tree_tile.h"
#include "tests/io/made_raster.h"
#include "tests/support/http_server.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;
using Fault = test::HttpServer::Fault;

class RemoteTiles : public ::testing::Test {
protected:
    RemoteTiles() : server_(folder_.path()), tree_(side, side) {
        auto raster = test::made_raster(side, side, [](int col, int row) { return col + 2 * row; });
        raster.crs = "EPSG:32631";
        raster.geotransform = {300000.0, 10.0, 0.0, 5600000.0, 0.0, -10.0};
        raster.options = {"TILED=YES", "BLOCKXSIZE=128", "BLOCKYSIZE=128"};
        raster.overviews = {2, 4};
        EXPECT_TRUE(test::write(raster, folder_.path() / "dem.tif"));
    }
    [[nodiscard]] TileWindow read(const TileSet& tiles, terrain::TreeTile tile) const {
        return read_tree_tile(tiles, tiles.grid(), tree_, tile, Gaps::holes);
    }

    static constexpr int side = 1000;
    test::TemporaryFolder folder_;
    test::HttpServer server_;
    terrain::TileTree tree_;
};

TEST_F(RemoteTiles, ComeInPartsFromASlowServer) {
    server_.set_delay(20);
    const auto tiles = TileSet::open(server_.url("dem.tif"));
    ASSERT_TRUE(tiles) << tiles.error().message;
    const auto window = read(*tiles, {0, 6, 6});
    ASSERT_TRUE(window.faults.empty()) << window.faults.front().message;
    EXPECT_EQ(window.heights(11, 21), (6 * 128 + 10) + 2 * (6 * 128 + 20));
}

TEST_F(RemoteTiles, AreFaultsWhileTheServerFailsAndThereOnceItHasRecovered) {
    int number = 0;
    for (const Fault fault :
         {Fault::not_found, Fault::server_error, Fault::cut, Fault::lying_length}) {
        const std::string name = "dem" + std::to_string(number++) + ".tif"; // nothing is cached
        std::filesystem::copy_file(folder_.path() / "dem.tif", folder_.path() / name);
        const auto tiles = TileSet::open(server_.url(name));
        ASSERT_TRUE(tiles) << tiles.error().message;
        server_.set_fault(fault);
        const auto failed = read(*tiles, {0, 5, 5});
        if (fault == Fault::lying_length && failed.faults.empty()) {
            EXPECT_EQ(failed.heights(1, 1), 5 * 128 + 2 * 5 * 128); // all of it came, and no more
        } else {
            ASSERT_EQ(failed.faults.size(), 1U) << "fault " << number;
            EXPECT_THAT(failed.faults.front().message, HasSubstr(name));
        }
        server_.set_fault(Fault::none);
        const auto good = read(*tiles, {0, 5, 5});
        ASSERT_TRUE(good.faults.empty()) << good.faults.front().message;
        EXPECT_EQ(good.heights(1, 1), 5 * 128 + 2 * 5 * 128);
    }
}

// One short outage that many threads meet at once is one failure, not as many as they are.
TEST_F(RemoteTiles, AreThereAtOnceAfterAShortOutageThatManyThreadsMet) {
    const auto tiles = TileSet::open(server_.url("dem.tif"));
    ASSERT_TRUE(tiles) << tiles.error().message;
    server_.set_fault(Fault::not_found);
    std::atomic<int> failed{0};
    parallel_for(16,
                 [&](int i) {
                     failed += read(*tiles, {0, i % 4, i / 4}).faults.empty() ? 0 : 1;
                 },
                 {.threads = 4, .stop = {}, .progress = {}});
    EXPECT_GE(failed, 8); // of some tiles all that is needed has come before
    server_.set_fault(Fault::none);
    const auto good = read(*tiles, {0, 5, 5});
    ASSERT_TRUE(good.faults.empty()) << good.faults.front().message;
    EXPECT_EQ(good.heights(1, 1), 5 * 128 + 2 * 5 * 128);
}

} // namespace
} // namespace reljef::io
