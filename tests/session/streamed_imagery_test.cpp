#include <array>
#include <chrono>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "engine/session/streaming.h"
#include "tests/app/command_line.h"
#include "tests/session/streamed_cells.h"
#include "tests/support/process_state.h"
#include "tests/support/release_only.h"

namespace reljef {
namespace {

using test::Streaming;
using ::testing::HasSubstr;
using ::testing::Not;

/// Over the same cells: images of one colour each, in UTM, as GDAL's virtual rasters.
class StreamedImagery : public Streaming {
protected:
    void SetUp() override {
        Streaming::SetUp();
        write_image("west.vrt", 290000.0, 40000.0, "\xff\x10\x10");
        write_image("east.vrt", 330000.0, 80000.0, "\x10\x10\xff");
    }
    // 100 km from north to south.
    void write_image(const std::string& name, double west, double width,
                     const std::string& color) const {
        constexpr int side = 64;
        std::string pixels = "P6\n64 64\n255\n";
        for (int i = 0; i < side * side; ++i) {
            pixels += color;
        }
        folder_.write("images/" + name + ".dat", pixels);
        std::string bands;
        for (const auto& [band, meaning] : {std::pair("1", "Red"), {"2", "Green"}, {"3", "Blue"}}) {
            bands += fmt::format("<VRTRasterBand dataType=\"Byte\" band=\"{0}\"><ColorInterp>{1}"
                                 "</ColorInterp><SimpleSource><SourceFilename relativeToVRT=\"1\">"
                                 "{2}.dat</SourceFilename><SourceBand>{0}</SourceBand>"
                                 "</SimpleSource></VRTRasterBand>",
                                 band, meaning, name);
        }
        folder_.write("images/" + name,
                      fmt::format("<VRTDataset rasterXSize=\"64\" rasterYSize=\"64\"><SRS>"
                                  "EPSG:32632</SRS><GeoTransform>{}, {}, 0, 5000000, 0, {}"
                                  "</GeoTransform>{}</VRTDataset>",
                                  west, width / side, -100000.0 / side, bands));
    }
    // Straight down from 30 km, onto where the two meet.
    [[nodiscard]] test::ProgramResult render_down(const std::string& picture,
                                                  std::vector<std::string> more) const {
        return render(picture, std::move(more), "44.7,6.85,30000,0,-90");
    }
    [[nodiscard]] Image picture_of(const std::string& name) const {
        auto image = io::read_image(path(name));
        EXPECT_TRUE(image) << (image ? "" : image.error().message);
        return std::move(*image);
    }
};

enum class Shown { red, blue, other };
Shown shown(Rgba8 pixel) {
    return pixel.r > 3 * pixel.b ? Shown::red : pixel.b > 3 * pixel.r ? Shown::blue : Shown::other;
}

TEST_F(StreamedImagery, of_a_folder_shows_no_gap_where_two_images_meet) {
    const auto result = render_down("a.png", {"--imagery", path("images")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Image picture = picture_of("a.png");
    int other = 0;
    for (const Rgba8 pixel : picture.samples()) {
        other += shown(pixel) == Shown::other ? 1 : 0;
    }
    EXPECT_EQ(shown(picture(2, 60)), Shown::red);
    EXPECT_EQ(shown(picture(157, 60)), Shown::blue);
    EXPECT_LE(other, 3 * picture.rows()); // those that lie across the edge
}

TEST_F(StreamedImagery, is_mixed_with_the_colours_by_height) {
    const std::vector<std::string> imagery{"--imagery", path("images")};
    const auto drawn = [&](const std::string& name, std::vector<std::string> more) {
        const auto result = render_down(name, std::move(more));
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return picture_of(name);
    };
    const auto mixed = [&](const char* share) {
        auto more = imagery;
        more.insert(more.end(), {"--imagery-share", share});
        return drawn("mixed.png", more);
    };
    const Image full = drawn("full.png", imagery);
    const Image plain = drawn("plain.png", {});
    for (int i = 0; i < test::rounds(1, 0); ++i) {
        EXPECT_EQ(mixed("1"), full);
        EXPECT_EQ(mixed("0"), plain);
    }
    const Image half = mixed("0.5");
    for (const glm::ivec2 at : {glm::ivec2(2, 60), glm::ivec2(157, 60)}) {
        const auto between = [&](std::uint8_t Rgba8::*channel) {
            const int of_half = half(at.x, at.y).*channel;
            const int low = std::min(full(at.x, at.y).*channel, plain(at.x, at.y).*channel);
            const int high = std::max(full(at.x, at.y).*channel, plain(at.x, at.y).*channel);
            return high - low < 20 || (of_half > low + 4 && of_half < high - 4);
        };
        EXPECT_TRUE(between(&Rgba8::r) && between(&Rgba8::g) && between(&Rgba8::b));
    }
}

TEST_F(StreamedImagery, is_a_list_in_a_scene_file) {
    folder_.write("scene.toml", "[terrain]\nheights = \"tiles\"\n"
                                "imagery = [\"images/west.vrt\", \"images/east.vrt\"]\n");
    const auto scene =
        test::reljef({"render", path("scene.toml"), "-o", path("c.png"), "--size", "160x120",
                      "--context", "osmesa", "--memory", "32", "--camera", "44.7,6.85,30000,0,-90"},
                     options_);
    ASSERT_EQ(scene.exit_code, 0) << scene.err;
    const Image picture = picture_of("c.png");
    EXPECT_EQ(shown(picture(2, 60)), Shown::red);
    EXPECT_EQ(shown(picture(157, 60)), Shown::blue);
}

TEST_F(StreamedImagery, that_changes_is_told_once_and_read_again) {
    const test::EnvironmentVariable cache("XDG_CACHE_HOME", path("cache"));
    session::SourceOptions choice = streamed_choice();
    choice.imagery = {path("images/west.vrt")};
    auto source = test::open_terrain(choice);
    ASSERT_TRUE(source) << source.error().message;
    const auto scene = test::make_scene(std::move(*source), choice, {});
    ASSERT_TRUE(scene) << scene.error().message;
    scene::TileStream& stream = *scene->terrain->get<scene::TerrainNode>()->stream;
    const terrain::TreeTile seen{0, 9, 24};
    const auto load = [&](terrain::TreeTile missing) {
        stream.request(std::array{missing}, std::array{seen});
        ASSERT_TRUE(stream.wait({}));
    };
    const auto color = [&] {
        const Image& albedo = stream.find(seen)->albedo;
        return shown(albedo(albedo.cols() / 2, albedo.rows() / 2));
    };
    load(seen);
    EXPECT_EQ(color(), Shown::red);
    write_image("west.vrt", 290000.0, 40000.0, "\x10\x10\xff");
    const auto later = std::filesystem::file_time_type::clock::now() + std::chrono::hours(1);
    std::filesystem::last_write_time(path("images/west.vrt"), later);
    load({0, 8, 24});
    load({0, 10, 24});
    EXPECT_EQ(color(), Shown::blue);
    EXPECT_THAT(stream.take_notes(),
                ::testing::ElementsAre(HasSubstr("west.vrt: changed while open")));
}

/// A patch of pixels of which 8,400 would lie along the terrain, which fits the memory.
class FineImagery : public StreamedImagery {
protected:
    void SetUp() override {
        StreamedImagery::SetUp();
        write_fine();
    }
    void write_fine() const;
};

void FineImagery::write_fine() const {
    folder_.write("fine.ppm", "P6\n256 256\n255\n" + std::string(3 * 256 * 256, '\x60'));
    std::string bands;
    for (const auto& [band, meaning] : {std::pair("1", "Red"), {"2", "Green"}, {"3", "Blue"}}) {
        bands += fmt::format("<VRTRasterBand dataType=\"Byte\" band=\"{0}\"><ColorInterp>{1}"
                             "</ColorInterp><SimpleSource><SourceFilename relativeToVRT=\"1\">"
                             "fine.ppm</SourceFilename><SourceBand>{0}</SourceBand>"
                             "</SimpleSource></VRTRasterBand>",
                             band, meaning);
    }
    folder_.write("fine.vrt",
                  "<VRTDataset rasterXSize=\"256\" rasterYSize=\"256\"><SRS>EPSG:4326</SRS>"
                  "<GeoTransform>6.485, 0.000119, 0, 44.515, 0, -0.000119</GeoTransform>" +
                      bands + "</VRTDataset>");
}

// But an error that is promised is kept.
TEST_F(FineImagery, is_streamed_over_what_fits_the_memory) {
    RELJEF_RELEASE_ONLY("a whole terrain by the lines of the next tests");
    const auto render_with = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments{"render",    path("tiles/N44E006.hgt"),
                                           "--memory",  "64",
                                           "--imagery", path("fine.vrt"),
                                           "-o",        path("a.png"),
                                           "--size",    "64x48",
                                           "--context", "osmesa",
                                           "--camera",  "44.5,6.5,3500,0,-60",
                                           "--stats"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::reljef(arguments, options_);
    };
    const auto fine = render_with({});
    ASSERT_EQ(fine.exit_code, 0) << fine.err;
    EXPECT_THAT(fine.out, HasSubstr("streamed: "));
    const auto promised = render_with({"--max-error", "1"});
    ASSERT_EQ(promised.exit_code, 0) << promised.err;
    EXPECT_THAT(promised.out, Not(HasSubstr("streamed: ")));
}

TEST_F(FineImagery, leaves_all_samples_to_shadows_and_far_ground_where_there_is_memory) {
    const test::EnvironmentVariable cache("XDG_CACHE_HOME", path("cache"));
    session::SourceOptions choice;
    choice.terrain = path("tiles/N44E006.hgt");
    choice.imagery = {path("fine.vrt")};
    choice.streamed = choice.pictures_streamed = true;
    choice.memory_megabytes = 160; // of which the samples and their picture take a half at most
    const auto whole = test::open_terrain(choice);
    ASSERT_TRUE(whole) << whole.error().message;
    ASSERT_TRUE(whole->stream);
    EXPECT_EQ(whole->stream->plan.reduction, 1);
    EXPECT_EQ(whole->terrain.heightfield.heights.cols(), 1201);
    EXPECT_THAT(whole->terrain.notes, ::testing::Contains(HasSubstr("finer parts of the images")));
    choice.memory_megabytes = 64;
    const auto averages = test::open_terrain(choice);
    ASSERT_TRUE(averages) << averages.error().message;
    ASSERT_TRUE(averages->stream);
    EXPECT_GT(averages->stream->plan.reduction, 1);
    EXPECT_THAT(averages->terrain.notes,
                ::testing::Contains(HasSubstr("shadows and far ground are of averages")));
}

TEST_F(StreamedImagery, that_is_missing_is_told_once_and_the_rest_is_shown) {
    std::filesystem::remove(folder_.path() / "images/west.vrt.dat");
    const auto result = render_down(
        "a.png", {"--imagery", path("images/west.vrt"), "--imagery", path("images/east.vrt")});
    EXPECT_EQ(result.exit_code, 1);
    const auto first = result.err.find("west.vrt: ");
    ASSERT_NE(first, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("west.vrt: ", first + 1), std::string::npos) << result.err;
    const Image picture = picture_of("a.png");
    EXPECT_EQ(shown(picture(2, 60)), Shown::other); // the tint
    EXPECT_EQ(shown(picture(157, 60)), Shown::blue);
}

} // namespace
} // namespace reljef
