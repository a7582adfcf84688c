#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/raster/raster.h"
#include "engine/io/terrain_file.h"
#include "engine/io/tile_set.h"
#include "tests/io/made_raster.h"
#include "tests/support/plain_permissions.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef::io {
namespace {

using test::made_raster;
using test::MadeRaster;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

class BadRaster : public ::testing::Test {
protected:
    /// One line that names the file; returns it.
    static std::string refused(const std::filesystem::path& path) {
        const auto terrain = read_terrain(path);
        EXPECT_FALSE(terrain) << path;
        if (terrain) {
            return {};
        }
        const std::string& message = terrain.error().message;
        EXPECT_EQ(message.rfind(path.string() + ":", 0), 0U) << message;
        EXPECT_THAT(message, HasSubstr("expected"));
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message;
    }
    [[nodiscard]] std::filesystem::path write(const std::string& name,
                                              const std::string& bytes) const {
        return folder_.write(name, bytes);
    }
    [[nodiscard]] std::filesystem::path made(const MadeRaster& raster,
                                             const std::string& name) const {
        EXPECT_TRUE(test::write(raster, folder_.path() / name)) << name;
        return folder_.path() / name;
    }

    test::TemporaryFolder folder_;
};

void put16(std::string& bytes, unsigned value) {
    bytes += static_cast<char>(value & 0xFFU);
    bytes += static_cast<char>((value >> 8U) & 0xFFU);
}

void put32(std::string& bytes, unsigned value) {
    put16(bytes, value & 0xFFFFU);
    put16(bytes, value >> 16U);
}

void put_tag(std::string& bytes, unsigned tag, unsigned type, unsigned value) {
    put16(bytes, tag);
    put16(bytes, type);
    put32(bytes, 1);
    put32(bytes, value);
}

/// A little-endian TIFF of 16-bit samples whose only strip holds 64 bytes, whatever its size
/// claims.
std::string lying_tiff(unsigned cols, unsigned rows, unsigned rows_per_strip) {
    std::string bytes = "II*";
    bytes += '\0';
    put32(bytes, 8);
    put16(bytes, 8);
    put_tag(bytes, 256, 4, cols);
    put_tag(bytes, 257, 4, rows);
    put_tag(bytes, 258, 3, 16);
    put_tag(bytes, 259, 3, 5); // LZW
    put_tag(bytes, 262, 3, 1);
    put_tag(bytes, 273, 4, 200);
    put_tag(bytes, 278, 4, rows_per_strip);
    put_tag(bytes, 279, 4, 64);
    put32(bytes, 0);
    bytes.resize(264, 'x');
    return bytes;
}

TEST_F(BadRaster, Missing) {
    EXPECT_THAT(refused(folder_.path() / "none.tif"), HasSubstr("does not exist"));
}

TEST_F(BadRaster, Empty) {
    EXPECT_THAT(refused(write("a.tif", "")), HasSubstr("is empty"));
}

TEST_F(BadRaster, AFolder) {
    EXPECT_THAT(refused(folder_.path()), HasSubstr("is a folder"));
}

TEST_F(BadRaster, ADevice) {
    EXPECT_THAT(refused("/dev/null"), HasSubstr("no regular file"));
}

TEST_F(BadRaster, Unreadable) {
    // GDAL 3.6.2's driver for .hgt reads what it could not open.
    const auto cell = write("N45E006.hgt", std::string(std::size_t{2} * 1201 * 1201, '\0'));
    const auto image = made(made_raster(4, 4, [](int, int) { return 1; }), "a.tif");
    const test::PlainPermissions plain;
    for (const auto& file : {cell, image}) {
        std::filesystem::permissions(file, std::filesystem::perms::none);
        EXPECT_THAT(refused(file), HasSubstr("cannot be read: Permission denied"));
    }
}

TEST_F(BadRaster, NotARaster) {
    EXPECT_THAT(refused(write("a.tif", "This is a letter.\n")), HasSubstr("cannot be opened"));
    EXPECT_THAT(refused(write("a.txt", "hello")), HasSubstr("cannot be opened"));
    EXPECT_THAT(refused(write("N45E006.hgt", "hello")), HasSubstr("cannot be opened"));
    EXPECT_THAT(refused(write("a.zip", "PK\x03\x04 nothing")), HasSubstr("is no ZIP archive"));
    EXPECT_THAT(refused(write("a.gz", "\x1f\x8b nothing")), HasSubstr("cannot be opened"));
}

TEST_F(BadRaster, InfoRefusesTheSame) {
    EXPECT_FALSE(read_raster_info(folder_.path() / "none.tif"));
    EXPECT_FALSE(read_raster_info(folder_.path()));
    EXPECT_FALSE(read_raster_info(write("a.tif", "This is a letter.\n")));
}

TEST_F(BadRaster, OneSampleOrOneLine) {
    const auto flat = [](int, int) { return 5.0; };
    EXPECT_THAT(refused(made(made_raster(1, 1, flat), "a.tif")),
                HasSubstr("1×1 samples, at least 2×2"));
    EXPECT_THAT(refused(made(made_raster(1, 9, flat), "b.tif")), HasSubstr("1×9"));
    EXPECT_THAT(refused(made(made_raster(9, 1, flat), "c.tif")), HasSubstr("9×1"));
}

TEST_F(BadRaster, TwoByTwoIsEnough) {
    const auto terrain =
        read_terrain(made(made_raster(2, 2, [](int col, int) { return col; }), "a.tif"));
    EXPECT_TRUE(terrain);
}

TEST_F(BadRaster, AllVoid) {
    MadeRaster raster = made_raster(5, 4, [](int, int) { return -9999.0; });
    raster.nodata = -9999.0;
    EXPECT_THAT(refused(made(raster, "a.tif")), HasSubstr("all 5×4 samples are voids"));
    EXPECT_THAT(refused(made(made_raster(5, 4, [](int, int) { return std::nan(""); }), "b.tif")),
                HasSubstr("voids"));
    EXPECT_THAT(refused(made(made_raster(5, 4, [](int, int) { return -32768.0; }), "c.tif")),
                HasSubstr("voids"));
}

TEST_F(BadRaster, VoidsAreCountedInTheFileNotInWhatFitsTheMemory) {
    MadeRaster raster = made_raster(70, 50, [](int, int) { return -9999.0; });
    raster.nodata = -9999.0;
    raster.crs = "EPSG:32631";
    raster.geotransform = {300000.0, 10.0, 0.0, 5600000.0, 0.0, -10.0};
    const std::filesystem::path path = made(raster, "a.tif");
    TileTerrainOptions options;
    options.raster.memory_budget = 20 * 20 * bytes_per_sample;
    const auto terrain = read_terrain(path, options.raster);
    ASSERT_FALSE(terrain);
    EXPECT_THAT(terrain.error().message, HasSubstr("all 70×50 samples are voids"));
    const auto tiles = TileSet::open(path);
    ASSERT_TRUE(tiles) << tiles.error().message;
    const auto of_tiles = tiles->terrain(options);
    ASSERT_FALSE(of_tiles);
    EXPECT_THAT(of_tiles.error().message, HasSubstr("all 70×50 samples are voids"));
}

TEST_F(BadRaster, ImageryThatClaimsGiantBlocksIsRefusedToo) {
    RasterOptions options;
    options.imagery = {write("image.tif", lying_tiff(60000, 60000, 60000))};
    const auto terrain =
        read_terrain(made(made_raster(9, 9, [](int col, int) { return col; }), "a.tif"), options);
    ASSERT_FALSE(terrain);
    EXPECT_THAT(terrain.error().message,
                testing::AllOf(HasSubstr("image.tif"), HasSubstr("blocks of at most")));
}

TEST_F(BadRaster, HeadersThatClaimAHundredThousandSquared) {
    EXPECT_THAT(refused(write("a.tif", lying_tiff(100000, 100000, 100000))),
                AnyOf(HasSubstr("blocks"), HasSubstr("cannot be")));
    EXPECT_THAT(refused(write("b.tif", lying_tiff(100000, 100000, 16))), HasSubstr("cannot be"));
    EXPECT_THAT(refused(write("c.tif", lying_tiff(0x7FFFFFFF, 0x7FFFFFFF, 0x7FFFFFFF))),
                HasSubstr("expected"));
    EXPECT_THAT(refused(write("d.tif", lying_tiff(0, 0, 1))), HasSubstr("cannot be"));
    EXPECT_THAT(refused(write("a.pgm", "P5\n100000 100000\n65535\n0123456789")),
                HasSubstr("cannot be"));
    EXPECT_THAT(refused(write("a.asc", "ncols 100000\nnrows 100000\nxllcorner 0\nyllcorner 0\n"
                                       "cellsize 30\nNODATA_value -9999\n1 2 3 4\n")),
                HasSubstr("cannot be"));
    std::string cut = "ncols 50\nnrows 50\nxllcorner 0\nyllcorner 0\ncellsize 30\n";
    for (int i = 0; i < 2000; ++i) {
        cut += "7 ";
    }
    EXPECT_TRUE(
        read_terrain(write("nan.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\n"
                                      "cellsize 30\nNODATA_value nan\n1.5 nan\n2.5 3.5\n")));
    EXPECT_THAT(refused(write("cut.asc", cut)), HasSubstr("2000 values found, 50×50 were"));
    EXPECT_THAT(
        refused(write("b.asc", "ncols 0\nnrows 0\nxllcorner 0\nyllcorner 0\ncellsize 30\n1")),
        HasSubstr("cannot be"));
    std::string bmp = "BM";
    put32(bmp, 64);
    put32(bmp, 0);
    put32(bmp, 54);
    put32(bmp, 40);
    put32(bmp, 100000);
    put32(bmp, 100000);
    put16(bmp, 1);
    put16(bmp, 24);
    bmp.resize(64, '\0');
    EXPECT_THAT(refused(write("a.bmp", bmp)), HasSubstr("cannot be"));
}

TEST_F(BadRaster, FilesCutShort) {
    const auto wave = [](int col, int row) { return 100 + (col * row) % 50; };
    MadeRaster raster = made_raster(200, 150, wave);
    struct Format {
        const char* driver;
        const char* name;
        GDALDataType type;
    };
    for (const Format& format : {Format{"GTiff", "a.tif", GDT_Float32},
                                 {"PNG", "a.png", GDT_UInt16},
                                 {"BMP", "a.bmp", GDT_Byte},
                                 {"PNM", "a.pgm", GDT_UInt16},
                                 {"AAIGrid", "a.asc", GDT_Int16},
                                 {"HF2", "a.hf2", GDT_Float32},
                                 {"JPEG", "a.jpg", GDT_Byte}}) {
        raster.format = format.driver;
        raster.type = format.type;
        const auto path = made(raster, format.name);
        ASSERT_TRUE(read_terrain(path)) << format.name;
        const std::string whole = test::read_bytes(path);
        for (const double share : {0.02, 0.3, 0.6, 0.95}) {
            const auto length = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
            refused(write(std::string("cut_") + format.name, whole.substr(0, length)));
        }
    }
}

TEST_F(BadRaster, RealFilesCutShort) {
    for (const std::string name :
         {"natural/srtm3/N45E006.hgt", "natural/srtm3/N22W160v2.3a.hgt.zip",
          "natural/n00_e006_3arc_v2.dt1", "natural/SainteHelens.dem", "natural/springcreek_30m.asc",
          "natural/derived/sthelens.ter", "natural/derived/sthelens.hf2",
          "natural/derived/mt_rainier_90m_cog.tif", "natural/irrlicht_terrain-heightmap.bmp"}) {
        RELJEF_NEED_DATA(name);
        const std::string whole = test::read_bytes(test::data_path(name));
        const std::string file = std::filesystem::path(name).filename().string();
        for (const double share : {0.01, 0.5, 0.9}) {
            const auto length = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
            refused(write(file, whole.substr(0, length)));
        }
    }
}

/// Some bytes changed at random, near the begin only where `header`.
std::string damaged(std::string bytes, std::mt19937& random, bool header) {
    const std::size_t reach = header ? std::min<std::size_t>(300, bytes.size()) : bytes.size();
    for (int change = 0; change < 4; ++change) {
        bytes[random() % reach] = static_cast<char>(random() % 256);
    }
    return bytes;
}

bool all_finite(const terrain::Terrain& terrain) {
    const auto heights = terrain.heightfield.heights.samples();
    return std::all_of(heights.begin(), heights.end(),
                       [](float height) { return std::isfinite(height); });
}

TEST_F(BadRaster, DamagedFilesDoNoHarm) {
    std::mt19937 random(11);
    MadeRaster raster = made_raster(40, 30, [](int col, int row) { return 100 + col * row % 50; });
    RasterOptions options;
    options.memory_budget = 1 << 22;
    for (const auto& [driver, name] :
         std::vector<std::pair<std::string, std::string>>{{"GTiff", "a.tif"},
                                                          {"PNG", "a.png"},
                                                          {"BMP", "a.bmp"},
                                                          {"PNM", "a.pgm"},
                                                          {"AAIGrid", "a.asc"},
                                                          {"HF2", "a.hf2"}}) {
        raster.format = driver;
        raster.type = driver == "AAIGrid" || driver == "HF2" ? GDT_Float32 : GDT_Byte;
        const std::string whole = test::read_bytes(made(raster, name));
        for (int i = 0; i < 60; ++i) {
            const auto path = write("damaged_" + name, damaged(whole, random, i % 2 == 0));
            const auto terrain = read_terrain(path, options);
            ASSERT_TRUE(!terrain || all_finite(*terrain));
        }
    }
}

TEST_F(BadRaster, AGeotransformThatPlacesNothing) {
    const double inf = std::numeric_limits<double>::infinity();
    for (const std::array<double, 6> wrong :
         {std::array{1e300, 1.0, 0.0, 0.0, 0.0, -1.0}, std::array{0.0, inf, 0.0, 0.0, 0.0, -1.0},
          std::array{0.0, std::nan(""), 0.0, 0.0, 0.0, -1.0},
          std::array{5.0, 1.0, 1.0, 5.0, 1.0, 1.0}, std::array{0.0, 1e-100, 0.0, 0.0, 0.0, -1e-100},
          std::array{0.0, 1e9, 0.0, 0.0, 0.0, -1e9}}) {
        MadeRaster raster = made_raster(4, 4, [](int col, int) { return col; });
        raster.crs = "EPSG:32632";
        raster.geotransform = wrong;
        EXPECT_THAT(refused(made(raster, "lost.tif")),
                    AnyOf(HasSubstr("geotransform"), HasSubstr("apart")));
    }
}

TEST_F(BadRaster, OptionsThatMakeNoSense) {
    const auto path = made(made_raster(4, 4, [](int col, int) { return col; }), "a.tif");
    RasterOptions options;
    options.height_scale = 0.0;
    EXPECT_FALSE(read_terrain(path, options));
    options.height_scale = std::nan("");
    EXPECT_FALSE(read_terrain(path, options));
    options.height_scale = 1.0;
    options.height_offset = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(read_terrain(path, options));
    options.height_offset = 0.0;
    EXPECT_TRUE(read_terrain(path, options));
}

} // namespace
} // namespace reljef::io
