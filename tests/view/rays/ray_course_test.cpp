#include "engine/view/rays/ray_course.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/view/draw_list.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::view {
namespace {

constexpr glm::ivec2 size{1024, 768};
constexpr int side = 1201;

terrain::Placement placed(double latitude, double step, double longitude = 6.0) {
    return test::placed(test::geographic_heightfield(Grid<float>(side, side, 0.0F), latitude,
                                                     longitude, step, 10.0),
                        1.5);
}

Box all_samples() {
    return {{0.0, 0.0, -100.0}, {side - 1.0, side - 1.0, 4000.0}};
}

scene::Camera camera_at(glm::dvec3 eye) {
    scene::Camera camera;
    camera.eye = eye;
    return camera;
}

// On a ray from a sample to the sun.
glm::dvec3 sample_along(const RayCourse& course, glm::dvec3 sample, glm::dvec3 relative,
                        double part) {
    const glm::dvec3 d = course.unit_from_relative * relative;
    std::size_t term = 0;
    for (int order = 1; order <= 4; ++order) {
        glm::dvec3 factor(0.0);
        for (int total = 0; total <= 4 - order; ++total) {
            for (int x = total; x >= 0; --x) {
                for (int y = total - x; y >= 0; --y) {
                    factor += std::pow(d.x, x) * std::pow(d.y, y) * std::pow(d.z, total - x - y) *
                              course.light->terms[term++];
                }
            }
        }
        sample += std::pow(part, order) * factor;
    }
    return sample;
}

// In a node that is turned and moved, too.
TEST(RayCourse, FindsTheSamplesOfPlacesWithinItsError) {
    const glm::dmat4 world_from_local =
        glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(1e3, -2e3, 50.0)), 0.7,
                    glm::dvec3(0.0, 0.0, 1.0));
    test::Chance chance(3);
    for (const double latitude : {1.0, 47.0, -35.0, 71.0}) {
        const terrain::Placement placement = placed(latitude, 1.0 / 1200.0);
        const glm::dvec3 local_eye =
            placement.world_from_sample({300.0, 700.0, latitude > 40.0 ? 4500.0 : 1e4});
        const glm::dvec3 eye(world_from_local * glm::dvec4(local_eye, 1.0));
        const auto course =
            ray_course(camera_at(eye), size, world_from_local, placement, all_samples());
        ASSERT_TRUE(course) << latitude;
        EXPECT_LT(glm::distance(placement.world_from_sample(course->eye), local_eye), 1e-6);
        double worst = 0.0;
        for (int i = 0; i < 3000; ++i) {
            const glm::dvec3 part(chance.between(0, 1), chance.between(0, 1), chance.between(0, 1));
            const glm::dvec3 sample = course->samples.low + part * course->samples.size();
            const glm::dvec3 place = placement.world_from_sample(sample);
            const glm::dvec3 relative = glm::dmat3(world_from_local) * (place - local_eye);
            const glm::dvec3 found = placement.world_from_sample(course->sample(relative));
            worst = std::max(worst, glm::distance(found, place) / glm::distance(place, local_eye));
        }
        EXPECT_LE(worst, 1.1 * course->error) << latitude;
        EXPECT_GE(worst, 0.1 * course->error) << latitude;
    }
}

// Between square roots of distances that are equally far apart.
TEST(RayCourse, ChordsAreSeenBesideTheRayByNoMoreThanItsCurvatureSays) {
    test::Chance chance(4);
    for (const double latitude : {1.0, 47.0, 71.0, 84.0}) {
        const terrain::Placement placement = placed(latitude, 1.0 / 4800.0);
        const glm::dvec3 eye = placement.world_from_sample({600.0, 600.0, 1000.0});
        const auto course =
            ray_course(camera_at(eye), size, glm::dmat4(1.0), placement, all_samples());
        ASSERT_TRUE(course) << latitude;
        double largest = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const double angle = chance.between(0.0, 2.0 * std::numbers::pi);
            const glm::dvec3 way(std::cos(angle), std::sin(angle), 0.0);
            const double first = chance.between(0.0, 60.0);
            const double second = first + chance.between(1.0, 20.0);
            const double begin = first * first;
            const double end = second * second;
            const double at = chance.between(begin, end);
            const glm::dvec3 chord =
                glm::mix(course->sample(begin * way), course->sample(end * way),
                         (at - begin) / (end - begin));
            const double seen =
                glm::distance(placement.world_from_sample(chord), eye + at * way) / at;
            const double bound = 0.5 * course->curvature * (second - first) * (second - first);
            EXPECT_LE(seen, 1.001 * bound + 1e-10);
            largest = std::max(largest, seen / bound);
        }
        EXPECT_GT(largest, 0.3) << latitude;
    }
}

// Straight rays from places of the surface, over all that they cross.
TEST(RayCourse, LeadsRaysFromTheSurfaceToTheSun) {
    test::Chance chance(5);
    for (const double latitude : {1.0, 47.0, 71.0}) {
        const terrain::Placement placement = placed(latitude, 1.0 / 1200.0);
        const glm::dvec3 eye = placement.world_from_sample({600.0, 700.0, 3000.0});
        Box near = all_samples();
        near.low = {580.0, 640.0, -100.0};
        near.high = {620.0, 700.0, 4000.0};
        for (const double altitude : {2.0, 15.0, 60.0}) {
            const double angle = glm::radians(altitude);
            const glm::dvec3 to_sun =
                std::sin(angle) * placement.up(eye) + std::cos(angle) * placement.north(eye);
            const auto course = ray_course(camera_at(eye), size, glm::dmat4(1.0), placement, near,
                                           SunRays{to_sun, all_samples()});
            ASSERT_TRUE(course && course->light) << latitude << ", " << altitude;
            const LightCourse& light = *course->light;
            // 1.5 times the range of heights.
            EXPECT_GE(light.reach * std::sin(angle), 0.9 * 1.5 * 4100.0 * (altitude > 5.0));
            double worst = 0.0;
            for (int i = 0; i < 500; ++i) {
                const glm::dvec3 sample =
                    near.low + near.size() * glm::dvec3(chance.between(0, 1), chance.between(0, 1),
                                                        chance.between(0, 1));
                const glm::dvec3 place = placement.world_from_sample(sample);
                const double part = chance.between(0.0, 1.0);
                const glm::dvec3 there = place + part * light.reach * to_sun;
                const auto found = sample_along(*course, sample, place - eye, part);
                const glm::dvec3 beside = placement.world_from_sample(found) - there;
                const glm::dvec2 at(found);
                if (at.y >= light.samples.low.y && at.y <= light.samples.high.y) {
                    worst = std::max(worst, glm::length(beside) / (part * light.reach));
                }
            }
            EXPECT_LT(worst, max_light_error) << latitude << ", " << altitude;
        }
    }
}

TEST(RayCourse, HasAllSamplesWithinTheHorizon) {
    const terrain::Placement placement = placed(60.0, 1.0 / 50.0);
    const Box all{{0.0, 0.0, 0.0}, {side - 1.0, side - 1.0, 100.0}};
    const glm::dvec3 eye = placement.world_from_sample({600.0, 600.0, 50.0});
    const auto course = ray_course(camera_at(eye), size, glm::dmat4(1.0), placement, all);
    ASSERT_TRUE(course);
    EXPECT_LT(course->samples.size().x, 150.0);
    // 25 km and 36 km to where the ground of height 0 touches a ray.
    constexpr double reach = 60e3;
    const glm::dvec3 up = placement.up(eye);
    for (int i = 0; i < 360; ++i) {
        const double angle = glm::radians(static_cast<double>(i));
        const glm::dvec3 north = placement.north(eye);
        const glm::dvec3 way = std::cos(angle) * north + std::sin(angle) * glm::cross(north, up);
        const auto sample = placement.sample_from_world(eye + reach * way);
        ASSERT_TRUE(sample);
        for (int axis = 0; axis < 2; ++axis) {
            EXPECT_GE((*sample)[axis], course->samples.low[axis]);
            EXPECT_LE((*sample)[axis], course->samples.high[axis]);
        }
    }
}

// Far beside them there are no samples.
TEST(RayCourse, IsThereForTerrainsOfCentimetres) {
    const terrain::Placement placement =
        test::placed(test::geographic_heightfield(Grid<float>(129, 129, 100.0F), 45.0, 7.0, 1e-8));
    for (const double above : {0.3, 30.0}) {
        const glm::dvec3 eye = placement.world_from_sample({60.0, 100.0, 100.0 + above});
        EXPECT_TRUE(ray_course(camera_at(eye), size, glm::dmat4(1.0), placement,
                               {{0.0, 0.0, 100.0}, {128.0, 128.0, 100.001}}))
            << above;
    }
}

TEST(RayCourse, MapsPlacesWhereNoPolynomialIsPreciseOrRaysAreParallel) {
    const terrain::Placement placement = placed(45.0, 1.0 / 1200.0);
    const auto at_pole = placed(89.999, 1.0 / 1200.0);
    const auto maps_places = [](const scene::Camera& camera, const terrain::Placement& on) {
        const auto course = ray_course(camera, size, glm::dmat4(1.0), on, all_samples());
        return course && course->degrees;
    };
    const glm::dvec3 eye = placement.world_from_sample({600.0, 600.0, 3000.0});
    EXPECT_FALSE(maps_places(camera_at(eye), placement));
    scene::Camera parallel = camera_at(eye);
    parallel.view_height = 1e5;
    parallel.projection = scene::ProjectionKind::orthographic;
    EXPECT_TRUE(maps_places(parallel, placement));
    EXPECT_TRUE(maps_places(camera_at(at_pole.world_from_sample({10.0, 10.0, 3000.0})), at_pole));
    EXPECT_TRUE(
        maps_places(camera_at(placement.world_from_sample({600.0, 600.0, 1e7})), placement));
}

// Floats of columns behind it have the digits of a turn: metres at the equator.
TEST(RayCourse, IsNoneNearWhereLongitudesBeginAnew) {
    const terrain::Placement globe = test::placed(test::closed_globe(300, 0.5, 1.0, 11));
    const Box all{{0.0, 0.0, -100.0}, {*globe.columns_all_around(), 302.0, 100.0}};
    const auto is_there = [&](double longitude, double height) {
        const auto eye = globe.world_from_geodetic({10.0, longitude, height});
        return ray_course(camera_at(*eye), size, glm::dmat4(1.0), globe, all).has_value();
    };
    EXPECT_TRUE(is_there(90.0, 1e3));
    EXPECT_TRUE(is_there(179.99, 1e5));
    EXPECT_FALSE(is_there(179.99, 1e3));
}

// Of a degree and of ten degrees of ground.
TEST(RayCourse, LeavesOutTheFourthDegreeOnlyWhereNoPixelShowsIt) {
    test::Chance chance(4);
    for (const double step : {1.0 / 1200.0, 1.0 / 120.0}) {
        const terrain::Placement placement = placed(47.0, step);
        const glm::dvec3 eye = placement.world_from_sample({600.0, 1150.0, 32'000.0});
        const auto course =
            ray_course(camera_at(eye), size, glm::dmat4(1.0), placement, all_samples());
        ASSERT_TRUE(course) << step;
        EXPECT_EQ(course->needs_quartic, step > 0.001);
        RayCourse cubic = *course;
        std::fill(cubic.terms.begin() + 19, cubic.terms.end(), glm::dvec3(0.0));
        double worst = 0.0; // radians
        for (int i = 0; i < 3000; ++i) {
            const glm::dvec3 part(chance.between(0, 1), chance.between(0, 1), chance.between(0, 1));
            const glm::dvec3 sample = course->samples.low + part * course->samples.size();
            const glm::dvec3 relative = placement.world_from_sample(sample) - eye;
            const glm::dvec3 found = placement.world_from_sample(course->sample(relative));
            const glm::dvec3 without = placement.world_from_sample(cubic.sample(relative));
            worst = std::max(worst, glm::distance(found, without) / glm::length(relative));
        }
        const double pixels = worst / scene::metres_a_pixel(camera_at(eye), size).y;
        EXPECT_EQ(pixels > 1.1 * max_quartic_error, course->needs_quartic) << pixels;
    }
}

} // namespace
} // namespace reljef::view
