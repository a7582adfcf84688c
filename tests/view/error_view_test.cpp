#include "engine/view/error_view.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/terrain/mesh/bisection.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::render {
namespace {

glm::dvec3 chance_point(test::Chance& chance, double reach) {
    return {chance.between(-reach, reach), chance.between(-reach, reach),
            chance.between(-reach, reach)};
}

scene::Camera chance_camera(test::Chance& chance) {
    scene::Camera camera;
    camera.eye = chance_point(chance, 100.0);
    camera.target = chance_point(chance, 100.0);
    camera.vertical_fov = chance.between(1.0, 160.0);
    camera.projection =
        chance.one_in(3) ? scene::ProjectionKind::orthographic : scene::ProjectionKind::perspective;
    camera.view_height = chance.between(1.0, 300.0);
    return camera;
}

glm::dmat4 chance_transform(test::Chance& chance) {
    const auto moved = glm::translate(glm::dmat4(1.0), chance_point(chance, 50.0));
    const auto turned =
        glm::rotate(moved, chance.between(0.0, 6.0), glm::normalize(chance_point(chance, 1.0)));
    const glm::dvec3 scale(chance.between(0.5, 2.0), chance.between(0.5, 2.0),
                           chance.between(0.5, 2.0));
    auto whole = glm::scale(turned, chance.one_in(2) ? glm::dvec3(1.0) : scale);
    whole[1] += chance.one_in(3) ? 0.3 * whole[0] : glm::dvec4(0.0); // skewed
    return whole;
}

constexpr glm::ivec2 picture{640, 360};

bool is_seen(const scene::Camera& camera, glm::dvec3 world) {
    const auto [pixel, depth] = scene::project(camera, picture, world);
    const bool is_ahead =
        camera.projection == scene::ProjectionKind::orthographic || depth >= camera.near;
    return is_ahead && pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x <= picture.x &&
           pixel.y <= picture.y;
}

// A point of a triangle that is seen, and where it belongs; the ball around both says no more than
// that. Whatever the view then allows to leave unsplit must be seen within the error.
TEST(ErrorView, WhatIsLeftUnsplitIsSeenWithinTheErrorEverywhereOnThePicture) {
    test::Chance chance(11);
    int allowed = 0;
    int refused = 0;
    for (int i = 0; i < 300'000; ++i) {
        const scene::Camera camera = chance_camera(chance);
        const glm::dmat4 world_from_local = chance_transform(chance);
        const auto kind =
            chance.one_in(2) ? terrain::PlacementKind::plane : terrain::PlacementKind::ellipsoid;
        const double max_error = std::exp(chance.between(-1.0, 4.0));
        const auto view = view::error_view(camera, picture, world_from_local, kind, max_error);
        // Next to the near plane, or anywhere.
        const bool is_near = chance.one_in(2);
        const double error = (is_near ? camera.near : 1.0) * std::exp(chance.between(-7.0, 2.0));
        const glm::dvec3 eye(glm::inverse(world_from_local) * glm::dvec4(camera.eye, 1.0));
        const glm::dvec3 shown =
            is_near ? eye + chance_point(chance, 10.0 * camera.near) : chance_point(chance, 100.0);
        const glm::dvec3 way = kind == terrain::PlacementKind::plane
                                   ? glm::dvec3(0.0, 0.0, chance.one_in(2) ? 1.0 : -1.0)
                                   : glm::normalize(chance_point(chance, 1.0));
        const terrain::Split split{error, shown + 0.5 * error * way, 0.5 * error * 1.001};
        const auto world = [&](glm::dvec3 local) {
            return glm::dvec3(world_from_local * glm::dvec4(local, 1.0));
        };
        if (!is_seen(camera, world(shown))) {
            continue;
        }
        if (terrain::exceeds(view, split)) {
            ++refused;
            continue;
        }
        ++allowed;
        const auto at = scene::project(camera, picture, world(shown)).pixel;
        const auto belongs = scene::project(camera, picture, world(shown + error * way)).pixel;
        ASSERT_LE(glm::distance(at, belongs), max_error - view::rasterizer_error + 1e-9);
    }
    EXPECT_GT(allowed, 5000);
    EXPECT_GT(refused, 5000);
}

// Next to the eye the bound was left by up to 91,000 px, because cells were cut to a centimetre.
TEST(ErrorView, CellsBesideTheEyeAreCutAsFarAsTheBoundAsks) {
    const auto heightfield = test::plane_heightfield(
        test::made_heights(33, 33,
                           [](int col, int row) { return row < 16 ? 12.0 + 0.01 * col : 0.0; }),
        {0.5, 0.5});
    const auto placement =
        terrain::Placement::create(heightfield, terrain::PlacementKind::plane, 1.0).value();
    const terrain::Bisection bisection(heightfield, placement);
    test::Chance chance(12);
    for (int i = 0; i < 50; ++i) {
        const glm::dvec2 sample(chance.between(8.0, 24.0), chance.between(15.1, 15.9));
        const double height = terrain::bilinear_height(heightfield.heights.view(), sample);
        const double away = std::exp(chance.between(-12.0, -2.0));
        scene::Camera camera;
        camera.eye =
            glm::dvec3(placement.world_from_sample({sample, height})) + glm::dvec3(0.0, -away, 0.0);
        camera.target = camera.eye + chance_point(chance, 1.0);
        camera.near = 0.05 * away;
        const auto view =
            view::error_view(camera, picture, glm::dmat4(1.0), terrain::PlacementKind::plane, 1.0);
        const auto triangles =
            terrain::triangulate(bisection, {glm::ivec2(0), glm::ivec2(32)}, view);
        ASSERT_LE(triangles.error, view.max_error) << away << " m away";
    }
}

// The bound is no more than what is seen, for a vertical error seen level in the middle.
TEST(ErrorView, IsTightInTheMiddleOfALevelView) {
    scene::Camera camera;
    camera.eye = {0.0, 0.0, 0.0};
    camera.target = {0.0, 1.0, 0.0};
    const auto view =
        view::error_view(camera, picture, glm::dmat4(1.0), terrain::PlacementKind::plane, 1.0);
    const glm::dvec3 place(0.0, 1000.0, 0.0);
    const double metres_per_pixel =
        1000.0 * std::tan(0.5 * glm::radians(camera.vertical_fov)) / (0.5 * picture.y);
    const double left = metres_per_pixel * (1.0 - view.vertex_rounding);
    EXPECT_FALSE(terrain::exceeds(view, {0.99 * left, place, 0.0}));
    EXPECT_TRUE(terrain::exceeds(view, {1.01 * metres_per_pixel, place, 0.0}));
}

TEST(ErrorView, AVerticalErrorSeenFromStraightAboveIsNone) {
    scene::Camera camera;
    camera.eye = {0.0, 0.0, 100.0};
    camera.target = {0.0, 0.0, 0.0};
    camera.projection = scene::ProjectionKind::orthographic;
    camera.view_height = 100.0;
    const auto view =
        view::error_view(camera, picture, glm::dmat4(1.0), terrain::PlacementKind::plane, 1.0);
    EXPECT_FALSE(terrain::exceeds(view, {50.0, {0.0, 0.0, 0.0}, 60.0}));
}

// Seen places of a box that are off along verticals that turn, in any view.
TEST(PictureError, IsNeverBelowWhatABoxShows) {
    test::Chance chance(61);
    int checked = 0;
    double tightest = 0.0;
    for (int n = 0; n < 20000; ++n) {
        const scene::Camera camera = chance_camera(chance);
        const glm::dmat4 placed = chance_transform(chance);
        view::PictureError::Places places;
        const glm::dvec3 corner = chance_point(chance, 100.0);
        places.box = {corner,
                      corner + glm::abs(chance_point(chance, chance.one_in(2) ? 60.0 : 2.0))};
        places.error = std::exp(chance.between(-6.0, 3.0));
        places.up = glm::normalize(chance_point(chance, 1.0));
        places.turn = chance.one_in(2) ? 0.0 : chance.between(0.0, 0.5);
        const double bound = view::PictureError(camera, picture, placed).of(places);
        for (int i = 0; i < 20; ++i) {
            const glm::dvec3 share(chance.between(0, 1), chance.between(0, 1),
                                   chance.between(0, 1));
            const glm::dvec3 shown = glm::mix(places.box.low, places.box.high, share);
            const glm::dvec3 axis =
                glm::normalize(glm::cross(places.up, chance_point(chance, 1.0)));
            const glm::dvec3 up(glm::rotate(glm::dmat4(1.0), chance.between(0, places.turn), axis) *
                                glm::dvec4(places.up, 0.0));
            const glm::dvec3 belongs = shown + chance.between(-1, 1) * places.error * up;
            const glm::dvec3 a(placed * glm::dvec4(shown, 1.0));
            const glm::dvec3 b(placed * glm::dvec4(belongs, 1.0));
            if (!is_seen(camera, a) || std::isinf(bound)) {
                continue;
            }
            const double moved = glm::distance(scene::project(camera, picture, a).pixel,
                                               scene::project(camera, picture, b).pixel);
            ASSERT_LE(moved, bound * (1.0 + 1e-9)) << n;
            tightest = std::max(tightest, moved / bound);
            ++checked;
        }
    }
    EXPECT_GT(checked, 10000);
    EXPECT_GT(tightest, 0.9);
}

TEST(WiderPicture, ShowsTheSameAroundThePicture) {
    test::Chance chance(62);
    for (int n = 0; n < 2000; ++n) {
        const scene::Camera camera = chance_camera(chance);
        const view::WiderPicture wider = view::wider_picture(camera, picture, 15.2);
        ASSERT_EQ(wider.size, picture + 32);
        const glm::dvec3 point = chance_point(chance, 100.0);
        if (is_seen(camera, point)) {
            const glm::dvec2 pixel = scene::project(camera, picture, point).pixel;
            const glm::dvec2 among_more = scene::project(wider.camera, wider.size, point).pixel;
            ASSERT_LT(glm::distance(pixel + 16.0, among_more), 1e-6);
        }
    }
}

TEST(PictureError, IsUnboundedWhereTheTruePlacesMayBeAtTheEye) {
    scene::Camera camera;
    camera.eye = {0.0, 0.0, 10.0};
    camera.target = {0.0, 100.0, 10.0};
    const view::PictureError error(camera, picture, glm::dmat4(1.0));
    const Box around{{-50.0, -50.0, 0.0}, {50.0, 50.0, 20.0}};
    EXPECT_TRUE(
        std::isinf(error.of({around, 5.0, glm::normalize(glm::dvec3(0.0, 0.1, 1.0)), 0.0})));
    EXPECT_EQ(error.of({around, 0.0, {0.0, 0.0, 1.0}, 0.0}), 0.0);
}

} // namespace
} // namespace reljef::render
