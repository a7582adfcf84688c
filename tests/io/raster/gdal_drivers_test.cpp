#include "engine/io/raster/gdal_drivers.h"

#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/raster/raster.h"
#include "engine/io/raster/references.h"
#include "engine/io/terrain_file.h"
#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class GdalDrivers : public ::testing::Test {
protected:
    [[nodiscard]] fs::path sparse(const std::string& name, const test::SparseTiff& tiff) const {
        EXPECT_TRUE(test::write(tiff, folder_.path() / name));
        return folder_.path() / name;
    }
    [[nodiscard]] static std::string error_of(const fs::path& path) {
        const auto terrain = read_terrain(path);
        return terrain ? "" : terrain.error().message;
    }

    test::TemporaryFolder folder_;
};

TEST_F(GdalDrivers, ManyInterleavedBandsAskForNoMemory) {
    // 5000 bands are allowed, but one block of them takes 5 GB.
    const fs::path path =
        sparse("a.tif", {1000, 1000, 5000, {"INTERLEAVE=PIXEL", "BLOCKYSIZE=1000"}});
    EXPECT_THAT(error_of(path), HasSubstr("blocks of 1000×1000 samples of 5000 bands"));
    RasterOptions options;
    options.imagery = {path};
    const auto ground = test::made_raster(8, 8, [](int col, int) { return col; });
    ASSERT_TRUE(test::write(ground, folder_.path() / "ground.tif"));
    const auto draped = read_terrain(folder_.path() / "ground.tif", options);
    ASSERT_FALSE(draped);
    EXPECT_THAT(draped.error().message, HasSubstr("samples of 5000 bands"));
    const auto virtual_raster = folder_.write(
        "a.vrt", R"(<VRTDataset rasterXSize="8" rasterYSize="8"><VRTRasterBand dataType="Byte" )"
                 R"(band="1"><SimpleSource><SourceFilename relativeToVRT="1">a.tif)"
                 R"(</SourceFilename><SourceProperties RasterXSize="8" RasterYSize="8" )"
                 R"(DataType="Byte" BlockXSize="8" BlockYSize="8"/></SimpleSource></VRTRasterBand>)"
                 "</VRTDataset>");
    EXPECT_THAT(error_of(virtual_raster), HasSubstr("samples of 5000 bands"));
    const fs::path archive = folder_.path() / "a.zip";
    ASSERT_TRUE(test::add_to_zip(archive, "a.tif", test::read_bytes(path)));
    EXPECT_THAT(error_of(archive), HasSubstr("samples of 5000 bands"));
}

TEST_F(GdalDrivers, MoreBandsThanAnyPictureHasAreRefused) {
    EXPECT_THAT(error_of(sparse("a.tif", {8, 8, 32769, {"INTERLEAVE=PIXEL"}})),
                HasSubstr("has 32769 bands, at most 10000 were expected"));
}

TEST_F(GdalDrivers, ManySmallBandsAreNoError) {
    const GdalMessages messages;
    for (const char* const order : {"INTERLEAVE=PIXEL", "INTERLEAVE=BAND"}) {
        const auto raster = open_raster(sparse("a.tif", {100, 100, 5000, {order}}), messages);
        EXPECT_TRUE(raster) << raster.error().message;
    }
}

TEST_F(GdalDrivers, ALargeSparseRasterIsNoError) {
    const GdalMessages messages;
    const auto raster = open_raster(sparse("a.tif", {65536, 65536, 1, {"TILED=YES"}}), messages);
    EXPECT_TRUE(raster) << raster.error().message;
}

TEST_F(GdalDrivers, OverviewsAndMasksInHugeBlocksAreNotRead) {
    for (const char* const extension : {".ovr", ".msk"}) {
        const auto ground = test::made_raster(64, 64, [](int col, int) { return col; });
        ASSERT_TRUE(test::write(ground, folder_.path() / "b.tif"));
        const fs::path side =
            sparse(std::string("b.tif") + extension,
                   {20000, 20000, 1, {"TILED=YES", "BLOCKXSIZE=20000", "BLOCKYSIZE=20000"}});
        const GdalMessages messages;
        const auto raster = open_raster(folder_.path() / "b.tif", messages);
        ASSERT_TRUE(raster) << raster.error().message;
        EXPECT_EQ((*raster)->GetRasterBand(1)->GetOverviewCount(), 0);
        EXPECT_GT(messages.errors(), 0U);
        fs::remove(side);
    }
}

TEST_F(GdalDrivers, APictureThatIsReadWholeIsCheckedByItsSize) {
    // A lossless WebP header: 14 bits of each side less one.
    const unsigned sides = 16382U | (16382U << 14U);
    std::string webp = "RIFF";
    const auto put32 = [&](unsigned value) {
        for (int shift = 0; shift < 32; shift += 8) {
            webp += static_cast<char>((value >> static_cast<unsigned>(shift)) & 0xFFU);
        }
    };
    put32(60);
    webp += "WEBPVP8L";
    put32(48);
    webp += '\x2f';
    put32(sides);
    webp.resize(68, '\0');
    EXPECT_THAT(error_of(folder_.write("a.webp", webp)), HasSubstr("read whole"));
}

TEST_F(GdalDrivers, AReprojectionThatReadsAllOfItsSourceAsksForNoMemory) {
    static_cast<void>(sparse("a.tif", {65536, 65536, 1, {"TILED=YES"}}));
    const auto warped = [&](int side) {
        return folder_.write(
            "a.vrt",
            fmt::format(R"(<VRTDataset rasterXSize="{0}" rasterYSize="{0}" )"
                        R"(subClass="VRTWarpedDataset"><VRTRasterBand dataType="Byte" band="1" )"
                        R"(subClass="VRTWarpedRasterBand"/><BlockXSize>128</BlockXSize>)"
                        R"(<BlockYSize>128</BlockYSize><GDALWarpOptions><SourceDataset )"
                        R"(relativeToVRT="1">a.tif</SourceDataset></GDALWarpOptions></VRTDataset>)",
                        side));
    };
    EXPECT_THAT(error_of(warped(128)), HasSubstr("reprojects 4.3 GB of its source at once"));
    EXPECT_TRUE(check_references(warped(65536).string()));
}

TEST_F(GdalDrivers, FormatsThatAreNotListedAreRefused) {
    EXPECT_TRUE(has_format(sparse("a.tif", {8, 8, 1, {}}).string()));
    for (const char* const format : {"netCDF", "HDF5", "WMS", "HTTP", "GPKG", "MRF", "STACTA"}) {
        EXPECT_EQ(format_names().FindString(format), -1) << format;
    }
    auto raster = test::made_raster(8, 8, [](int col, int) { return col; });
    raster.format = "netCDF";
    if (test::write(raster, folder_.path() / "a.nc")) {
        EXPECT_THAT(error_of(folder_.path() / "a.nc"), HasSubstr("cannot be opened"));
        allow_external(true);
        EXPECT_EQ(error_of(folder_.path() / "a.nc"), "");
        allow_external(false);
    }
}

} // namespace
} // namespace reljef::io
