#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "engine/geo/place.h"
#include "engine/terrain/measure/profile.h"
#include "engine/terrain/measure/sight.h"
#include "engine/terrain/measure/surface_point.h"
#include "tests/support/release_only.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

template <class Height> Heightfield made(int side, double spacing, const Height& height) {
    Heightfield field;
    field.heights = Grid<float>(side, side);
    field.spacing = glm::dvec2(spacing);
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            const double x = spacing * (col - 0.5 * (side - 1));
            const double y = spacing * (0.5 * (side - 1) - row);
            field.heights(col, row) = static_cast<float>(height(x, y));
        }
    }
    field.range = height_range(field.heights, {});
    return field;
}

Placement placed(const Heightfield& field, PlacementKind kind, double exaggeration = 1.0) {
    return Placement::create(field, kind, exaggeration).value();
}

struct Viewed {
    explicit Viewed(Heightfield made_field, PlacementKind kind = PlacementKind::plane)
        : field(std::move(made_field)), pyramid(field.heights.view()),
          placement(placed(field, kind)) {}
    [[nodiscard]] Grid<std::uint8_t> from(glm::dvec2 sample, double above,
                                          const ViewshedOptions& options = {}) const {
        const double ground = bilinear_height(field.heights.view(), sample);
        return viewshed(field, pyramid, placement, {sample, ground + above}, options).value();
    }

    Heightfield field;
    MinMaxPyramid pyramid;
    Placement placement;
};

bool is_visible(const Grid<std::uint8_t>& seen, int col, int row) {
    return seen(col, row) == static_cast<std::uint8_t>(SeenState::visible);
}

TEST(SurfacePoint, OfAPlaneHasItsSlopeAndAspectWhateverTheExaggeration) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    for (int i = 0; i < 200; ++i) {
        const double slope = 60.0 * any(random) + 0.5;
        const double aspect = 360.0 * any(random);
        const double fall = std::tan(glm::radians(slope));
        const glm::dvec2 down(std::sin(glm::radians(aspect)), std::cos(glm::radians(aspect)));
        const Heightfield field =
            made(17, 10.0, [&](double x, double y) { return -fall * (down.x * x + down.y * y); });
        const auto point =
            surface_point(field, placed(field, PlacementKind::plane, 1.0 + 4.0 * any(random)),
                          {16.0 * any(random), 16.0 * any(random)});
        ASSERT_TRUE(point && point->aspect);
        ASSERT_NEAR(point->slope, slope, 1e-3);
        ASSERT_NEAR(std::remainder(*point->aspect - aspect, 360.0), 0.0, 2e-2);
        ASSERT_FALSE(point->is_void);
    }
}

TEST(SurfacePoint, OfAConeHasTheConesSlope) {
    const Heightfield field =
        made(201, 1.0, [](double x, double y) { return -0.5 * std::hypot(x, y); });
    const Placement placement = placed(field, PlacementKind::plane);
    for (int degrees = 0; degrees < 360; degrees += 7) {
        const double a = glm::radians(static_cast<double>(degrees));
        const auto point = surface_point(field, placement,
                                         {100.0 + 80.0 * std::sin(a), 100.0 - 80.0 * std::cos(a)});
        ASSERT_TRUE(point && point->aspect);
        // The gradient turns by half a cell's diagonal times the curvature at most: 0.7 m · 0.5/80
        // m.
        EXPECT_NEAR(point->slope, glm::degrees(std::atan(0.5)), 0.2);
        EXPECT_NEAR(std::remainder(*point->aspect - degrees, 360.0), 0.0, 0.6);
    }
}

TEST(SurfacePoint, LevelGroundHasNoAspectAndNoPlaceNoPoint) {
    Heightfield field = made(5, 1.0, [](double, double) { return 7.0; });
    field.void_mask = Grid<std::uint8_t>(5, 5);
    field.void_mask(4, 4) = 1;
    const Placement placement = placed(field, PlacementKind::plane);
    const auto level = surface_point(field, placement, {1.5, 1.5});
    ASSERT_TRUE(level);
    EXPECT_EQ(level->height, 7.0);
    EXPECT_EQ(level->slope, 0.0);
    EXPECT_FALSE(level->aspect || level->is_void);
    EXPECT_TRUE(surface_point(field, placement, {3.5, 3.5})->is_void);
    for (const glm::dvec2 outside :
         {glm::dvec2(-0.1, 1.0), {4.1, 1.0}, {1.0, 4.1}, {not_a_number, 1.0}, {1.0, HUGE_VAL}}) {
        EXPECT_FALSE(surface_point(field, placement, outside));
    }
}

TEST(Profile, OfASlopeIsLongerThanItsMap) {
    std::vector<ProfilePoint> points;
    for (int i = 0; i <= 100; ++i) {
        points.push_back({4.0 * i, 3.0 * (i < 50 ? i : 100 - i)});
    }
    const ProfileSummary found = summarize(points);
    EXPECT_NEAR(found.distance, 400.0, 1e-9);
    EXPECT_NEAR(found.over_ground, 500.0, 1e-9);
    EXPECT_NEAR(found.climb, 150.0, 1e-9);
    EXPECT_NEAR(found.descent, 150.0, 1e-9);
    EXPECT_EQ(found.lowest, 0.0);
    EXPECT_EQ(found.highest, 150.0);
    EXPECT_EQ(found.missing, 0);
}

TEST(Profile, VoidsAreCountedAndLevel) {
    const std::vector<ProfilePoint> points{{0.0, not_a_number}, {10.0, 5.0}, {20.0, not_a_number}};
    const ProfileSummary found = summarize(points);
    EXPECT_EQ(found.missing, 2);
    EXPECT_EQ(found.over_ground, 20.0);
    EXPECT_EQ(found.lowest, 5.0);
    EXPECT_TRUE(std::isnan(summarize(std::vector<ProfilePoint>{{0.0, not_a_number}}).highest));
}

TEST(Profile, PlacesLieOnTheGeodesicAtEqualDistances) {
    const geo::Geodetic from{46.0, 179.5, 100.0};
    const geo::Geodetic to{47.0, -179.0, 200.0};
    const auto places = geodesic_places(from, to, 1000.0);
    ASSERT_TRUE(places);
    const double whole = geo::geodesic_between(from, to).distance;
    const double step = whole / static_cast<double>(places->size() - 1);
    EXPECT_LE(step, 1000.0);
    EXPECT_EQ(places->front().latitude, from.latitude);
    EXPECT_EQ(places->back().longitude, to.longitude);
    for (std::size_t i = 1; i < places->size(); ++i) {
        ASSERT_NEAR(geo::geodesic_between((*places)[i - 1], (*places)[i]).distance, step, 1e-6);
        ASSERT_NEAR(geo::geodesic_between(from, (*places)[i]).distance,
                    static_cast<double>(i) * step, 1e-6);
    }
}

TEST(Profile, BadPlacesAndStepsAreErrors) {
    const geo::Geodetic here{46.0, 8.0, 0.0};
    for (const double step : {0.0, -1.0, not_a_number, 1e-9}) {
        EXPECT_FALSE(geodesic_places(here, {47.0, 8.0, 0.0}, step)) << step;
    }
    for (const double odd : {not_a_number, HUGE_VAL, 91.0}) {
        EXPECT_FALSE(geodesic_places(here, {odd, 8.0, 0.0}, 10.0)) << odd;
    }
    EXPECT_EQ(geodesic_places(here, here, 10.0)->size(), 2U);
}

TEST(Viewshed, LevelPlaneIsAllSeen) {
    const Viewed level(made(65, 10.0, [](double, double) { return 100.0; }));
    const auto seen = level.from({20.3, 40.6}, 2.0);
    for (int row = 0; row < 65; ++row) {
        for (int col = 0; col < 65; ++col) {
            ASSERT_TRUE(is_visible(seen, col, row)) << col << ' ' << row;
        }
    }
}

// A wall from north to south hides what lies below the line over its top.
TEST(Viewshed, WallHidesWhatSimilarTrianglesSay) {
    const Viewed walled(
        made(201, 1.0, [](double x, double) { return std::abs(x) < 0.5 ? 10.0 : 0.0; }));
    const auto seen = walled.from({50.0, 100.0}, 30.0);
    // The eye is 50 m west of the wall's top: 30 m, 10 m. The shadow ends 75 m east of the eye.
    for (int col = 0; col < 201; ++col) {
        const bool is_in_shadow = col > 101 && col < 125;
        const bool is_border = col == 101 || col == 125 || col == 100;
        ASSERT_TRUE(is_border || is_visible(seen, col, 100) != is_in_shadow) << col;
    }
    ViewshedOptions tall;
    tall.target_height = 9.0;
    const auto tops = walled.from({50.0, 100.0}, 30.0, tall);
    for (int col = 0; col < 201; ++col) {
        const bool is_in_shadow = col == 102; // 9 m end at 52.5 m from the eye
        ASSERT_TRUE(col == 101 || is_visible(tops, col, 100) != is_in_shadow) << col;
    }
}

TEST(Viewshed, FarSideOfAConeIsHidden) {
    const Viewed cone(made(
        201, 1.0, [](double x, double y) { return std::max(0.0, 50.0 - 0.5 * std::hypot(x, y)); }));
    const auto seen = cone.from({100.0, 180.0}, 1.0); // south of the peak, on its slope
    for (int step = 3; step < 90; ++step) {
        ASSERT_FALSE(is_visible(seen, 100, 100 - step)) << step << " north of the peak";
        ASSERT_TRUE(step > 75 || is_visible(seen, 100, 100 + step)) << step << " south of it";
    }
}

TEST(Viewshed, FarthestSamplesAndVoidsAreLeftOut) {
    Heightfield field = made(65, 10.0, [](double, double) { return 0.0; });
    field.void_mask = Grid<std::uint8_t>(65, 65);
    field.void_mask(32, 30) = 1;
    const Viewed level(std::move(field));
    ViewshedOptions near;
    near.max_distance = 100.0;
    const auto seen = level.from({32.0, 32.0}, 2.0, near);
    EXPECT_EQ(seen(32, 30), static_cast<std::uint8_t>(SeenState::unknown));
    EXPECT_TRUE(is_visible(seen, 42, 32));
    EXPECT_FALSE(is_visible(seen, 43, 32));
}

TEST(Viewshed, StopsWhenAsked) {
    const Viewed level(made(65, 10.0, [](double, double) { return 0.0; }));
    std::stop_source stop;
    stop.request_stop();
    ViewshedOptions options;
    options.parallel.stop = stop.get_token();
    EXPECT_FALSE(viewshed(level.field, level.pyramid, level.placement, {32.0, 32.0, 2.0}, options));
}

// Level ground on the ellipsoid: the horizon of an eye h metres above it is at sqrt(2·R·h).
TEST(Viewshed, OnTheEllipsoidTheHorizonIsWhereTheEarthCurvesAway) {
    constexpr int side = 401;
    constexpr double degrees = 0.001; // between samples
    Heightfield field =
        test::geographic_heightfield(Grid<float>(side, side, 0.0F), 46.2, 8.0, degrees);
    const Viewed sea(std::move(field), PlacementKind::ellipsoid);
    const glm::dvec2 middle(200.0, 200.0);
    constexpr double eye_height = 10.0;
    const auto seen = sea.from(middle, eye_height);
    const double radius = geo::radii_of_earth().x;
    const double horizon = std::sqrt(2.0 * radius * eye_height);
    const auto place = [&](int col, int row) {
        return *sea.placement.geodetic_from_world(sea.placement.world_from_sample({col, row, 0.0}));
    };
    constexpr int apart = test::rounds(3, 9);
    int checked = 0;
    for (int row = 0; row < side; row += apart) {
        for (int col = 0; col < side; col += apart) {
            const double distance = geo::geodesic_distance(place(200, 200), place(col, row));
            // Radii of curvature differ by less than 1 %, chords of cells by less than 0.1 mm; the
            // tolerance of 2 mm of ground is seen sqrt(2·R·0.002) = 160 m beyond the horizon.
            if (distance < 0.98 * horizon) {
                ASSERT_TRUE(is_visible(seen, col, row)) << distance;
                ++checked;
            } else if (distance > 1.02 * horizon + 160.0) {
                ASSERT_FALSE(is_visible(seen, col, row)) << distance;
                ++checked;
            }
        }
    }
    EXPECT_GT(checked, 135'000 / (apart * apart));
}

TEST(Sight, PlacesThatAreNoPlacesAreNoObstacle) {
    const Viewed level(made(9, 1.0, [](double, double) { return 0.0; }));
    const SurfaceCaster caster(level.field.heights.view(), level.pyramid, level.placement);
    EXPECT_FALSE(obstacle_between(caster, {0.0, 0.0, 1.0}, {not_a_number, 0.0, 1.0}));
    EXPECT_FALSE(obstacle_between(caster, {0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}));
    const auto hit = obstacle_between(caster, {0.0, 0.0, 1.0}, {1.0, 0.0, -1.0});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, 0.5, 1e-12);
}

} // namespace
} // namespace reljef::terrain
