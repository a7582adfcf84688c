// Terrains on Earth that are read part by part: no holes, jitter or flips, wherever they lie.
#include <cmath>
#include <cstdlib>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/scene/streaming/tile_stream.h"
#include "engine/session/flight_keys.h"
#include "engine/session/frame_maker.h"
#include "engine/session/ground.h"
#include "engine/session/scene_setup.h"
#include "tests/session/made_session.h"
#include "tests/support/process_state.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"
#include "tests/terrain/chance.h"

namespace reljef::app {
namespace {

constexpr glm::ivec2 picture_size{161, 121}; // odd: a pixel in the middle

int holes_in(const HitBuffer& hits) {
    return static_cast<int>(std::count_if(hits.samples().begin(), hits.samples().end(),
                                          [](const Hit& hit) { return hit.is_sky(); }));
}

/// A terrain that does not fit the memory, and what draws it.
class StreamedPlace {
public:
    StreamedPlace(const std::string& folder, int megabytes) {
        session::SourceOptions choice;
        choice.terrain = folder;
        choice.memory_megabytes = megabytes;
        choice.streamed = true;
        choice.geoid = "none";
        auto source = test::open_terrain(choice);
        EXPECT_TRUE(source) << (source ? "" : source.error().message);
        EXPECT_TRUE(source->stream);
        session::SceneOptions view;
        view.max_error = 0.0; // every sample of a tile
        scene_ = std::move(*test::make_scene(std::move(*source), choice, view));
        frames_.emplace(std::move(*session::Device::create(
                            {.context = session::BackendKind::osmesa, .size = picture_size})),
                        log_);
    }

    [[nodiscard]] session::TerrainScene& scene() { return *scene_; }
    [[nodiscard]] const scene::TerrainNode& node() const {
        return *scene_->terrain->get<scene::TerrainNode>();
    }
    [[nodiscard]] const terrain::Placement& placement() const {
        return node().surface->placement();
    }

    HitBuffer look(glm::dvec3 eye, glm::dvec3 at, glm::dvec3 up) {
        auto& camera = *scene_->camera->get<scene::Camera>();
        camera.eye = eye;
        camera.target = at;
        camera.up = up;
        auto hits = frames_->draw_hits(scene_->scene, {});
        EXPECT_TRUE(hits);
        return std::move(*hits);
    }
    /// Towards north and up at a place, of unit length.
    [[nodiscard]] glm::dvec3 north(geo::Geodetic place) const {
        geo::Geodetic beyond = place;
        beyond.latitude += 1e-4;
        return glm::normalize(*placement().world_from_geodetic(beyond) -
                              *placement().world_from_geodetic(place));
    }

private:
    std::optional<session::TerrainScene> scene_;
    session::Log log_;
    std::optional<session::DeviceFrames> frames_;
};

class Place : public testing::Test {
protected:
    void SetUp() override { RELJEF_RELEASE_ONLY("draws hundreds of tiles"); }
    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_.path() / name).string();
    }
    /// A square raster around or beside a point, hills of a few metres, as text.
    void write_raster(const std::string& name, glm::dvec2 corner, double step, int side,
                      const std::string& projection) const {
        std::string text = "ncols " + std::to_string(side) + "\nnrows " + std::to_string(side) +
                           "\nxllcenter " + std::to_string(corner.x) + "\nyllcenter " +
                           std::to_string(corner.y) + "\ncellsize " + std::to_string(step) + "\n";
        for (int row = 0; row < side; ++row) {
            for (int col = 0; col < side; ++col) {
                text += std::to_string(20 + (col * 7 + row * 5) % 11) + " ";
            }
            text += "\n";
        }
        folder_.write(name + ".asc", text);
        folder_.write(name + ".prj", projection);
    }
    /// Along a path of so many frames: the eye and its view go on without a jump, and the ground
    /// has no hole.
    void expect_smooth_flight(StreamedPlace& place, const std::string& line) const {
        const std::string file =
            folder_.write("line.geojson", R"({"type":"LineString","coordinates":[)" + line + "]}")
                .string();
        const auto flight = test::open_path(place.scene(), file);
        ASSERT_TRUE(flight) << flight.error().message;
        constexpr int frames = 17;
        const auto& camera = *place.scene().camera->get<scene::Camera>();
        std::vector<glm::dvec3> eyes;
        glm::dvec3 ahead(0.0);
        for (int i = 0; i < frames; ++i) {
            session::fly_to(place.scene(), *flight, i, frames);
            session::keep_above_ground(place.scene());
            const glm::dvec3 eye = camera.eye;
            const glm::dvec3 forward = glm::normalize(camera.target - eye);
            const glm::dvec3 up = place.placement().up(eye);
            ASSERT_TRUE(i == 0 || glm::dot(forward, ahead) > 0.99) << "a flip at frame " << i;
            ahead = forward;
            eyes.push_back(eye);
            EXPECT_EQ(holes_in(place.look(eye, eye + 0.5 * forward - up, up)), 0) << "frame " << i;
        }
        const double whole = glm::distance(eyes.front(), eyes.back());
        for (std::size_t i = 1; i < eyes.size(); ++i) {
            const double step = glm::distance(eyes[i], eyes[i - 1]);
            EXPECT_LT(step, 3.0 * whole / frames) << "a jump at frame " << i;
        }
    }

    test::TemporaryFolder folder_;
    test::EnvironmentVariable cache_{"XDG_CACHE_HOME", path("cache")};
    // Its folder would go with the test.
    test::EnvironmentVariable no_shader_cache_{"MESA_SHADER_CACHE_DISABLE", "true"};
};

class AlpineBlock : public Place {
protected:
    void SetUp() override {
        Place::SetUp();
        if (IsSkipped()) {
            return;
        }
        std::filesystem::create_directory(path("alps"));
        for (const char* name : {"N44E006.hgt", "N44E007.hgt", "N45E006.hgt", "N45E007.hgt"}) {
            const std::string file = std::string("natural/srtm3/") + name;
            RELJEF_NEED_DATA(file);
            std::filesystem::create_symlink(std::filesystem::absolute(test::data_path(file)),
                                            folder_.path() / "alps" / name);
        }
        place_.emplace(path("alps"), 48);
    }
    std::optional<StreamedPlace> place_;
};

TEST_F(AlpineBlock, HasNoHoleFromAnyPose) {
    test::Chance chance(81);
    for (int i = 0; i < 14; ++i) {
        // Half of them over the edges that the files share.
        geo::Geodetic above{chance.between(44.3, 45.7), chance.between(6.3, 7.7), 0.0};
        if (i % 2 == 0) {
            (i % 4 == 0 ? above.latitude : above.longitude) = i % 4 == 0 ? 45.0 : 7.0;
        }
        above.height = 4900.0 + chance.between(0.0, 3000.0);
        const glm::dvec3 eye = *place_->placement().world_from_geodetic(above);
        const glm::dvec3 up = place_->placement().up(eye);
        const glm::dvec3 north = place_->north(above);
        const double heading = chance.between(0.0, 6.28);
        const glm::dvec3 ahead =
            std::cos(heading) * north + std::sin(heading) * glm::cross(north, up);
        const auto hits = place_->look(eye, eye + chance.between(0.1, 0.8) * ahead - up, up);
        EXPECT_EQ(holes_in(hits), 0)
            << above.latitude << "," << above.longitude << "," << above.height;
    }
}

TEST_F(AlpineBlock, ShowsOnePlaceFromAThousandKilometresDownToAMetre) {
    // Where the corners of all four files meet: a vertex of tiles of many levels.
    const scene::TileBuilder& maker = place_->node().stream->maker();
    const terrain::TreeTile tile{0, 1200 / terrain::tree_tile_cells,
                                 1200 / terrain::tree_tile_cells};
    const glm::ivec2 vertex(1200 % terrain::tree_tile_cells);
    constexpr double corner_height = 2411.0; // of all four
    const glm::dvec3 ground = maker.place(tile, vertex, corner_height);
    const glm::dvec3 up = place_->placement().up(ground);
    const glm::dvec3 north = place_->north({45.0, 7.0, 0.0});
    const glm::ivec2 middle = picture_size / 2;
    double before = 0.0;
    for (int i = 0; i <= 18; ++i) {
        const double above = std::pow(10.0, 6.0 - i / 3.0);
        const auto hits = place_->look(ground + above * up, ground, north);
        const double pixel = above * 1.1 / picture_size.y; // metres of ground
        const Hit& nadir = hits(middle.x, middle.y);
        ASSERT_FALSE(nadir.is_sky());
        // The rasterizer puts vertices on 1/256 pixel; hits are floats of samples 65 m apart.
        const double samples = 2.0 * pixel / 256.0 / 65.0 + 1e-3;
        EXPECT_NEAR(nadir.col, 1200.0, samples) << above << " m up";
        EXPECT_NEAR(nadir.row, 1200.0, samples) << above << " m up";
        EXPECT_NEAR(nadir.depth, above, above < 300.0 ? 2e-6 * above + 1e-3 : 2.0 * pixel);
        const double spread = hits(middle.x + 8, middle.y).col - hits(middle.x - 8, middle.y).col;
        EXPECT_GT(spread, 0.0) << "east is right " << above << " m up";
        EXPECT_GT(hits(middle.x, middle.y + 8).row, hits(middle.x, middle.y - 8).row)
            << "north is up " << above << " m up";
        EXPECT_TRUE(i == 0 || spread < before) << above << " m up";
        before = spread;
        EXPECT_TRUE(above > 60e3 || holes_in(hits) == 0) << above << " m up";
    }
}

const std::string degrees_prj =
    R"(GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],)"
    R"(PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]])";

std::string polar_prj(const std::string& pole, const std::string& parallel) {
    return R"(PROJCS["Polar",)" + degrees_prj + R"(,PROJECTION["Stereographic_)" + pole +
           R"(_Pole"],PARAMETER["False_Easting",0.0],PARAMETER["False_Northing",0.0],)"
           R"(PARAMETER["Central_Meridian",0.0],PARAMETER["Standard_Parallel_1",)" +
           parallel + R"(],UNIT["Meter",1.0]])";
}

TEST_F(Place, TheAntimeridianIsFlownOver) {
    write_raster("tiles/west", {179.0, -17.0}, 0.005, 201, degrees_prj);
    write_raster("tiles/east", {-180.0, -17.0}, 0.005, 201, degrees_prj);
    StreamedPlace place(path("tiles"), 2);
    expect_smooth_flight(place, "[179.6,-16.5,3000],[180,-16.5,3000],[-179.6,-16.5,3000]");
}

TEST_F(Place, TheNorthPoleIsFlownOver) {
    write_raster("pole", {-20000.0, -20000.0}, 100.0, 401, polar_prj("North", "70.0"));
    StreamedPlace place(path("pole.asc"), 2);
    expect_smooth_flight(place, "[20,89.95,2000],[20,89.999999,2000],[-160,89.95,2000]");
}

TEST_F(Place, TheSouthPoleIsFlownOver) {
    write_raster("pole", {-20000.0, -20000.0}, 100.0, 401, polar_prj("South", "-71.0"));
    StreamedPlace place(path("pole.asc"), 2);
    expect_smooth_flight(place, "[-60,-89.95,2000],[-60,-89.999999,2000],[120,-89.95,2000]");
}

} // namespace
} // namespace reljef::app
