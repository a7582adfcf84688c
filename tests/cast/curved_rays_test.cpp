#include "engine/cast/curved_rays.h"

#include <array>
#include <cstring>
#include <span>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/cast/frame/driver.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/earth_stage.h"
#include "tests/render/made_stream.h"
#include "tests/scene/streaming/streamed_samples.h"
#include "tests/support/release_only.h"

namespace reljef::cast {
namespace {

constexpr glm::ivec2 curved_size{320, 240};
constexpr glm::ivec2 ground_size{160, 120};

struct EarthStage : test::EarthStage {
    explicit EarthStage(const test::EarthPlace& place) : test::EarthStage(place) {
        scene::Polygons bounded;
        bounded.error = 1.0;
        set(scene::Technique{bounded});
    }

    // From now on its samples are tiles of a stream.
    void stream() {
        test::stream_samples(*terrain->get<scene::TerrainNode>(), test::SeenLevels::finest);
        scene::Polygons bounded;
        bounded.error = 1e-6; // all samples
        set(scene::Technique{bounded});
    }

    void look(glm::dvec2 sample, double above, glm::dvec2 toward) {
        is_close = above < 1.0;
        test::EarthStage::look(sample, above, toward);
    }

    [[nodiscard]] view::DrawnHits drawn(glm::ivec2 size, const RaySkips& skips = {}) const {
        render::bring_tiles(scene, size);
        Driver driver = test::must(Driver::create({.size = size, .skips = skips}));
        return test::must(driver.draw_hits(view::select(scene, size)));
    }

    bool is_close = false; // to the ground

    void expect_true(const std::string& name, double most, glm::ivec2 size = curved_size) const {
        const view::DrawnHits shown = drawn(size);
        const truth::GeometricErrors found = errors(shown.hits);
        ASSERT_TRUE(found.reprojection.distribution && shown.stats.kept_error) << name;
        EXPECT_GT(found.reprojection.distribution->count, shown.hits.size() / 200) << name;
        // Where the truth of a pixel is not stable, the next ridge may be hit.
        EXPECT_LE(found.wrong + found.holes + found.reprojection.unbounded,
                  shown.hits.size() / 2000)
            << name;
        EXPECT_LT(found.reprojection.distribution->p99, most) << name;
        EXPECT_LT(found.reprojection.distribution->p99, *shown.stats.kept_error) << name;
        // Close to the ground, what is as long as a cell may round to much more than it does.
        EXPECT_LT(*shown.stats.kept_error, (is_close ? 50.0 : 10.0) * most) << name;
    }
};

std::span<const double> near_latitudes() {
    static constexpr std::array latitudes{45.0, 0.1, -60.0, 85.0};
    return std::span(latitudes).first(std::size_t{test::rounds(4, 1)});
}

TEST(CurvedRays, HitWhatTheTruthHits) {
    for (const double latitude : near_latitudes()) {
        EarthStage stage({.latitude = latitude, .turn = latitude > 0.0 ? 20.0 : 0.0});
        for (const double above : {0.3, 30.0, 3e3, 2e4}) {
            stage.look({120.3, 201.7}, above, {140.0, 40.0});
            stage.expect_true(fmt::format("latitude {}, {} m above", latitude, above), 0.01,
                              ground_size);
        }
    }
}

TEST(CurvedRays, HitWhatTheTruthHitsInStreamedTiles) {
    for (const double latitude : near_latitudes()) {
        EarthStage stage({.latitude = latitude, .turn = latitude > 0.0 ? 20.0 : 0.0});
        stage.stream();
        for (const double above : {0.3, 30.0, 3e3, 2e4}) {
            stage.look({120.3, 201.7}, above, {140.0, 40.0});
            stage.expect_true(fmt::format("streamed, latitude {}, {} m above", latitude, above),
                              0.01, ground_size);
        }
    }
}

// Beams are as wide as rays that are bent in the pixel.
TEST(CurvedRays, HitsHaveTheSameBitsWithoutBeams) {
    for (const bool is_streamed : {false, true}) {
        for (const double above : {0.3, 3e3, 1e5, 1e6}) {
            EarthStage stage({.latitude = 47.0, .step = above < 5e4 ? 0.001 : 0.004, .turn = 20.0});
            stage.look({120.3, 201.7}, above, {140.0, 100.0});
            if (is_streamed) {
                stage.stream();
            }
            const HitBuffer all = stage.drawn(curved_size).hits;
            const HitBuffer without = stage.drawn(curved_size, {.beams = false}).hits;
            ASSERT_EQ(all.size(), without.size());
            EXPECT_EQ(std::memcmp(all.samples().data(), without.samples().data(),
                                  all.size() * sizeof(Hit)),
                      0)
                << above;
        }
    }
}

// From space, blocks of pixels show the bend of the Earth.
TEST(CurvedRays, HitWhatTheTruthHitsFromFarAway) {
    const std::array latitudes{-60.0, 47.0, 2.0};
    for (const double latitude : std::span(latitudes).first(std::size_t{test::rounds(3, 1)})) {
        for (const double above : {1e5, 1e6, 3e6}) {
            const double step = above < 5e5 ? 0.004 : 0.02; // degrees
            for (const bool is_streamed : {false, true}) {
                EarthStage stage({.latitude = latitude, .step = step, .turn = 20.0});
                stage.look({120.3, 201.7}, above, {140.0, 100.0});
                if (is_streamed) {
                    stage.stream();
                }
                stage.expect_true(fmt::format("latitude {}, {} m above, {}", latitude, above,
                                              is_streamed ? "streamed" : "whole"),
                                  above < 2e6 ? 0.01 : 0.02);
            }
        }
    }
}

// Their pixels are wider than samples.
TEST(CurvedRays, HitWhatTheTruthHitsInThumbnails) {
    constexpr glm::ivec2 thumbnail{64, 48};
    for (const double above : {3e3, 2e4, 1e5, 1e6}) {
        EarthStage stage({.latitude = 47.0, .step = above < 5e5 ? 0.001 : 0.02, .turn = 20.0});
        stage.look({120.3, 201.7}, above, {140.0, 100.0});
        const view::DrawnHits shown = stage.drawn(thumbnail);
        const truth::GeometricErrors found = stage.errors(shown.hits);
        ASSERT_TRUE(found.reprojection.distribution && shown.stats.kept_error);
        // At the ends of the terrain.
        EXPECT_LE(found.holes + found.reprojection.unbounded, 6U) << above;
        EXPECT_LT(found.reprojection.distribution->p99, 0.02) << above;
        EXPECT_LT(found.reprojection.distribution->p99, *shown.stats.kept_error) << above;
    }
}

// They do not end where they are below all ground: it may lie in front of them.
TEST(CurvedRays, FromBelowTheGroundHitWhatTheTruthHits) {
    for (const bool is_streamed : {false, true}) {
        EarthStage stage({.latitude = 45.0, .turn = 20.0});
        if (is_streamed) {
            stage.stream();
        }
        stage.look({120.3, 201.7}, -2000.0, {140.0, 40.0});
        const view::DrawnHits shown = stage.drawn(ground_size);
        const truth::GeometricErrors found = stage.errors(shown.hits);
        EXPECT_LE(found.wrong + found.holes + found.reprojection.unbounded,
                  shown.hits.size() / 1000)
            << is_streamed;
    }
}

// Also where a corner of the terrain, which is not seen, lies at a pole.
TEST(CurvedRays, OverATerrainThatReachesAPoleAreDrawnAwayFromIt) {
    EarthStage stage({.latitude = 89.99, .step = 0.04});
    stage.look({120.3, 250.0}, 5e3, {200.0, 256.0});
    stage.expect_true("away from the pole", 0.02, ground_size);
}

// The Earth is smaller than a pixel.
TEST(CurvedRays, FromVeryFarAwayAreDrawn) {
    EarthStage stage({});
    stage.look({120.3, 201.7}, 3e10, {140.0, 40.0});
    EXPECT_EQ(obstacle_of(view::select(stage.scene, curved_size).list), "");
    EXPECT_LT(stage.drawn(curved_size).stats.kept_error.value_or(1.0), 0.1);
}

} // namespace
} // namespace reljef::cast
