#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <future>
#include <span>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/session/streaming.h"
#include "tests/app/command_line.h"
#include "tests/session/streamed_cells.h"
#include "tests/support/nginx.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_program.h"

namespace reljef {
namespace {

using test::Streaming;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Streaming, what_does_not_fit_the_memory_is_read_as_the_view_needs_it) {
    const auto result = render("a.png", {"--stats"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("finer tiles are read where the view needs them"));
    EXPECT_THAT(result.out, HasSubstr("streamed: "));
    EXPECT_THAT(result.out, HasSubstr(" 0 failed"));
    ASSERT_EQ(render("b.png", {"--quiet"}).exit_code, 0);
    EXPECT_EQ(test::read_bytes(path("a.png")), test::read_bytes(path("b.png")));
    // Relief searches the same tiles; what warps all samples draws what fits.
    const std::array techniques{"cone", "prewarp", "parallax", "exact:shadow=hard"};
    for (const char* const technique :
         std::span(techniques).first(std::size_t{test::rounds(4, 1)})) {
        const auto other =
            render("c.png", {"--placement", "plane", "--technique", technique, "--stats"});
        EXPECT_EQ(other.exit_code, 0) << other.err;
        const bool is_streamed = other.out.find("streamed: ") != std::string::npos;
        EXPECT_EQ(is_streamed, technique != std::string_view("prewarp")) << technique;
    }
}

// A file of 1201² samples in memory, and streamed in less memory than it needs.
TEST_F(Streaming, the_truth_of_what_does_not_fit_the_memory_is_that_of_all_samples) {
    const auto hits = [&](const std::string& megabytes) {
        const auto result = test::reljef({"render", path("tiles/N44E006.hgt"), "--truth", "--hit",
                                          path("a.exr"), "--size", "96x72", "--memory", megabytes,
                                          "--camera", "44.3,6.3,2600,60,-12"},
                                         options_);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err.find("read where the view needs them") != std::string::npos,
                  megabytes == "32")
            << result.err;
        return io::read_hits(path("a.exr"));
    };
    const auto streamed = hits("32");
    const auto in_memory = hits("512");
    ASSERT_TRUE(streamed && in_memory);
    int terrain = 0;
    int elsewhere = 0; // samples: of silhouettes, whose rays graze
    for (std::size_t i = 0; i < streamed->size(); ++i) {
        const Hit& a = streamed->samples()[i];
        const Hit& b = in_memory->samples()[i];
        terrain += b.is_sky() ? 0 : 1;
        elsewhere += a.is_sky() != b.is_sky() ||
                             (!a.is_sky() && std::hypot(a.col - b.col, a.row - b.row) > 0.01)
                         ? 1
                         : 0;
    }
    EXPECT_GT(terrain, 3000);
    EXPECT_LE(elsewhere, terrain / 500);
}

TEST_F(Streaming, a_flight_goes_on_where_a_tile_is_cut_and_says_so_once) {
    ASSERT_EQ(render("a.png", {}).exit_code, 0); // the index knows the file whole
    // Cut, but of the size and the time that the index knows.
    const auto file = folder_.path() / "tiles/N44E006.hgt";
    const auto time = std::filesystem::last_write_time(file);
    const auto size = std::filesystem::file_size(file);
    std::filesystem::resize_file(file, 0);
    std::filesystem::resize_file(file, size - 100000);
    std::filesystem::last_write_time(file, time);
    const auto result = render("b.png", {});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("N44E006.hgt"));
    EXPECT_GT(test::read_bytes(path("b.png")).size(), 100U);
}

TEST_F(Streaming, a_file_that_cannot_be_read_tile_by_tile_says_why) {
    const test::EnvironmentVariable cache("XDG_CACHE_HOME", path("cache"));
    folder_.write("tiles/nowhere.vrt", R"(<VRTDataset rasterXSize="1201" rasterYSize="1201">
  <SRS>EPSG:32632</SRS>
  <GeoTransform>5e8, 90.0, 0.0, 5e6, 0.0, -90.0</GeoTransform>
  <VRTRasterBand dataType="Int16" band="1">
    <SimpleSource><SourceFilename relativeToVRT="1">N44E006.hgt</SourceFilename></SimpleSource>
  </VRTRasterBand>
</VRTDataset>)");
    session::SourceOptions choice = streamed_choice();
    choice.terrain = path("tiles/nowhere.vrt");
    const auto source = test::open_terrain(choice);
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_FALSE(source->stream);
    EXPECT_THAT(source->terrain.notes,
                ::testing::Contains(HasSubstr("not read tile by tile: " + choice.terrain +
                                              ": lies at coordinate")));
}

double kept_error_of(const std::string& stats) {
    const std::string before = "unproven: 0, kept error: ";
    const std::size_t found = stats.find(before);
    EXPECT_NE(found, std::string::npos) << stats;
    return found == std::string::npos ? 1e9 : std::stod(stats.substr(found + before.size()));
}

std::string heights_without_a_place() {
    std::string heights = "ncols 1000\nnrows 1000\nxllcorner 0\nyllcorner 0\ncellsize 2\n";
    for (int row = 0; row < 1000; ++row) {
        for (int col = 0; col < 1000; ++col) {
            heights +=
                fmt::format("{:.2f} ", 300.0 + 250.0 * std::sin(0.02 * col) * std::cos(0.01 * row));
        }
    }
    return heights;
}

// As heights from other programs often are; with an index, all tiles are proven.
TEST_F(Streaming, heights_without_a_place_are_streamed_and_proven_as_those_with_one) {
    folder_.write("heights.asc", heights_without_a_place());
    const auto with_memory = [&](const std::string& megabytes) {
        return test::reljef({"render", path("heights.asc"), "-o", path("a.png"), "--size",
                             "160x120", "--max-error", "1", "--memory", megabytes, "--stats",
                             "--eye=0,-700,900", "--look=0,0,0"},
                            options_);
    };
    const auto streamed = with_memory("32");
    ASSERT_EQ(streamed.exit_code, 0) << streamed.err;
    EXPECT_THAT(streamed.out, HasSubstr("streamed: "));
    EXPECT_LE(kept_error_of(streamed.out), 1.0);
    const auto in_memory = with_memory("256");
    EXPECT_THAT(in_memory.out, Not(HasSubstr("streamed: ")));
    EXPECT_LE(kept_error_of(in_memory.out), 1.0);
}

// They asked for heights at places on Earth: the program ended.
TEST_F(Streaming, objects_and_buildings_stand_on_streamed_heights_without_a_place) {
    folder_.write("heights.asc", heights_without_a_place());
    folder_.write("roof.obj", "v 0 0 0\nv 9 0 0\nv 4 9 20\nf 1 2 3\n");
    folder_.write("houses.geojson",
                  R"({"type":"FeatureCollection","features":[{"type":"Feature",
"properties":{"h":30},"geometry":{"type":"Polygon",
"coordinates":[[[0,0],[40,0],[40,40],[0,40],[0,0]]]}}]})");
    const auto result =
        test::reljef({"render", path("heights.asc"), "-o", path("a.png"), "--size", "64x48",
                      "--memory", "32", "--stats", "--object", path("roof.obj") + ":at=90,90",
                      "--footprints", path("houses.geojson") + ":height=h"},
                     options_);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("streamed: "));
}

// Cells that share no edge with the one that is gone are drawn as finely as without it.
TEST_F(Streaming, a_fine_tile_that_cannot_be_read_does_not_coarsen_those_beside_it) {
    const test::EnvironmentVariable cache("XDG_CACHE_HOME", path("cache"));
    session::SourceOptions choice = streamed_choice();
    choice.memory_megabytes = 1;
    auto source = test::open_terrain(choice);
    ASSERT_TRUE(source) << source.error().message;
    const auto scene = test::make_scene(std::move(*source), choice, {});
    ASSERT_TRUE(scene) << scene.error().message;
    scene::TileStream& stream = *scene->terrain->get<scene::TerrainNode>()->stream;
    std::filesystem::resize_file(path("tiles/N44E007.hgt"), 1'000'000);
    const terrain::TreeTile whole{0, 5, 30};
    const terrain::TreeTile cut{0, 30, 30};
    stream.request(std::array{whole, cut});
    ASSERT_TRUE(stream.wait({}));
    ASSERT_TRUE(stream.find(whole) && stream.find(cut));
    EXPECT_FALSE(stream.find(whole)->of_overview);
    EXPECT_TRUE(stream.find(cut)->of_overview);
    EXPECT_FALSE(stream.has_given_up(cut));
    EXPECT_THAT(stream.take_errors(), ::testing::ElementsAre(HasSubstr("N44E007.hgt")));
}

TEST_F(Streaming, a_file_that_goes_away_takes_no_tile_of_another) {
    const test::EnvironmentVariable cache("XDG_CACHE_HOME", path("cache"));
    const session::SourceOptions choice = streamed_choice();
    session::SceneOptions view;
    view.geodetic = {44.3, 7.7, 3000.0, 90.0, -60.0};
    auto source = test::open_terrain(choice);
    ASSERT_TRUE(source) << source.error().message;
    std::filesystem::remove(folder_.path() / "tiles/N45E006.hgt");
    auto scene = test::make_scene(std::move(*source), choice, view);
    ASSERT_TRUE(scene) << scene.error().message;
    const auto& terrain = *scene->terrain->get<scene::TerrainNode>();
    const std::array cameras{scene->scene.camera()};
    const auto level_there = [&] {
        const auto eye = terrain.surface->placement().sample_from_world(cameras.front().eye);
        const auto found = terrain.stream->finest_at(glm::dvec2(*eye));
        return found ? found->tile->id.level : -1;
    };
    for (int i = 0; i < 12'000 && level_there() != 0; ++i) { // a minute at most
        session::request_tiles(view::tile_requests(scene->scene, cameras.front(), {160, 120}));
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_EQ(level_there(), 0);
    EXPECT_THAT(terrain.stream->take_errors(), ::testing::Contains(HasSubstr("N45E006.hgt")));
}

// What the overview stood in for is read once the file is back.
TEST_F(Streaming, a_file_that_comes_back_is_shown_again) {
    const test::EnvironmentVariable cache("XDG_CACHE_HOME", path("cache"));
    const session::SourceOptions choice = streamed_choice();
    auto source = test::open_terrain(choice);
    ASSERT_TRUE(source) << source.error().message;
    const auto scene = test::make_scene(std::move(*source), choice, {});
    ASSERT_TRUE(scene) << scene.error().message;
    scene::TileStream& stream = *scene->terrain->get<scene::TerrainNode>()->stream;
    const auto wait_until = [&](const auto& condition) {
        for (int i = 0; i < 30'000 && !condition(); ++i) { // a minute at most
            stream.request(std::array{stream.tree().root()});
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    };
    const auto root = [&] { return stream.find(stream.tree().root()); };
    std::filesystem::rename(path("tiles/N45E006.hgt"), path("away.hgt"));
    wait_until([&] { return root() != nullptr; });
    ASSERT_NE(root(), nullptr);
    EXPECT_TRUE(root()->of_overview);
    std::filesystem::rename(path("away.hgt"), path("tiles/N45E006.hgt"));
    wait_until([&] { return !root()->of_overview; });
    EXPECT_FALSE(root()->of_overview);
}

/// In place of a cell: 61 samples a side, from a longitude on, over the same latitudes.
std::string coarse_cell(double west, double south) {
    std::string text = fmt::format("ncols 61\nnrows 61\nxllcenter {}\nyllcenter {}\n"
                                   "cellsize 0.0166666666666667\n",
                                   west, south);
    for (int i = 0; i < 61 * 61; ++i) {
        text += i % 61 == 60 ? "1500\n" : "1500 ";
    }
    return text;
}

TEST_F(Streaming, a_file_that_is_replaced_by_one_of_another_size_is_shown_and_told) {
    const test::EnvironmentVariable cache("XDG_CACHE_HOME", path("cache"));
    const session::SourceOptions choice = streamed_choice();
    auto source = test::open_terrain(choice);
    ASSERT_TRUE(source) << source.error().message;
    const auto scene = test::make_scene(std::move(*source), choice, {});
    ASSERT_TRUE(scene) << scene.error().message;
    scene::TileStream& stream = *scene->terrain->get<scene::TerrainNode>()->stream;
    folder_.write("tiles/N45E006.hgt", coarse_cell(6.0, 45.0));
    stream.request(std::array{stream.tree().root()});
    ASSERT_TRUE(stream.wait({}));
    ASSERT_NE(stream.find(stream.tree().root()), nullptr);
    EXPECT_FALSE(stream.find(stream.tree().root())->of_overview);
    EXPECT_THAT(stream.take_errors(), ::testing::IsEmpty());
    EXPECT_THAT(stream.take_notes(), ::testing::ElementsAre(HasSubstr("61×61")));
}

TEST_F(Streaming, whether_a_replaced_file_can_be_shown_is_told_and_in_the_exit_status) {
    RELJEF_RELEASE_ONLY("two flights over whole cells");
    folder_.write("south.geojson", R"({"type": "LineString", "coordinates": )"
                                   "[[6.5, 45.9, 3000], [6.5, 44.3, 3000]]}");
    const auto fly_while_replaced = [&](const std::string& text) { // after the first picture
        write_cell("N44E006.hgt", 6, 44);
        const test::TemporaryFolder pictures;
        test::ProgramOptions options = options_;
        options.interruption = {SIGCONT, [&](int /*process*/) {
                                    if (pictures.names().size() < 2) {
                                        return false;
                                    }
                                    std::filesystem::rename(folder_.write("new", text),
                                                            path("tiles/N44E006.hgt"));
                                    return true;
                                }};
        return test::reljef({"render", path("tiles"), "-o", (pictures.path() / "%02d.png").string(),
                             "--size", "160x120", "--context", "osmesa", "--memory", "32", "--path",
                             path("south.geojson"), "--frames", "6"},
                            options);
    };
    const std::string told = "N44E006.hgt: was replaced while it was open, by 61×61 samples";
    const auto shown = fly_while_replaced(coarse_cell(6.0, 44.0));
    EXPECT_EQ(shown.exit_code, 0) << shown.err;
    EXPECT_THAT(shown.err, HasSubstr(told + ": they are read at the places of the 1201×1201"));
    const auto elsewhere = fly_while_replaced(coarse_cell(60.0, 44.0));
    EXPECT_EQ(elsewhere.exit_code, 1) << elsewhere.err;
    EXPECT_THAT(elsewhere.err, HasSubstr(told + " that are no heights over all the ground"));
}

TEST_F(Streaming, coarse_views_of_a_file_without_overviews_read_no_more_of_it) {
    folder_.write("wide.vrt",
                  R"(<VRTDataset rasterXSize="8300" rasterYSize="1200"><SRS>EPSG:4326</SRS>)"
                  "<GeoTransform>6, 0.0005, 0, 45, 0, -0.0005</GeoTransform>"
                  R"(<VRTRasterBand dataType="Int16" band="1"><SimpleSource>)"
                  R"(<SourceFilename relativeToVRT="1">tiles/N44E006.hgt</SourceFilename>)"
                  R"(<SrcRect xOff="0" yOff="0" xSize="1201" ySize="1201"/>)"
                  R"(<DstRect xOff="0" yOff="0" xSize="8300" ySize="1200"/></SimpleSource>)"
                  "</VRTRasterBand></VRTDataset>");
    const auto render_from = [&](const std::string& camera) {
        return test::reljef({"render", path("wide.vrt"), "-o", path("a.png"), "--size", "160x120",
                             "--context", "osmesa", "--memory", "16", "--stats", "--camera",
                             camera},
                            options_);
    };
    const auto far = render_from("44.7,8,900000,0,-90");
    ASSERT_EQ(far.exit_code, 0) << far.err;
    const auto told = far.err.find("without overviews");
    ASSERT_NE(told, std::string::npos) << far.err;
    EXPECT_EQ(far.err.find("without overviews", told + 1), std::string::npos) << far.err;
    EXPECT_THAT(far.err, HasSubstr("gdaladdo -r average " + path("wide.vrt")));
    EXPECT_THAT(far.out, HasSubstr("tiles read (0.0 MB of files), 0 failed"));
    const auto near = render_from("44.7,8,9000,0,-30");
    ASSERT_EQ(near.exit_code, 0) << near.err;
    EXPECT_THAT(near.out, Not(HasSubstr("tiles read (0.0 MB of files)")));
}

/// A cloud-optimized file of a cell: it begins with its overviews, 1,300,000 bytes, and then has
/// the samples in blocks of 128 x 128.
class BadServer : public Streaming {
protected:
    void SetUp() override {
        RELJEF_NEED_NGINX();
        if (!std::filesystem::exists("/usr/bin/gdal_translate")) {
            GTEST_SKIP() << "gdal_translate of gdal-bin is not here";
        }
        Streaming::SetUp();
        const auto made =
            test::run_program("/usr/bin/gdal_translate",
                              {"-q", "-of", "COG", "-co", "BLOCKSIZE=128", "-co", "COMPRESS=NONE",
                               path("tiles/N44E006.hgt"), path("dem.tif")});
        ASSERT_EQ(made.exit_code, 0) << made.err;
        options_.environment["GDAL_HTTP_MAX_RETRY"] = "0";
        options_.environment["GDAL_HTTP_LOW_SPEED_TIME"] = "1";
    }
    /// Rules of nginx for the samples alone.
    [[nodiscard]] static std::string for_samples(const std::string& directive) {
        return "location / { if ($http_range ~ \"^bytes=(1[3-9]|[2-9][0-9])[0-9]{5}-\") { " +
               directive + " } }";
    }
    /// So little memory that only coarse overviews are read at the beginning.
    [[nodiscard]] test::ProgramResult render_from(const std::string& address,
                                                  const std::string& picture) const {
        return test::reljef({"render", address, "-o", path(picture), "--size", "160x120",
                             "--context", "osmesa", "--memory", "1", "--camera",
                             "44.6,6.6,2600,60,-12"},
                            options_);
    }
};

TEST_F(BadServer, gives_the_picture_of_the_local_file_even_where_it_is_slow) {
    RELJEF_RELEASE_ONLY("waits for a slow server");
    ASSERT_EQ(render_from(path("dem.tif"), "local.png").exit_code, 0);
    const test::Nginx server(folder_.path(), "limit_rate 2m;");
    ASSERT_EQ(render_from(server.url("dem.tif"), "slow.png").exit_code, 0);
    EXPECT_EQ(test::read_bytes(path("slow.png")), test::read_bytes(path("local.png")));
}

TEST_F(BadServer, that_hangs_holds_up_no_picture_and_finer_tiles_come_once_it_has_recovered) {
    const test::EnvironmentVariable cache("XDG_CACHE_HOME", path("cache"));
    test::Nginx server(folder_.path());
    session::SourceOptions choice = streamed_choice();
    choice.terrain = server.url("dem.tif");
    choice.memory_megabytes = 1;
    auto source = test::open_terrain(choice);
    ASSERT_TRUE(source) << source.error().message;
    const auto scene = test::make_scene(std::move(*source), choice, {});
    ASSERT_TRUE(scene) << scene.error().message;
    scene::TileStream& stream = *scene->terrain->get<scene::TerrainNode>()->stream;
    const auto ask_for = [&](terrain::TreeTile tile, std::chrono::milliseconds time) {
        const auto end = std::chrono::steady_clock::now() + time;
        while (stream.find(tile) == nullptr && std::chrono::steady_clock::now() < end) {
            stream.request(std::array{tile});
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return stream.find(tile);
    };
    constexpr std::chrono::minutes long_enough{1};
    const terrain::TreeTile finest{0, 3, 3};
    EXPECT_NE(ask_for(stream.tree().root(), long_enough), nullptr);
    server.serve_by(for_samples("limit_rate 1;")); // a byte a second
    EXPECT_EQ(ask_for(finest, std::chrono::milliseconds(200)), nullptr);
    server.serve_by(for_samples("return 404;"));
    ASSERT_NE(ask_for(finest, long_enough), nullptr);
    EXPECT_TRUE(stream.find(finest)->of_overview);
    server.serve_by("");
    const auto end = std::chrono::steady_clock::now() + long_enough;
    while (stream.find(finest)->of_overview && std::chrono::steady_clock::now() < end) {
        stream.request({}, std::array{finest});
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    EXPECT_FALSE(stream.find(finest)->of_overview);
    EXPECT_THAT(stream.take_errors(), ::testing::ElementsAre(HasSubstr("dem.tif")));
}

// All at the same time: they wait more than they work.
TEST_F(BadServer, is_drawn_coarser_tried_again_and_told_once) {
    RELJEF_RELEASE_ONLY("waits for what is tried again");
    std::vector<std::future<void>> runs;
    for (const std::string fault : {"return 404;", "return 500;", "return 444;"}) {
        runs.push_back(std::async(std::launch::async, [this, fault] {
            const test::Nginx server(folder_.path(), for_samples(fault));
            const std::string picture = fault + ".png";
            const auto result = render_from(server.url("dem.tif"), picture);
            EXPECT_GT(test::read_bytes(path(picture)).size(), 100U);
            EXPECT_EQ(result.exit_code, 1) << fault << result.err;
            const std::string told = "shown coarser: ";
            const auto first = result.err.find(told);
            ASSERT_NE(first, std::string::npos) << fault << result.err;
            EXPECT_EQ(result.err.find(told, first + 1), std::string::npos) << result.err;
            EXPECT_THAT(result.err, HasSubstr("dem.tif"));
        }));
    }
    for (auto& run : runs) {
        run.get();
    }
}

} // namespace
} // namespace reljef
