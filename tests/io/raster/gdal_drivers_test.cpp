#include "engine/io/raster/gdal_drivers.h"

#include <array>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include <cpl_conv.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/raster/raster.h"
#include "engine/io/raster/references.h"
#include "engine/io/remote/read_scope.h"
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
        GDALRasterBand& band = *(*raster)->GetRasterBand(1);
        EXPECT_EQ(band.GetOverviewCount(), 0);
        EXPECT_EQ(band.GetMaskFlags(), GMF_ALL_VALID);
        EXPECT_GT(messages.errors(), 0U);
        fs::remove(side);
    }
}

/// Sets a number in a directory of a TIFF with little-endian 32-bit offsets.
void set_tag(std::string& tiff, int directory, unsigned tag, unsigned value) {
    const auto number = [&](std::size_t at, std::size_t bytes) {
        std::size_t sum = 0;
        for (std::size_t i = bytes; i-- > 0;) {
            sum = sum * 256 + static_cast<unsigned char>(tiff.at(at + i));
        }
        return sum;
    };
    std::size_t at = number(4, 4);
    for (int i = 0; i < directory; ++i) {
        at = number(at + 2 + 12 * number(at, 2), 4);
    }
    ASSERT_NE(at, 0U);
    for (std::size_t entry = at + 2; entry < at + 2 + 12 * number(at, 2); entry += 12) {
        if (number(entry, 2) == tag) {
            tiff.at(entry + 8) = static_cast<char>(value % 256);
            tiff.at(entry + 9) = static_cast<char>(value / 256);
            return;
        }
    }
    FAIL() << "no tag " << tag;
}

/// The bytes of a TIFF of 512 by 512 samples with a mask, band by band in tiles.
std::string masked_tiff(const fs::path& path, int bands, bool has_overviews) {
    const test::QuietGdal quiet;
    const CPLConfigOptionSetter internal("GDAL_TIFF_INTERNAL_MASK", "YES", false);
    test::MadeRaster raster = test::made_raster(512, 512 * bands, [](int col, int) { return col; });
    raster.rows = 512;
    raster.bands = bands;
    raster.options = {"TILED=YES", "INTERLEAVE=BAND"};
    EXPECT_TRUE(test::write(raster, path));
    const Dataset dataset(GDALDataset::Open(path.c_str(), GDAL_OF_UPDATE));
    EXPECT_EQ(dataset->CreateMaskBand(GMF_PER_DATASET), CE_None);
    std::array factors{2};
    if (has_overviews) {
        EXPECT_EQ(
            dataset->BuildOverviews("NEAREST", 1, factors.data(), 0, nullptr, nullptr, nullptr),
            CE_None);
    }
    dataset->FlushCache(true);
    return test::read_bytes(path);
}

TEST_F(GdalDrivers, InternalOverviewsAndMasksInHugeBlocksAreNotRead) {
    constexpr unsigned tile_width = 322;
    constexpr unsigned tile_length = 323;
    constexpr unsigned samples_per_pixel = 277;
    const auto error_with = [&](std::string tiff, int directory, unsigned side, unsigned bands) {
        set_tag(tiff, directory, tile_width, side);
        set_tag(tiff, directory, tile_length, side);
        set_tag(tiff, directory, samples_per_pixel, bands);
        return error_of(folder_.write("d.tif", tiff));
    };
    const std::string one = masked_tiff(folder_.path() / "a.tif", 1, true);
    for (int directory = 0; directory < 4; ++directory) { // the raster, its mask, their overviews
        EXPECT_THAT(error_with(one, directory, 256, 1), testing::Not(HasSubstr("blocks")));
        EXPECT_THAT(error_with(one, directory, 20000, 1), HasSubstr("blocks of 20000×20000"))
            << directory;
    }
    // The bands of the mask are interleaved, those of the raster are not.
    const std::string five = masked_tiff(folder_.path() / "b.tif", 5, false);
    EXPECT_THAT(error_with(five, 1, 8192, 1), testing::Not(HasSubstr("blocks")));
    EXPECT_THAT(error_with(five, 1, 8192, 5), HasSubstr("samples of 5 bands"));
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
    static_cast<void>(sparse("b.tif", {10000, 10000, 1, {"TILED=YES"}}));
    const auto warped = [&](const char* source, const char* type) {
        return folder_.write(
            "a.vrt",
            fmt::format(R"(<VRTDataset rasterXSize="65536" rasterYSize="65536" )"
                        R"(subClass="VRTWarpedDataset"><VRTRasterBand dataType="Byte" band="1" )"
                        R"(subClass="VRTWarpedRasterBand"/><BlockXSize>128</BlockXSize>)"
                        R"(<BlockYSize>128</BlockYSize><GDALWarpOptions><WorkingDataType>{}<)"
                        R"(/WorkingDataType><SourceDataset relativeToVRT="1">{}</SourceDataset>)"
                        "</GDALWarpOptions></VRTDataset>",
                        type, source));
    };
    // Blocks need small shares of the source, but the transformation may place all in one.
    EXPECT_THAT(error_of(warped("a.tif", "Byte")), HasSubstr("reprojects a source of 4.3 GB"));
    EXPECT_THAT(error_of(warped("b.tif", "Float64")), HasSubstr("reprojects a source of 800.0 MB"));
    EXPECT_TRUE(check_references(warped("b.tif", "Byte").string()));
}

TEST_F(GdalDrivers, FormatsThatMayNameOtherFilesAreNotOpenedOnServers) {
    for (const char* const format : {"VRT", "HFA", "RST", "EHdr", "ENVI", "AIG", "SAGA"}) {
        EXPECT_EQ(single_file_formats().FindString(format), -1) << format;
    }
    EXPECT_GE(single_file_formats().FindString("GTiff"), 0);
}

TEST_F(GdalDrivers, EveryReadOfAWindowEndsAtAStop) {
    const GdalMessages messages;
    auto raster = open_raster(sparse("a.tif", {64, 64, 1, {}}), messages);
    ASSERT_TRUE(raster) << raster.error().message;
    std::vector<double> values(std::size_t{64} * 64);
    const BandWindow window{{}, glm::ivec2(64), values.data(), glm::ivec2(64)};
    EXPECT_TRUE(read_window(*(*raster)->GetRasterBand(1), window));
    std::stop_source stop;
    stop.request_stop();
    const ReadScope scope(stop.get_token());
    EXPECT_FALSE(read_window(*(*raster)->GetRasterBand(1), window));
}

TEST_F(GdalDrivers, AnArchiveOfManyEntriesIsNotListedWhole) {
    const fs::path archive = folder_.path() / "a.zip";
    void* const writer = CPLCreateZip(archive.c_str(), nullptr);
    ASSERT_NE(writer, nullptr);
    for (int i = 0; i <= 2'000; ++i) {
        ASSERT_EQ(CPLCreateFileInZip(writer, fmt::format("d/{}.tif", i).c_str(), nullptr), CE_None);
        ASSERT_EQ(CPLCloseFileInZip(writer), CE_None);
    }
    ASSERT_EQ(CPLCloseZip(writer), CE_None);
    EXPECT_THAT(error_of(archive), HasSubstr("has no raster among its first 1000 files"));
    std::stop_source stop;
    stop.request_stop();
    const ReadScope scope(stop.get_token());
    EXPECT_THAT(error_of(archive), HasSubstr("reading was stopped"));
}

TEST_F(GdalDrivers, FormatsThatAreNotListedAreRefused) {
    EXPECT_TRUE(has_format(sparse("a.tif", {8, 8, 1, {}}).string()));
    for (const char* const format :
         {"netCDF", "HDF5", "WMS", "HTTP", "GPKG", "MRF", "STACTA", "GIF"}) {
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
