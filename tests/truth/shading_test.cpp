#include "engine/truth/shading.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "engine/terrain/field/gradient.h"
#include "tests/render/made_scene.h"
#include "tests/terrain/chance.h"

namespace reljef::truth {
namespace {

constexpr scene::Light white_sun{.azimuth = 90.0,
                                 .altitude = 45.0,
                                 .color = glm::vec3(2.0F, 1.0F, 0.5F),
                                 .ambient = glm::vec3(0.2F, 0.3F, 0.4F)};

// A plane, 8 × 8 m, z rising by `slope` towards the east; white unless coloured.
scene::Scene sloped_scene(double slope, Image color = Image(9, 9, Rgba8{255, 255, 255, 255})) {
    scene::Scene scene;
    test::add_terrain(scene,
                      test::plane_heightfield(
                          test::made_heights(9, 9, [&](int col, int) { return slope * col; })),
                      std::move(color));
    return scene;
}

SceneHit place_at(double col, double row) {
    return {0, {0.0, {col, row, 0.0}}};
}

glm::vec3 shade(const scene::Scene& scene, const SceneHit& hit) {
    return Shading(scene, SceneCaster::create(scene).value()).at(hit);
}

void expect_near(glm::vec3 a, glm::vec3 b, float tolerance) {
    EXPECT_LE(glm::distance(a, b), tolerance)
        << a.r << ' ' << a.g << ' ' << a.b << " and " << b.r << ' ' << b.g << ' ' << b.b;
}

TEST(Shading, OfAPlaneIsLambertsLaw) {
    // Rising by −1 to the east, the slope faces the sun: N·L = 1, N.z = √½.
    scene::Scene facing = sloped_scene(-1.0);
    facing.add_light(white_sun);
    const float sky = 0.5F + 0.5F * std::sqrt(0.5F);
    expect_near(shade(facing, place_at(4.3, 3.7)), white_sun.color + white_sun.ambient * sky,
                1e-5F);
    scene::Scene level = sloped_scene(0.0);
    level.add_light(white_sun);
    expect_near(shade(level, place_at(4.3, 3.7)),
                white_sun.color * std::sqrt(0.5F) + white_sun.ambient, 1e-5F);
}

TEST(Shading, OfThePlaneBesideAMapHasNoAir) {
    scene::Sky sky;
    sky.plane = glm::vec3(0.4F, 0.3F, 0.2F);
    sky.visibility = 1000.0;
    const Backdrop backdrop{{}, sky};
    for (const auto projection :
         {scene::ProjectionKind::orthographic, scene::ProjectionKind::perspective}) {
        const Eye eye({.eye = {0.0, 0.0, 2000.0}, .up = {0.0, 1.0, 0.0}, .projection = projection},
                      {9, 9}, {{-5.0, -5.0, 0.0}, {5.0, 5.0, 1.0}});
        const float off = glm::distance(backdrop.behind(eye.ray(glm::dvec2(4.5)), eye), *sky.plane);
        EXPECT_EQ(off == 0.0F, projection == scene::ProjectionKind::orthographic) << off;
    }
}

// A slope of 45 degrees, and a lamp a metre above it along its normal.
TEST(Shading, OfAPlaneBelowAPointLightIsItsLaw) {
    for (const bool has_sun : {false, true}) {
        scene::Scene scene = sloped_scene(1.0);
        if (has_sun) {
            scene.add_light(white_sun);
        }
        const glm::vec3 without = shade(scene, place_at(4.0, 4.0));
        const double step = 2.0 * std::sqrt(0.5);
        const glm::dvec3 ground = test::surface_of(*scene.root().children().front())
                                      .placement()
                                      .world_from_sample({4.0, 4.0, 4.0});
        scene.add_point_light({.color = {1.0F, 0.5F, 0.25F}, .intensity = 3.0F, .range = 1e3F},
                              ground + glm::dvec3(-step, 0.0, step));
        const SceneHit hit{0, {0.0, {4.0, 4.0, 4.0}}};
        expect_near(shade(scene, hit) - without, glm::vec3(0.75F, 0.375F, 0.1875F), 1e-5F);
    }
}

// Boxes of a metre; the sun is in the east, at 45 degrees.
TEST(Shading, MeshesHideTheSunFromGroundAndFromEachOther) {
    scene::Scene scene = sloped_scene(0.0);
    const auto add_box = [&](glm::dvec3 at) {
        scene.add_mesh(scene::box_mesh(glm::vec3(1.0F))).set_position(at);
    };
    add_box({1.0, 0.0, 2.0});
    const glm::dvec3 to_sun = scene::to_light(white_sun);
    const auto sees = [&](double x, double y) {
        const auto caster = SceneCaster::create(scene).value();
        return sees_sun(caster, place_at(x + 4.0, 4.0 - y), to_sun);
    };
    // Its shadow goes from 2 m west of the middle to the middle.
    EXPECT_FALSE(sees(-1.9, 0.0));
    EXPECT_FALSE(sees(-0.1, 0.4));
    EXPECT_TRUE(sees(0.1, 0.0));
    EXPECT_TRUE(sees(-2.1, 0.0));
    EXPECT_TRUE(sees(-1.0, 0.6));
    const auto top_sees = [&] {
        const auto caster = SceneCaster::create(scene).value();
        const Ray down{{1.0, 0.0, 2.7}, {0.0, 0.0, -1.0}};
        const auto hit = caster.meshes().first_hit(down, {0.0, 1.0});
        return sees_sun(caster, hit.value(), down, to_sun);
    };
    EXPECT_TRUE(top_sees());
    add_box({3.0, 0.0, 4.5});
    EXPECT_FALSE(top_sees());
    const auto caster = SceneCaster::create(scene).value();
    const Ray east{{-3.0, 0.0, 2.0}, {1.0, 0.0, 0.0}};
    const auto west_side = caster.meshes().first_hit(east, {0.0, 10.0});
    EXPECT_NEAR(west_side->t, 3.5, 1e-9);
    EXPECT_FALSE(sees_sun(caster, *west_side, east, to_sun)) << "it is turned away";
}

TEST(Shading, WithoutALightItIsTheAlbedoBilinearInLinearColour) {
    Image color(2, 2, Rgba8{0, 0, 0, 255});
    color(1, 0) = {255, 128, 0, 255};
    const scene::Scene scene = sloped_scene(0.0, color);
    const float green = linear_from_rgba8({0, 128, 0, 255}).g;
    // Two texels over eight samples: corner on corner.
    expect_near(shade(scene, place_at(8.0, 0.0)), {1.0F, green, 0.0F}, 1e-6F);
    expect_near(shade(scene, place_at(4.0, 0.0)), {0.5F, 0.5F * green, 0.0F}, 1e-6F);
    expect_near(shade(scene, place_at(4.0, 4.0)), {0.25F, 0.25F * green, 0.0F}, 1e-6F);
    expect_near(shade(scene, place_at(8.0 + 1e-15, -1e-15)), {1.0F, green, 0.0F}, 1e-6F);
}

TEST(Shading, MixesSlopesNotColoursBetweenSamples) {
    scene::Scene scene;
    // Level, then rising: slopes 0 at col 0 … 3, ½ at 4, 1 from 5 on.
    const terrain::Heightfield heightfield = test::plane_heightfield(
        test::made_heights(9, 9, [](int col, int) { return std::max(col - 4, 0); }));
    test::add_terrain(scene, heightfield, Image(9, 9, Rgba8{255, 255, 255, 255}));
    scene::Light light = white_sun;
    light.azimuth = 270.0;
    light.color = glm::vec3(0.0F);
    scene.add_light(light);
    const auto sky_at = [](double slope) {
        return static_cast<float>(0.5 + 0.5 / std::hypot(slope, 1.0));
    };
    expect_near(shade(scene, place_at(4.5, 4.0)), light.ambient * sky_at(0.75), 1e-6F);
    expect_near(shade(scene, place_at(3.25, 4.0)), light.ambient * sky_at(0.125), 1e-6F);
}

TEST(Shading, AWallHidesTheSun) {
    scene::Scene scene;
    test::add_terrain(scene,
                      test::plane_heightfield(test::made_heights(
                          65, 9, [](int col, int) { return col == 40 ? 10.0 : 0.0; })),
                      Image(9, 9, Rgba8{255, 255, 255, 255}));
    scene.add_light(white_sun);
    expect_near(shade(scene, place_at(34.5, 4.0)), white_sun.ambient, 1e-5F);
    expect_near(shade(scene, place_at(20.5, 4.0)),
                white_sun.color * std::sqrt(0.5F) + white_sun.ambient, 1e-5F);
}

TEST(Shading, TurnsWithItsNode) {
    scene::Scene scene = sloped_scene(1.0); // faces west
    scene.root().children().front()->set_parent_from_local(
        glm::rotate(glm::dmat4(1.0), glm::radians(180.0), glm::dvec3(0.0, 0.0, 1.0)));
    scene.add_light(white_sun);
    const float sky = 0.5F + 0.5F * std::sqrt(0.5F);
    expect_near(shade(scene, place_at(4.3, 3.7)), white_sun.color + white_sun.ambient * sky, 1e-5F);
}

TEST(Shading, ManyPlanesAgainstTheFormula) {
    test::Chance chance(31);
    for (int i = 0; i < 300; ++i) {
        const double slope = chance.between(-2.0, 2.0);
        scene::Light light = white_sun;
        light.azimuth = chance.between(0.0, 360.0);
        light.altitude = 75.0;
        const glm::dvec3 normal = glm::normalize(glm::dvec3(-slope, 0.0, 1.0));
        const double sun = glm::dot(normal, scene::to_light(light));
        if (sun < 0.3) {
            continue; // a plane that the sun only grazes lies in its own penumbra
        }
        scene::Scene scene = sloped_scene(slope);
        scene.add_light(light);
        expect_near(shade(scene, place_at(chance.between(1.0, 7.0), chance.between(1.0, 7.0))),
                    light.color * static_cast<float>(sun) +
                        light.ambient * static_cast<float>(0.5 + 0.5 * normal.z),
                    1e-5F);
    }
}

const Ray level_ray{glm::dvec3(0.0), {0.0, 1.0, 0.0}};

TEST(Air, LeavesTwoPercentAtTheVisibility) {
    const scene::Sky sky{.horizon = glm::vec3(0.5F), .visibility = 1000.0};
    const glm::vec3 color(1.0F, 0.0F, 0.25F);
    expect_near(seen_through_air(sky, {}, color, level_ray, 0.0), color, 0.0F);
    expect_near(seen_through_air(sky, {}, color, level_ray, 1000.0),
                glm::mix(glm::vec3(0.5F), color, 0.02F), 1e-6F);
    expect_near(seen_through_air(sky, {}, color, level_ray, 500.0),
                glm::mix(glm::vec3(0.5F), color, std::sqrt(0.02F)), 1e-6F);
    expect_near(
        seen_through_air(sky, {}, color, level_ray, std::numeric_limits<double>::infinity()),
        glm::vec3(0.5F), 0.0F);
}

TEST(Air, WithoutFogChangesNothing) {
    expect_near(seen_through_air({}, {}, {0.1F, 0.2F, 0.3F}, level_ray, 1e7), {0.1F, 0.2F, 0.3F},
                0.0F);
}

// The depth of exponential air along a ray is H / sin · (exp(-z0 / H) - exp(-z1 / H)).
TEST(Air, IsThinnerAbove) {
    const scene::Sky sky{
        .horizon = glm::vec3(0.5F), .visibility = 4000.0, .air_height = 800.0, .base = 100.0};
    const glm::vec3 black(0.0F);
    for (const double sine : {-0.6, -0.1, 0.001, 0.3, 1.0}) {
        const Ray ray{{0.0, 0.0, 1500.0}, {std::sqrt(1.0 - sine * sine), 0.0, sine}};
        const double length = 2000.0;
        const double depth =
            scene::extinction(sky) * 800.0 / sine *
            (std::exp(-1400.0 / 800.0) - std::exp(-(1400.0 + sine * length) / 800.0));
        expect_near(seen_through_air(sky, {}, black, ray, length),
                    glm::vec3(static_cast<float>(0.5 * -std::expm1(-depth))), 1e-5F);
    }
}

TEST(Air, TakesEachColorByItsOwnFading) {
    const scene::Sky sky{
        .horizon = glm::vec3(0.0F), .visibility = 1000.0, .fading = {0.5F, 1.0F, 2.0F}};
    const glm::vec3 left = seen_through_air(sky, {}, glm::vec3(1.0F), level_ray, 1000.0);
    expect_near(left, {std::sqrt(0.02F), 0.02F, 0.0004F}, 1e-6F);
}

Ray ray_to(glm::dvec3 direction) {
    return {glm::dvec3(0.0), direction};
}

TEST(Sky, GoesFromHorizonToZenithWithoutABand) {
    const scene::Sky sky;
    expect_near(sky_color(sky, {}, ray_to({0.0, 0.0, 5.0})), sky.zenith, 1e-6F);
    expect_near(sky_color(sky, {}, ray_to({3.0, 4.0, 0.0})), sky.horizon, 1e-6F);
    expect_near(sky_color(sky, {}, ray_to({std::sqrt(24.0), 0.0, 1.0})),
                glm::mix(sky.horizon, sky.zenith, 0.2F * 1.2F / 0.4F), 1e-6F);
    expect_near(sky_color(sky, {}, ray_to({0.0, 0.0, -1.0})), sky.horizon, 1e-6F);
    // A minute of arc makes no step.
    expect_near(sky_color(sky, {}, ray_to({1.0, 0.0, 3e-4})), sky.horizon, 3e-3F);
}

TEST(Sky, HasAPlaneBelowWhichFadesIntoTheHorizon) {
    scene::Sky sky{.horizon = glm::vec3(0.5F), .visibility = 1000.0, .base = -10.0};
    sky.plane = glm::vec3(0.1F);
    const Ray down{{0.0, 0.0, 90.0}, {0.0, 0.0, -1.0}};
    const float left = std::pow(0.02F, 0.8F); // eight times as thick as the air
    expect_near(sky_color(sky, {}, down), glm::mix(sky.horizon, *sky.plane, left), 1e-5F);
    const Ray flat{{0.0, 0.0, 90.0}, {1.0, 0.0, -1e-5}};
    expect_near(sky_color(sky, {}, flat), sky.horizon, 1e-5F);
    const Ray below{{0.0, 0.0, -20.0}, {0.0, 0.0, -1.0}};
    expect_near(sky_color(sky, {}, below), sky.horizon, 1e-6F);
}

// The data end in the sea without a line: the plane looks as ground at the same place does.
TEST(Sky, HasASeaInTheSameAirAsTheTerrain) {
    scene::Sky sky{.horizon = glm::vec3(0.5F), .visibility = 1000.0, .base = -10.0};
    sky.plane = glm::vec3(0.1F);
    sky.is_plane_sea = true;
    for (const double air_height : {0.0, 30.0, 1e5}) {
        sky.air_height = air_height;
        for (const double fall : {1.0, 0.5, 0.01}) {
            const Ray ray{{0.0, 0.0, 90.0}, {std::sqrt(1.0 - fall * fall), 0.0, -fall}};
            expect_near(sky_color(sky, {}, ray),
                        seen_through_air(sky, {}, *sky.plane, ray, 100.0 / fall), 1e-5F);
        }
    }
}

// On the Earth that bends away: rays meet the sea up to its horizon, beyond which it fades.
TEST(Sky, HasASeaThatBendsAndFadesWithoutALineAtItsHorizon) {
    scene::Sky sky{.zenith = glm::vec3(0.5F), .horizon = glm::vec3(0.5F), .visibility = 5e4};
    sky.air_height = 400.0;
    sky.base = 7.0;
    sky.radius = 6.4e6;
    sky.plane = glm::vec3(0.1F);
    sky.is_plane_sea = true;
    for (const glm::dvec3 eye : {glm::dvec3(0.0, 0.0, 107.0), glm::dvec3(6e4, -3e4, -300.0)}) {
        const scene::AirPlace place = scene::air_place(sky, eye);
        const double above = place.above;
        EXPECT_NEAR(above, eye.x == 0.0 ? 100.0 : 44.6, 0.1);
        const glm::dvec3 along = glm::normalize(glm::cross(place.up, glm::dvec3(0.3, 1.0, 0.0)));
        const auto falling = [&](double fall) {
            return Ray{eye, std::sqrt(1.0 - fall * fall) * along - fall * place.up};
        };
        const double horizon = std::sqrt(2.0 * above / sky.radius);
        for (const double fall : {1.0, 0.3, 0.02, 1.1 * horizon}) {
            const double half = (sky.radius + above) * fall;
            const double distance =
                half - std::sqrt(half * half - 2.0 * sky.radius * above - above * above);
            const Ray ray = falling(fall);
            EXPECT_NEAR(scene::air_place(sky, eye + distance * ray.direction).above, 0.0, 1e-3);
            expect_near(sky_color(sky, {}, ray),
                        seen_through_air(sky, {}, *sky.plane, ray, distance), 2e-4F);
        }
        float darkness = 1.0F; // of the sea, against the horizon
        for (int i = 300; i >= 0; --i) {
            const float left = 0.5F - sky_color(sky, {}, falling(0.01 * i * horizon)).g;
            EXPECT_LE(left, darkness);
            EXPECT_LT(std::abs(left - darkness), i == 300 ? 1.0F : 0.03F) << i << "% of the way";
            darkness = left;
        }
        EXPECT_NEAR(darkness, 0.0F, 1e-6F) << "at level rays";
    }
}

// So little air lies before a far horizon that a sea which bends down would end in an edge.
TEST(Sky, HasASeaWithoutAnEdgeSeenFromAHeight) {
    scene::Sky sky{.zenith = glm::vec3(0.5F), .horizon = glm::vec3(0.5F), .visibility = 5e4};
    sky.air_height = 400.0;
    sky.radius = 6.4e6;
    sky.plane = glm::vec3(0.1F);
    sky.is_plane_sea = true;
    const double horizon = std::sqrt(2.0 * 9000.0 / sky.radius);
    const auto color_at = [&](double fall) {
        return sky_color(sky, {}, {{0.0, 0.0, 9000.0}, {std::sqrt(1.0 - fall * fall), 0.0, -fall}})
            .g;
    };
    for (int i = 150; i > 50; --i) {
        EXPECT_NEAR(color_at(0.01 * i * horizon), color_at(0.01 * (i - 1) * horizon), 0.004F)
            << i << "% of the way";
    }
}

TEST(Sky, HasTheSunWhereItIs) {
    const scene::Sky sky;
    const glm::dvec3 to_sun = scene::to_light(white_sun);
    const glm::vec3 behind = sky_color(sky, {}, ray_to(to_sun));
    expect_near(sky_color(sky, white_sun, ray_to(3.0 * to_sun)),
                behind + sky.glow + white_sun.color, 1e-5F);
    // 60 degrees off: cos⁸ = 1/256.
    const glm::dvec3 off =
        glm::dvec3(glm::rotate(glm::dmat4(1.0), glm::radians(60.0), glm::dvec3(0.0, 1.0, 0.0)) *
                   glm::dvec4(to_sun, 0.0));
    expect_near(sky_color(sky, white_sun, ray_to(off)),
                sky_color(sky, {}, ray_to(off)) + sky.glow / 256.0F, 1e-6F);
    expect_near(sky_color(sky, white_sun, ray_to(-to_sun)), sky_color(sky, {}, ray_to(-to_sun)),
                0.0F);
}

} // namespace
} // namespace reljef::truth
