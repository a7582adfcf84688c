// Precision: an eye a metre above the ground anywhere on Earth, and depths that lie close together.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/geo/place.h"
#include "tests/render/driver_fixture.h"
#include "tests/session/made_session.h"
#include "tests/terrain/chance.h"

namespace reljef::render {
namespace {

constexpr double max_pixels_off = 0.01;

/// Geocentric from east, north, up at a place.
glm::dmat4 earth_frame(double latitude, double longitude) {
    const double turn = glm::radians(longitude);
    const glm::dvec3 up = geo::normal_from_geodetic(latitude, longitude);
    const glm::dvec3 east(-std::sin(turn), std::cos(turn), 0.0);
    const glm::dvec3 origin = geo::geocentric_from_geodetic({latitude, longitude, 0.0});
    return {glm::dvec4(east, 0.0), glm::dvec4(glm::cross(up, east), 0.0), glm::dvec4(up, 0.0),
            glm::dvec4(origin, 1.0)};
}

/// Twenty metres of ground, a sample each ten centimetres, in geocentric metres.
struct Ground {
    Scene scene;
    Node* terrain = nullptr;
    Node* camera = nullptr;

    Ground() {
        terrain = &test::add_terrain(
            scene, test::plane_heightfield(test::hills(201, 201, 0.3), glm::dvec2(0.1)));
        camera = &scene.add_camera();
    }
    /// An eye a metre above the ground, which looks half down.
    void stand(const glm::dmat4& frame, glm::dvec2 at, double heading) {
        terrain->set_parent_from_local(frame);
        const double ground = surface_of(*terrain).height_at(at.x, at.y).value();
        const glm::dvec3 eye(at, ground + 1.0);
        const glm::dvec3 look = eye + glm::dvec3(std::sin(heading), std::cos(heading), -1.0);
        Camera view;
        view.eye = glm::dvec3(frame * glm::dvec4(eye, 1.0));
        view.target = glm::dvec3(frame * glm::dvec4(look, 1.0));
        view.up = glm::dvec3(frame[2]);
        *camera->get<Camera>() = view;
    }
    /// How far from its pixel a place is that a picture shows, by doubles; over all pixels.
    [[nodiscard]] double max_off(const HitBuffer& hits) const {
        double most = 0.0;
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                const Hit& hit = hits(x, y);
                if (hit.is_sky()) {
                    return infinity;
                }
                const glm::dvec3 local = surface_of(*terrain).placement().world_from_sample(
                    {hit.col, hit.row, hit.height});
                const glm::dvec3 world(terrain->world_from_local() * glm::dvec4(local, 1.0));
                const auto back = scene::project(scene.camera(), size, world);
                most = std::max(most, glm::distance(back.pixel, glm::dvec2(x + 0.5, y + 0.5)));
            }
        }
        return most;
    }
};

class EarthGlTest : public DriverGlTest {};

TEST_F(EarthGlTest, AMetreAboveTheGroundNoPixelIsAHundredthOffAnywhere) {
    Ground ground;
    session::SceneRenderer made = driver();
    test::Chance chance(71);
    std::vector<glm::dvec2> places{{0.0, 0.0},        {0.0, 180.0},      {0.0, -180.0},
                                   {45.0, 7.0},       {90.0, 0.0},       {-90.0, 33.0},
                                   {-17.0, 179.9999}, {89.99999, -120.0}};
    for (int i = 0; i < 8; ++i) {
        places.emplace_back(chance.between(-90.0, 90.0), chance.between(-180.0, 180.0));
    }
    for (const glm::dvec2 place : places) {
        ground.stand(earth_frame(place.x, place.y),
                     {chance.between(-6.0, 6.0), chance.between(-6.0, 6.0)},
                     chance.between(0.0, 6.0));
        EXPECT_LE(ground.max_off(test::must(made.draw_hits(ground.scene))), max_pixels_off)
            << place.x << "," << place.y;
    }
}

TEST_F(EarthGlTest, NothingJittersWhileTheEyeCreepsAMillimetreAFrame) {
    Ground ground;
    session::SceneRenderer made = driver();
    const glm::dmat4 frame = earth_frame(46.0, 7.0);
    for (int i = 0; i < 12; ++i) {
        ground.stand(frame, {1.0 + 0.001 * i, 2.0}, 0.7);
        ASSERT_LE(ground.max_off(test::must(made.draw_hits(ground.scene))), 0.5 * max_pixels_off)
            << "frame " << i;
    }
}

// What terrain.vert does with a vertex, in the same floats.
TEST(EarthPrecision, VerticesAreWhereTheyBelongFarFromTheMiddleOfTheirTerrain) {
    test::Chance chance(72);
    const double pixels = 0.5 * 768.0 / std::tan(glm::radians(0.5 * 57.3));
    for (int i = 0; i < 20000; ++i) {
        const double reach = std::pow(10.0, chance.between(0.0, 7.0));
        const glm::dvec3 eye(chance.between(-reach, reach), chance.between(-reach, reach),
                             chance.between(-reach, reach));
        const double distance = std::pow(10.0, chance.between(0.0, 5.0));
        const glm::dvec3 way(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0),
                             chance.between(-1.0, 1.0));
        const glm::dvec3 place = eye + way * distance;
        const view::GridVertex vertex = view::grid_vertex(place, 0.0, {});
        const SplitPoint split = split_into_floats(eye);
        const glm::vec3 from_eye = (vertex.position - split.rounded) + (vertex.rest - split.rest);
        const double off = glm::distance(glm::dvec3(from_eye), place - eye);
        ASSERT_LE(off * pixels / std::max(glm::length(place - eye), 1.0), max_pixels_off);
    }
}

TEST_F(EarthGlTest, OfTwoPlanesAFiveMillionthOfTheirDepthApartTheNearerShows) {
    constexpr int pairs = 13;
    constexpr int middle = 6; // of these
    constexpr double apart = 2e-7;
    constexpr double width = 0.05; // of a pair, metres at a depth of a metre
    Scene scene;
    Camera down;
    down.eye = {0.0, 0.0, 0.0};
    down.target = {0.0, 0.0, -1.0};
    down.up = {0.0, 1.0, 0.0};
    down.near = 0.1;
    scene.add_camera(down);
    for (int i = 0; i < pairs; ++i) {
        const double depth = std::pow(10.0, 6.0 * i / (pairs - 1));
        const double aside = (i - middle) * 2.0 * width * depth;
        for (const bool nearer : {i % 2 == 0, i % 2 != 0}) { // each drawn first in half of them
            scene::Material material;
            material.color = nearer ? glm::vec3(0.0F, 1.0F, 0.0F) : glm::vec3(1.0F, 0.0F, 0.0F);
            Node& plane = scene.add_mesh(
                scene::plane_mesh(glm::vec2(static_cast<float>(1.5 * width * depth))), material);
            plane.set_position({aside, 0.0, -depth * (nearer ? 1.0 : 1.0 + apart)});
        }
    }
    const Image picture = draw(scene);
    int green = 0;
    for (const Rgba8 color : picture.samples()) {
        green += color.g > 200 ? 1 : 0;
        ASSERT_LT(color.r, 200) << "a plane farther away";
    }
    EXPECT_GT(green, pairs * 100);
}

} // namespace
} // namespace reljef::render
