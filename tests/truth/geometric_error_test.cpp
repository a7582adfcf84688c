#include "engine/truth/geometric_error.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "engine/terrain/field/surface_caster.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::truth {
namespace {

constexpr float unbounded_error = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr Hit sky_hit{};
constexpr Hit mesh_hit{-1.0F, -1.0F, 0.0F, 20.0F};

Hit hit_at(double col, double row) {
    return {static_cast<float>(col), static_cast<float>(row), 0.0F, 1.0F};
}

// A surface, where it stands, and who looks: kept together, as the view borrows.
struct Setting {
    explicit Setting(terrain::Heightfield made)
        : heightfield(std::move(made)), placement(test::placed(heightfield)),
          pyramid(heightfield.heights.view()) {}

    [[nodiscard]] SurfaceView view() const {
        return {heightfield.heights.view(), placement, world_from_local, camera};
    }

    terrain::Heightfield heightfield;
    terrain::Placement placement;
    terrain::MinMaxPyramid pyramid;
    glm::dmat4 world_from_local{1.0};
    scene::Camera camera;
};

// What an exact ray cast through each pixel's centre meets, rounded to the hit's floats.
HitBuffer picked(const Setting& setting, glm::ivec2 size) {
    const glm::dmat4 local_from_world = glm::inverse(setting.world_from_local);
    const terrain::SurfaceCaster exact(setting.heightfield.heights.view(), setting.pyramid,
                                       setting.placement);
    HitBuffer hits(size.x, size.y);
    for (int row = 0; row < size.y; ++row) {
        for (int col = 0; col < size.x; ++col) {
            const Ray ray = scene::view_ray(setting.camera, size, glm::dvec2(col, row) + 0.5);
            const Ray local{glm::dvec3(local_from_world * glm::dvec4(ray.origin, 1.0)),
                            glm::dmat3(local_from_world) * ray.direction};
            if (const auto hit = exact.first_hit(local)) {
                hits(col, row) = {static_cast<float>(hit->sample.x),
                                  static_cast<float>(hit->sample.y),
                                  static_cast<float>(hit->sample.z), static_cast<float>(hit->t)};
            }
        }
    }
    return hits;
}

// A level plane of 257×257 samples seen straight from above, `pixels` to a sample.
Setting seen_from_above(double pixels, int rows) {
    Setting setting(test::plane_heightfield(Grid<float>(257, 257, 40.0F), {2.0, 2.0}));
    setting.camera.projection = scene::ProjectionKind::orthographic;
    setting.camera.eye = {0.0, 0.0, 500.0};
    setting.camera.target = {0.0, 0.0, 0.0};
    setting.camera.up = {0.0, 1.0, 0.0};
    setting.camera.view_height = rows * 2.0 / pixels;
    return setting;
}

HitBuffer moved(HitBuffer hits, glm::vec2 texels) {
    for (Hit& hit : hits.samples()) {
        if (shows_terrain(hit)) {
            hit.col += texels.x;
            hit.row += texels.y;
        }
    }
    return hits;
}

// Hills of a few waves, looked down at from their southern edge.
Setting hills(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> phase(0.0, 6.28);
    const double a = phase(random);
    const double b = phase(random);
    Setting setting(test::plane_heightfield(test::made_heights(200, 180,
                                                               [&](int col, int row) {
                                                                   return 60.0 *
                                                                          std::sin(0.05 * col + a) *
                                                                          std::cos(0.07 * row + b);
                                                               }),
                                            {10.0, 12.0}));
    setting.camera.eye = {100.0 * std::sin(a), -1000.0, 500.0 + 40.0 * b};
    setting.camera.target = {50.0 * std::sin(b), 100.0, 0.0};
    return setting;
}

TEST(ReprojectionError, OfAFrameShiftedByThreePixelsIsThree) {
    for (const double pixels : {0.5, 1.0, 4.0}) {
        const glm::ivec2 size(48, 32);
        const Setting setting = seen_from_above(pixels, size.y);
        const HitBuffer truth = picked(setting, size);
        const auto texels = static_cast<float>(3.0 / pixels);
        for (const glm::vec2 shift :
             {glm::vec2(texels, 0.0F), glm::vec2(-texels, 0.0F), glm::vec2(0.0F, texels),
              glm::vec2(0.6F * texels, -0.8F * texels)}) {
            const auto errors = geometric_errors(setting.view(), moved(truth, shift), truth);
            ASSERT_TRUE(errors);
            for (const float error : errors->reprojection.map.samples()) {
                ASSERT_NEAR(error, 3.0F, 1e-4F);
            }
            const Distribution& told = errors->reprojection.distribution.value();
            EXPECT_EQ(told.count, 48U * 32U);
            for (const double figure : {told.median, told.p95, told.p99, told.max, told.rms}) {
                EXPECT_NEAR(figure, 3.0, 1e-4);
            }
            EXPECT_NEAR(errors->hit.distribution.value().median, 3.0 / pixels, 1e-4);
        }
    }
}

// How many pixels a place moves for a texel of movement, at most, and along either axis.
double pixels_per_texel(const Setting& setting, glm::ivec2 size, const Hit& hit) {
    const auto pixel_of = [&](glm::dvec2 texel) {
        const double height = terrain::bilinear_height(setting.heightfield.heights.view(), texel);
        const glm::dvec3 local = setting.placement.world_from_sample({texel, height});
        return scene::project(setting.camera, size,
                              glm::dvec3(setting.world_from_local * glm::dvec4(local, 1.0)))
            .pixel;
    };
    constexpr double step = 1e-3;
    const glm::dvec2 texel(hit.col, hit.row);
    double most = 0.0;
    for (const glm::dvec2 way : {glm::dvec2(step, 0.0), glm::dvec2(-step, 0.0),
                                 glm::dvec2(0.0, step), glm::dvec2(0.0, -step)}) {
        most = std::max(most, glm::distance(pixel_of(texel + way), pixel_of(texel)) / step);
    }
    return most;
}

// A true hit is off only by what rounding col and row to floats takes away: half a unit in the last
// place each, 2⁻¹⁷ texels below 256, times the pixels a texel takes.
TEST(ReprojectionError, OfExactHitsIsTheRoundingOfTheirFloats) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const glm::ivec2 size(80, 60);
        const Setting setting = hills(seed);
        const HitBuffer truth = picked(setting, size);
        const auto errors = geometric_errors(setting.view(), truth, truth);
        ASSERT_TRUE(errors);
        ASSERT_GT(errors->reprojection.distribution.value().count, 1000U);
        EXPECT_LT(errors->reprojection.distribution->max, 1e-3);
        EXPECT_EQ(errors->reprojection.unbounded, 0U);
        EXPECT_EQ(errors->hit.distribution.value().max, 0.0);
        EXPECT_EQ(errors->wrong, 0U);
        for (int row = 0; row < size.y; ++row) {
            for (int col = 0; col < size.x; ++col) {
                const Hit& hit = truth(col, row);
                if (shows_terrain(hit)) {
                    // Both axes at once; a tenth more for the bend of the projection.
                    const double bound = 1.1 * 2.0 * 0x1p-17 * pixels_per_texel(setting, size, hit);
                    ASSERT_LE(errors->reprojection.map(col, row), bound + 1e-9);
                }
            }
        }
    }
}

TEST(ReprojectionError, OfExactHitsIsSmallOnTheEllipsoidToo) {
    Setting setting(test::geographic_heightfield(
        test::made_heights(
            121, 121, [](int col, int row) { return 300.0 * std::sin(0.1 * col + 0.07 * row); }),
        46.5, 7.5, 1.0 / 1200.0));
    setting.camera.eye = {0.0, -6000.0, 4000.0};
    setting.camera.target = {0.0, 0.0, 0.0};
    const glm::ivec2 size(80, 60);
    const HitBuffer truth = picked(setting, size);
    const auto errors = geometric_errors(setting.view(), truth, truth);
    ASSERT_TRUE(errors);
    EXPECT_GT(errors->reprojection.distribution.value().count, 1000U);
    // pick() follows the bent ray to a thousandth of a sample, here under two pixels wide.
    EXPECT_LT(errors->reprojection.distribution->max, 5e-3);
}

TEST(ReprojectionError, StaysWhenTheWholeWorldMoves) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const glm::ivec2 size(40, 30);
    for (unsigned seed = 1; seed <= 20; ++seed) {
        Setting setting = hills(seed);
        const HitBuffer truth = picked(setting, size);
        const HitBuffer shown = moved(truth, {1.5F, -2.25F});
        const auto before = geometric_errors(setting.view(), shown, truth);
        const glm::dmat4 motion = glm::rotate(
            glm::translate(glm::dmat4(1.0),
                           1e5 * glm::dvec3(any(random), any(random), any(random))),
            3.0 * any(random), glm::normalize(glm::dvec3(any(random), any(random), 1.1)));
        setting.world_from_local = motion;
        setting.camera.eye = glm::dvec3(motion * glm::dvec4(setting.camera.eye, 1.0));
        setting.camera.target = glm::dvec3(motion * glm::dvec4(setting.camera.target, 1.0));
        setting.camera.up = glm::dmat3(motion) * setting.camera.up;
        const auto after = geometric_errors(setting.view(), shown, truth);
        ASSERT_TRUE(before && after);
        for (std::size_t i = 0; i < before->reprojection.map.size(); ++i) {
            const float error = before->reprojection.map.samples()[i];
            const float again = after->reprojection.map.samples()[i];
            ASSERT_EQ(std::isnan(error), std::isnan(again));
            ASSERT_TRUE(std::isnan(error) || std::abs(error - again) <= 1e-5F * (1.0F + error));
        }
    }
}

// A flat texture shows each place at height 0: it is off by what the height moves it.
TEST(ReprojectionError, OfAFlatPictureIsTheParallax) {
    Setting setting(test::plane_heightfield(Grid<float>(65, 65, 10.0F)));
    setting.camera.projection = scene::ProjectionKind::orthographic;
    setting.camera.eye = {0.0, -100.0, 100.0}; // 45° down
    setting.camera.target = glm::dvec3(0.0);
    setting.camera.view_height = 32.0;
    const glm::ivec2 size(32, 32); // one pixel a metre
    Setting flat(test::plane_heightfield(Grid<float>(65, 65, 0.0F)));
    flat.camera = setting.camera;
    const auto errors = geometric_errors(setting.view(), picked(flat, size), picked(setting, size));
    ASSERT_TRUE(errors);
    EXPECT_NEAR(errors->reprojection.distribution.value().median, 10.0 * std::sqrt(0.5), 1e-4);
    EXPECT_NEAR(errors->reprojection.distribution->max, 10.0 * std::sqrt(0.5), 1e-4);
    EXPECT_NEAR(errors->hit.distribution.value().median, 10.0, 1e-4);
    EXPECT_EQ(errors->wrong_percent, 100.0);
}

TEST(ReprojectionError, NeedsNoTrueHit) {
    const glm::ivec2 size(48, 32);
    const Setting setting = seen_from_above(1.0, size.y);
    const HitBuffer shown = moved(picked(setting, size), {5.0F, 0.0F});
    const auto errors = geometric_errors(setting.view(), shown, HitBuffer(size.x, size.y, sky_hit));
    ASSERT_TRUE(errors);
    EXPECT_NEAR(errors->reprojection.distribution.value().rms, 5.0, 1e-4);
    EXPECT_FALSE(errors->hit.distribution);
    EXPECT_EQ(errors->wrong_percent, 100.0);
    EXPECT_EQ(errors->holes, 0U);
}

TEST(ReprojectionError, BehindTheEyeOrNotFiniteHasNoBoundAndIsCounted) {
    const glm::ivec2 size(80, 60);
    Setting setting = hills(1);
    setting.camera.eye = {0.0, 0.0, 200.0};
    setting.camera.target = {0.0, 500.0, 0.0};
    HitBuffer shown = picked(setting, size);
    const HitBuffer truth = shown;
    shown(40, 50) = hit_at(100.0, 179.0); // south of the eye
    shown(41, 50) = hit_at(not_a_number, 10.0);
    shown(42, 50) = hit_at(10.0, unbounded_error);
    const auto errors = geometric_errors(setting.view(), shown, truth);
    ASSERT_TRUE(errors);
    for (const int col : {40, 41, 42}) {
        EXPECT_EQ(errors->reprojection.map(col, 50), unbounded_error);
        EXPECT_EQ(errors->verdicts(col, 50), Verdict::wrong);
    }
    EXPECT_EQ(errors->reprojection.unbounded, 3U);
    EXPECT_EQ(errors->hit.unbounded, 2U);
    EXPECT_EQ(errors->wrong, 3U);
    EXPECT_LT(errors->reprojection.distribution.value().max, 1e-3);
    const auto whole = geometric_errors(setting.view(), truth, truth);
    ASSERT_TRUE(whole);
    EXPECT_EQ(errors->reprojection.distribution->count + 3,
              whole->reprojection.distribution->count);
}

TEST(ReprojectionError, BehindAnOrthographicEyeIsAsGoodAsBefore) {
    const glm::ivec2 size(16, 16);
    Setting setting = seen_from_above(1.0, size.y);
    setting.camera.eye.z = -100.0;
    setting.camera.target.z = -200.0;
    EXPECT_NEAR(reprojection_error(setting.view(), size, {8, 8}, hit_at(128.5, 128.5)), 0.0, 1e-9);
}

TEST(HitError, IsTheDistanceInTexels) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(20.0, 200.0);
    const glm::ivec2 size(32, 32);
    const Setting setting = seen_from_above(1.0, size.y);
    HitBuffer truth(size.x, size.y);
    HitBuffer shown(size.x, size.y);
    for (std::size_t i = 0; i < truth.size(); ++i) {
        truth.samples()[i] = hit_at(std::round(place(random)), std::round(place(random)));
        shown.samples()[i] = truth.samples()[i];
        shown.samples()[i].col += 3.0F;
        shown.samples()[i].row -= 4.0F;
    }
    const auto errors = geometric_errors(setting.view(), shown, truth);
    ASSERT_TRUE(errors);
    EXPECT_EQ(errors->hit.map, Grid<float>(32, 32, 5.0F));
    EXPECT_EQ(errors->hit.distribution.value().rms, 5.0);
    EXPECT_EQ(errors->wrong, truth.size());
}

TEST(WrongSurface, BeginsBeyondOneTexel) {
    const Setting setting = seen_from_above(1.0, 2);
    HitBuffer truth(3, 1, hit_at(100.0, 100.0));
    HitBuffer shown(3, 1);
    shown(0, 0) = hit_at(101.0, 100.0);
    shown(1, 0) = hit_at(std::nextafter(101.0F, 102.0F), 100.0);
    shown(2, 0) = hit_at(100.75, 100.75);
    const auto errors = geometric_errors(setting.view(), shown, truth);
    ASSERT_TRUE(errors);
    EXPECT_EQ(errors->verdicts(0, 0), Verdict::right);
    EXPECT_EQ(errors->verdicts(1, 0), Verdict::wrong);
    EXPECT_EQ(errors->verdicts(2, 0), Verdict::wrong);
}

// Every pair of what the two may show, told apart by a plain table.
TEST(WrongSurface, CountsEveryKindOfPixelByChance) {
    std::mt19937 random(4);
    std::uniform_int_distribution<int> kinds(0, 3);
    const Setting setting = seen_from_above(1.0, 20);
    const std::array<Hit, 4> hits{sky_hit, mesh_hit, hit_at(128.0, 128.0), hit_at(130.0, 128.0)};
    for (int round = 0; round < 300; ++round) {
        HitBuffer truth(20, 15);
        HitBuffer shown(20, 15);
        std::size_t holes = 0;
        std::size_t wrong = 0;
        std::size_t terrain = 0;
        for (std::size_t i = 0; i < truth.size(); ++i) {
            const int a = kinds(random);
            const int b = kinds(random);
            shown.samples()[i] = hits[static_cast<std::size_t>(a)];
            truth.samples()[i] = hits[static_cast<std::size_t>(b)];
            holes += a < 2 && b >= 2 ? 1 : 0;
            wrong += (a < 2) != (b < 2) || (a >= 2 && a != b) ? 1 : 0;
            terrain += a >= 2 || b >= 2 ? 1 : 0;
        }
        const auto errors = geometric_errors(setting.view(), shown, truth);
        ASSERT_TRUE(errors);
        ASSERT_EQ(errors->holes, holes);
        ASSERT_EQ(errors->wrong, wrong);
        ASSERT_DOUBLE_EQ(errors->wrong_percent, 100.0 * static_cast<double>(wrong) / 300.0);
        ASSERT_DOUBLE_EQ(errors->wrong_of_terrain_percent,
                         100.0 * static_cast<double>(wrong) / static_cast<double>(terrain));
    }
}

TEST(GeometricErrors, MapsAreUndefinedWhereTheErrorIs) {
    const Setting setting = seen_from_above(1.0, 2);
    HitBuffer truth(2, 2, hit_at(128.0, 128.0));
    HitBuffer shown(2, 2, hit_at(128.0, 128.0));
    shown(0, 0) = sky_hit;
    truth(1, 0) = sky_hit;
    shown(0, 1) = truth(0, 1) = sky_hit;
    const auto errors = geometric_errors(setting.view(), shown, truth);
    ASSERT_TRUE(errors);
    EXPECT_TRUE(std::isnan(errors->reprojection.map(0, 0)));
    EXPECT_TRUE(std::isnan(errors->hit.map(0, 0)));
    EXPECT_EQ(errors->verdicts(0, 0), Verdict::hole);
    EXPECT_FALSE(std::isnan(errors->reprojection.map(1, 0)));
    EXPECT_TRUE(std::isnan(errors->hit.map(1, 0)));
    EXPECT_EQ(errors->verdicts(1, 0), Verdict::wrong);
    EXPECT_TRUE(std::isnan(errors->reprojection.map(0, 1)));
    EXPECT_EQ(errors->verdicts(0, 1), Verdict::no_terrain);
    EXPECT_EQ(errors->hit.map(1, 1), 0.0F);
    EXPECT_EQ(errors->reprojection.distribution.value().count, 2U);
    EXPECT_EQ(errors->hit.distribution.value().count, 1U);
    EXPECT_EQ(errors->wrong_percent, 50.0);
}

TEST(GeometricErrors, DistributionTellsOnePixelInAHundred) {
    const Setting setting = seen_from_above(1.0, 2);
    const HitBuffer truth(100, 10, hit_at(128.0, 128.0));
    HitBuffer shown = truth;
    for (int row = 0; row < 10; ++row) {
        shown(row, row) = hit_at(168.0, 128.0);
    }
    const auto errors = geometric_errors(setting.view(), shown, truth);
    ASSERT_TRUE(errors);
    const Distribution& told = errors->hit.distribution.value();
    EXPECT_EQ(told.median, 0.0);
    EXPECT_EQ(told.p95, 0.0);
    EXPECT_EQ(told.max, 40.0);
    EXPECT_DOUBLE_EQ(told.rms, 4.0);
    EXPECT_EQ(errors->wrong_percent, 1.0);
}

TEST(GeometricErrors, OfAHitWithoutOneAreNeitherCountedNorUnbounded) {
    const HitBuffer hits(4, 1, hit_at(2.0, 2.0));
    const PixelMeasure measure{[](glm::ivec2 pixel, const Hit&) -> std::optional<double> {
                                   return pixel.x == 0 ? std::nullopt : std::optional(2.0);
                               },
                               hit_error};
    const auto errors = geometric_errors(measure, hits, hits);
    ASSERT_TRUE(errors);
    EXPECT_TRUE(std::isnan(errors->reprojection.map(0, 0)));
    EXPECT_EQ(errors->reprojection.unbounded, 0U);
    ASSERT_TRUE(errors->reprojection.distribution);
    EXPECT_EQ(errors->reprojection.distribution->count, 3U);
    EXPECT_EQ(errors->wrong, 0U);
}

// A technique that shows nothing at all is wrong, not perfect.
TEST(GeometricErrors, OfAnEmptyFrameBeforeTerrainAreAllHoles) {
    const glm::ivec2 size(16, 16);
    const Setting setting = seen_from_above(1.0, size.y);
    const auto errors = geometric_errors(setting.view(), HitBuffer(16, 16), picked(setting, size));
    ASSERT_TRUE(errors);
    EXPECT_FALSE(errors->reprojection.distribution);
    EXPECT_FALSE(errors->hit.distribution);
    EXPECT_EQ(errors->holes, 256U);
    EXPECT_EQ(errors->wrong_percent, 100.0);
}

TEST(GeometricErrors, WithoutAnyTerrainAreAnErrorNotZero) {
    const Setting setting = seen_from_above(1.0, 4);
    const auto errors =
        geometric_errors(setting.view(), HitBuffer(4, 3, mesh_hit), HitBuffer(4, 3, sky_hit));
    ASSERT_FALSE(errors);
    EXPECT_EQ(errors.error().message,
              "a frame of 4x3 pixels without terrain, true or shown: terrain at one pixel at least "
              "was expected");
    EXPECT_FALSE(geometric_errors(setting.view(), HitBuffer(), HitBuffer()));
}

TEST(GeometricErrors, OfFramesOfDifferentSizeAreAnError) {
    const Setting setting = seen_from_above(1.0, 4);
    const auto errors = geometric_errors(setting.view(), HitBuffer(4, 3, hit_at(1.0, 1.0)),
                                         HitBuffer(3, 4, hit_at(1.0, 1.0)));
    ASSERT_FALSE(errors);
    EXPECT_EQ(errors.error().message,
              "a frame of 4x3 pixels: 3x4 as in the true frame was expected");
}

TEST(GeometricErrors, DoNotDependOnThreads) {
    const glm::ivec2 size(60, 45);
    const Setting setting = hills(2);
    const HitBuffer truth = picked(setting, size);
    const HitBuffer shown = moved(truth, {0.5F, 0.75F});
    const auto one = geometric_errors(setting.view(), shown, truth, 1);
    const auto many = geometric_errors(setting.view(), shown, truth, 6);
    ASSERT_TRUE(one && many);
    EXPECT_EQ(one->verdicts, many->verdicts);
    EXPECT_EQ(one->reprojection.distribution->rms, many->reprojection.distribution->rms);
    EXPECT_EQ(one->reprojection.distribution->median, many->reprojection.distribution->median);
}

} // namespace
} // namespace reljef::truth
