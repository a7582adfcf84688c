// What pictures light, beside the truth's own rays to the sun.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "engine/cast/frame/driver.h"
#include "engine/scene/motion/poses.h"
#include "terrains/generators.h"
#include "tests/cast/frame/true_sun.h"
#include "tests/cast/made_rays.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/earth_stage.h"
#include "tests/render/made_stream.h"
#include "tests/scene/streaming/streamed_samples.h"
#include "tests/session/made_session.h"
#include "tests/support/release_only.h"

namespace reljef::cast {
namespace {

constexpr glm::ivec2 sunny_picture{320, 240};
constexpr int compared_pixels = 3000; // of a picture
constexpr int enough_views = 24;      // fewer may show no shadow at all

// White ground below a sun alone, seen from poses and from 0.3 m above the ground.
struct SunStage : Stage {
    scene::Node* light = nullptr;

    explicit SunStage(const terrain::Heightfield& heightfield)
        : Stage(heightfield.heights, heightfield.spacing) {
        light = &scene.add_light();
    }
    void use(const std::string& technique) {
        terrain->get<scene::TerrainNode>()->material.technique =
            test::must(scene::parse_technique(technique));
    }
    // Floats round heights by a few 2^-20 of the largest one: so do rays that begin above it.
    [[nodiscard]] test::SunTolerance tolerance() const {
        const terrain::MinMax total = surface().pyramid().total();
        return {.metres = 0x1p-18 * std::max(std::abs(total.low), std::abs(total.high))};
    }
    [[nodiscard]] double ground(glm::dvec2 at) const {
        return surface().height_at(at.x, at.y).value_or(surface().bounds().low.z);
    }
    void look_around(test::Chance& chance) {
        *light->get<scene::Light>() =
            test::bright_sun(chance.between(0.0, 360.0), chance.between(5.0, 80.0));
        const int view = chance.whole(0, 7);
        const Box bounds = surface().bounds();
        if (view < 5) {
            constexpr std::array poses{scene::Pose::overview, scene::Pose::low,
                                       scene::Pose::grazing, scene::Pose::valley, scene::Pose::map};
            look(scene::pose_camera(poses.at(static_cast<std::size_t>(view)), bounds,
                                    [&](double x, double y) {
                                        return ground({x, y});
                                    }));
            return;
        }
        const auto along = [&](double low, double high) {
            return chance.between(0.9 * low + 0.1 * high, 0.1 * low + 0.9 * high);
        };
        const glm::dvec2 at(along(bounds.low.x, bounds.high.x), along(bounds.low.y, bounds.high.y));
        scene::Camera camera = scene::camera_from_angles(
            {at, ground(at) + 0.3}, chance.between(0.0, 360.0), chance.between(-10.0, 5.0));
        camera.near = 0.01;
        look(camera);
    }
};

// White ground on the ellipsoid below a sun alone, seen from all heights and as a map.
struct EarthSunStage : test::EarthStage {
    scene::Node* light = nullptr;
    bool shows_maps = false; // only

    explicit EarthSunStage(const test::EarthPlace& place)
        : EarthStage(place, test::must(terrains::generate_natural(
                                           {.size = side, .seed = 5, .spacing = 90.0}))
                                .heightfield.heights) {
        light = &scene.add_light();
        set(test::must(scene::parse_technique("exact:shadow=hard")));
    }
    [[nodiscard]] test::SunTolerance tolerance() const {
        const terrain::MinMax total = surface().pyramid().total();
        return {.metres = 0x1p-18 * std::max(std::abs(total.low), std::abs(total.high))};
    }
    void look_around(test::Chance& chance) {
        *light->get<scene::Light>() =
            test::bright_sun(chance.between(0.0, 360.0), chance.between(5.0, 80.0));
        const auto place = [&] {
            return glm::dvec2(chance.between(20.0, side - 20.0), chance.between(20.0, side - 20.0));
        };
        const glm::dvec2 from = place();
        constexpr std::array heights{0.3, 0.3, 30.0, 1000.0, 10'000.0};
        const int view = chance.whole(shows_maps ? static_cast<int>(heights.size()) : 0,
                                      static_cast<int>(heights.size()));
        if (view < static_cast<int>(heights.size())) {
            look(from, heights.at(static_cast<std::size_t>(view)), place());
            return;
        }
        look(scene::pose_camera(scene::Pose::map, surface().bounds(),
                                [](double /*x*/, double /*y*/) { return 0.0; }));
    }
};

// `draw`: the picture of a scene.
template <class Sunny, class Draw>
test::LightCounts compared_pictures(Sunny& stage, unsigned seed, int views, const Draw& draw) {
    test::Chance chance(seed);
    test::LightCounts counts;
    for (int view = 0; view < views; ++view) {
        stage.look_around(chance);
        const test::TrueSun truth(stage.scene, sunny_picture, stage.tolerance());
        counts += test::compared_light(truth, draw(stage.scene), compared_pixels, chance);
    }
    return counts;
}

// What a test has seen enough of: in each view so many pixels, at which the light is certain.
struct EnoughLight {
    int hidden = 60;
    int certain = 20'000; ///< of these, one may have another light
};
constexpr EnoughLight on_ellipsoid{.hidden = 10};

void expect_true_light(const test::LightCounts& counts, int views, EnoughLight enough = {}) {
    if (views >= enough_views) {
        EXPECT_GT(counts.lit, 100 * views);
        EXPECT_GT(counts.hidden, enough.hidden * views);
        EXPECT_LT(counts.unstable, counts.certain() / 50);
    }
    EXPECT_LE(counts.wrong(), counts.certain() / enough.certain)
        << counts.wrongly_dark << " dark, " << counts.wrongly_lit << " lit, of "
        << counts.certain();
}

terrain::Heightfield city() {
    return test::must(terrains::generate_urban({.size = 385, .seed = 3})).heightfield;
}

terrain::Heightfield mountains() {
    return test::must(terrains::generate_natural({.size = 257, .seed = 5})).heightfield;
}

// A lidar model: walls of 90 m in cells of 5 m, trees, water.
terrain::Heightfield scanned_city() {
    session::SourceOptions options;
    options.terrain = test::data_path("urban/delft/tud-dsm-5m.tif").string();
    terrain::Heightfield read = test::must(test::open_terrain(options)).terrain.heightfield;
    return test::plane_heightfield(std::move(read.heights), read.spacing);
}

Image sunlit_by_rays(const scene::Scene& scene) {
    Driver driver = test::must(Driver::create({.size = sunny_picture}));
    test::must(driver.draw(view::select(scene, sunny_picture)));
    return driver.read_color();
}

void expect_true_light_by_rays(const terrain::Heightfield& heightfield, unsigned seed) {
    const int views = test::rounds(enough_views, 2);
    SunStage stage(heightfield);
    stage.use("exact:shadow=hard");
    expect_true_light(compared_pictures(stage, seed, views, sunlit_by_rays), views);
}

TEST(TrueSun, ReachesWhatRaysLightInACity) {
    expect_true_light_by_rays(city(), 11);
}

TEST(TrueSun, ReachesWhatRaysLightInMountains) {
    expect_true_light_by_rays(mountains(), 12);
}

TEST(TrueSun, ReachesWhatRaysLightInAScannedCity) {
    RELJEF_NEED_DATA("urban/delft/tud-dsm-5m.tif");
    expect_true_light_by_rays(scanned_city(), 13);
}

std::span<const double> sunny_latitudes() {
    static constexpr std::array latitudes{45.0, 85.0, 0.1, -60.0};
    return std::span(latitudes).first(static_cast<std::size_t>(test::rounds(test::cases(2, 4), 1)));
}

TEST(TrueSun, ReachesWhatRaysLightOnTheEllipsoid) {
    const int views = test::rounds(enough_views, 1);
    for (const double latitude : sunny_latitudes()) {
        EarthSunStage stage({.latitude = latitude, .turn = latitude > 0.0 ? 20.0 : 0.0});
        SCOPED_TRACE(latitude);
        expect_true_light(compared_pictures(stage, 16, views, sunlit_by_rays), views, on_ellipsoid);
    }
}

// Some are half in the ground; all cast shadows on each other and on the ground. `place(sample)`:
// where the ground is at a part of its sides.
template <class Place>
void add_objects(scene::Scene& scene, double width, const Place& place, test::Chance& chance) {
    const auto size = static_cast<float>(0.06 * width);
    scene::Material grey;
    grey.color = glm::vec3(0.5F);
    for (int i = 0; i < 16; ++i) {
        const std::array meshes{scene::box_mesh({size, 0.5F * size, 3.0F * size}),
                                scene::sphere_mesh(size), scene::torus_mesh(size, 0.3F * size),
                                scene::cylinder_mesh(0.3F * size, 3.0F * size)};
        const double col = chance.between(0.0, 1.0);
        scene.add_mesh(meshes.at(static_cast<std::size_t>(i % 4)), grey)
            .set_position(place(glm::dvec2(col, chance.between(0.0, 1.0))) +
                          glm::dvec3(0.0, 0.0, 0.5 * size));
    }
}

TEST(TrueSun, ReachesWhatRaysLightOfMeshesAndBesideThem) {
    const int views = test::rounds(enough_views, 2);
    SunStage stage(mountains());
    stage.use("exact:shadow=hard");
    test::Chance chance(14);
    const Box bounds = stage.surface().bounds();
    const auto place = [&](glm::dvec2 part) {
        const glm::dvec2 at =
            glm::mix(glm::dvec2(bounds.low), glm::dvec2(bounds.high), glm::dvec2(part));
        return glm::dvec3(at, stage.ground(at));
    };
    add_objects(stage.scene, bounds.size().x, place, chance);
    expect_true_light(compared_pictures(stage, 15, views, sunlit_by_rays), views);
}

TEST(TrueSun, ReachesWhatRaysLightOfMeshesOnTheEllipsoid) {
    const int views = test::rounds(enough_views, 1);
    EarthSunStage stage({.latitude = 45.0, .step = 0.0003, .turn = 20.0});
    test::Chance chance(17);
    const auto place = [&](glm::dvec2 part) {
        const glm::dvec2 sample = part * (stage.side - 1.0);
        return stage.world({sample, terrain::bilinear_height(
                                        stage.surface().heightfield().heights.view(), sample)});
    };
    add_objects(stage.scene, stage.surface().bounds().size().x, place, chance);
    expect_true_light(compared_pictures(stage, 18, views, sunlit_by_rays), views, on_ellipsoid);
}

// Of maps: all tiles of the finest level are drawn.
TEST(TrueSun, ReachesWhatRaysLightOfTilesOnTheEllipsoid) {
    const int views = test::rounds(6, 1);
    for (const double latitude : sunny_latitudes()) {
        EarthSunStage stage({.latitude = latitude, .turn = latitude > 0.0 ? 20.0 : 0.0});
        SCOPED_TRACE(latitude);
        test::stream_samples(*stage.terrain->get<scene::TerrainNode>(), test::SeenLevels::finest);
        stage.shows_maps = true;
        const auto draw = [&](const scene::Scene& scene) {
            render::bring_tiles(stage.scene, sunny_picture);
            return sunlit_by_rays(scene);
        };
        const test::LightCounts counts = compared_pictures(stage, 19, views, draw);
        EXPECT_GT(counts.hidden, 10 * views);
        expect_true_light(counts, views, on_ellipsoid);
    }
}

TEST(TrueSun, IsLeftToOpenGlAroundAPole) {
    const auto obstacle = [](const test::EarthPlace& place) {
        EarthSunStage stage(place);
        stage.look({120.0, 120.0}, 1000.0, {140.0, 40.0});
        return obstacle_of(view::select(stage.scene, sunny_picture).list);
    };
    const std::string found = obstacle({.latitude = 89.0, .step = 0.008});
    EXPECT_NE(found.find("pole"), std::string::npos) << found;
    EXPECT_EQ(obstacle({.latitude = 85.0}), "");
}

class TrueSunGlTest : public test::GlTest {
protected:
    static constexpr int views = test::rounds(enough_views, 1);

    static test::LightCounts compared(const std::string& technique,
                                      const terrain::Heightfield& heightfield, unsigned seed) {
        SunStage stage(heightfield);
        stage.use(technique);
        session::SceneRenderer renderer = test::must(test::make_renderer(sunny_picture));
        const auto draw = [&](const scene::Scene& scene) {
            test::must(renderer.draw(scene));
            return renderer.read_color();
        };
        return compared_pictures(stage, seed, views, draw);
    }
};

TEST_F(TrueSunGlTest, ReachesWhatShadersLightInACity) {
    expect_true_light(compared("exact:shadow=hard", city(), 21), views);
}

TEST_F(TrueSunGlTest, ReachesWhatShadersLightInMountains) {
    expect_true_light(compared("exact:shadow=hard", mountains(), 22), views);
}

TEST_F(TrueSunGlTest, ReachesWhatShadersLightInAScannedCity) {
    RELJEF_NEED_DATA("urban/delft/tud-dsm-5m.tif");
    expect_true_light(compared("exact:shadow=hard", scanned_city(), 23), views);
}

// Without minimum steps cones find the true hits, within the secant of their last step.
TEST_F(TrueSunGlTest, ReachesWhatConesLight) {
    expect_true_light(compared("cone:step=0,shadow=hard", city(), 24), views, {.certain = 2000});
}

} // namespace
} // namespace reljef::cast
