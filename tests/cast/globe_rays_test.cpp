#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/cast/frame/driver.h"
#include "engine/cast/globe_part.h"
#include "engine/cast/simd_target.h"
#include "engine/core/bilinear.h"
#include "engine/truth/draw.h"
#include "engine/truth/geometric_error.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_scene.h"
#include "tests/render/made_stream.h"
#include "tests/scene/streaming/streamed_samples.h"
#include "tests/support/release_only.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::cast {
namespace {

constexpr glm::ivec2 globe_size{160, 120};

// An eye above a globe.
struct GlobeView {
    double latitude = 0.0;  // degrees
    double longitude = 0.0; // degrees
    double above = 1e5;     // metres above the ellipsoid
    double azimuth = 0.0;   // degrees
    double down = 30.0;     // degrees below the horizontal
};

// All longitudes from 60 degrees north to 60 degrees south.
terrain::Heightfield belt() {
    constexpr double step = 0.6; // degrees
    constexpr int cols = 600;
    constexpr int rows = 201;
    terrain::Heightfield ground = test::geographic_heightfield(
        test::random_heights(cols, rows, -9000.0F, 9000.0F, 12), 60.0, -180.0, step);
    const geo::GlobalWrap wrap{.around = true, .east = true};
    ground.georeference->geodetic = ground.georeference->geodetic.closed(wrap, cols, rows);
    const Grid<float> source = std::move(ground.heights);
    ground.heights = test::made_heights(cols + 1, rows,
                                        [&](int col, int row) { return source(col % cols, row); });
    return ground;
}

class GlobeStage {
public:
    glm::ivec2 size = globe_size;

    GlobeStage(double north, double south, bool is_streamed)
        : GlobeStage(test::closed_globe(300, north, south, 11), is_streamed) {}
    GlobeStage(terrain::Heightfield heightfield, bool is_streamed, double exaggeration = 1.0) {
        terrain_ = &test::add_terrain(
            scene_, std::move(heightfield), {},
            {.placement = terrain::PlacementKind::ellipsoid, .exaggeration = exaggeration});
        scene::Polygons bounded;
        bounded.error = is_streamed ? 1e-6 : 1.0; // all samples
        auto& node = *terrain_->get<scene::TerrainNode>();
        node.material.technique = scene::Technique{bounded};
        if (is_streamed) {
            test::stream_samples(node, test::SeenLevels::finest);
        }
        camera_ = &scene_.add_camera({});
    }

    void look(const GlobeView& view) {
        const terrain::Placement& placement = test::surface_of(*terrain_).placement();
        scene::Camera camera;
        camera.eye =
            placement.world_from_geodetic({view.latitude, view.longitude, view.above}).value();
        const glm::dvec3 up = placement.up(camera.eye);
        const glm::dvec3 north = placement.north(camera.eye);
        const glm::dvec3 east = glm::cross(north, up);
        const double azimuth = glm::radians(view.azimuth);
        const double down = glm::radians(view.down);
        camera.target =
            camera.eye +
            1e5 * (std::cos(down) * (std::cos(azimuth) * north + std::sin(azimuth) * east) -
                   std::sin(down) * up);
        camera.up = up;
        camera.near = 10.0;
        *camera_->get<scene::Camera>() = camera;
        render::bring_tiles(scene_, size);
    }
    void look_at_map(double height = 1e6) { // metres
        scene::Camera& camera = *camera_->get<scene::Camera>();
        camera.projection = scene::ProjectionKind::orthographic;
        camera.view_height = height;
        render::bring_tiles(scene_, size);
    }
    [[nodiscard]] std::string obstacle() const {
        return obstacle_of(view::select(scene_, size).list);
    }
    [[nodiscard]] std::string obstacle_beside_triangles() const {
        return cast::obstacle_beside_triangles(view::select(scene_, size).list);
    }
    void draw_exactly() {
        terrain_->get<scene::TerrainNode>()->material.technique = scene::Technique{scene::Exact{}};
    }
    [[nodiscard]] view::DrawnHits drawn(const RaySkips& skips = {}, unsigned threads = 0,
                                        std::optional<SimdTarget> target = {}) const {
        Driver driver = test::must(
            Driver::create({.size = size, .threads = threads, .target = target, .skips = skips}));
        return test::must(driver.draw_hits(view::select(scene_, size)));
    }
    [[nodiscard]] truth::GeometricErrors errors(const HitBuffer& shown) const {
        const scene::TerrainSurface& surface = test::surface_of(*terrain_);
        const truth::SurfaceView view{surface.heightfield().heights.view(), surface.placement(),
                                      terrain_->world_from_local(), scene_.camera()};
        return test::must(
            truth::geometric_errors(view, shown, test::must(truth::draw_hits(scene_, size))));
    }

private:
    scene::Scene scene_;
    scene::Node* terrain_ = nullptr;
    scene::Node* camera_ = nullptr;
};

void expect_true(const GlobeStage& stage, const std::string& name) {
    ASSERT_EQ(stage.obstacle(), "") << name;
    const view::DrawnHits shown = stage.drawn();
    const truth::GeometricErrors found = stage.errors(shown.hits);
    ASSERT_TRUE(found.reprojection.distribution && shown.stats.kept_error) << name;
    EXPECT_GT(found.reprojection.distribution->count, shown.hits.size() / 20) << name;
    EXPECT_LE(found.wrong + found.holes + found.reprojection.unbounded, shown.hits.size() / 2000)
        << name;
    EXPECT_LT(found.reprojection.distribution->p99, 0.01) << name;
    EXPECT_LT(found.reprojection.distribution->p99, *shown.stats.kept_error) << name;
}

// Across its seam, at middle latitudes and the equator, from the ground to space.
TEST(GlobeRays, HitWhatTheTruthHits) {
    for (const bool is_streamed : {false, true}) {
        GlobeStage stage(0.5, 0.5, is_streamed);
        for (const GlobeView& view :
             {GlobeView{0.0, 179.9, 2e4, 90.0, 5.0}, GlobeView{47.0, -179.8, 1e5, 270.0, 20.0},
              GlobeView{-30.0, 179.5, 1e6, 20.0, 60.0}, GlobeView{10.0, 7.0, 2e6, 200.0, 50.0}}) {
            stage.look(view);
            expect_true(stage,
                        fmt::format("{}, {} degrees, {} m above, {}", view.latitude, view.longitude,
                                    view.above, is_streamed ? "streamed" : "whole"));
        }
    }
}

// Beams and blocks are only skipped where bent rays cannot hit, also where they are parts of a
// beam.
TEST(GlobeRays, HitTheSameWithoutSkips) {
    GlobeStage stage(0.5, 0.5, true);
    for (const GlobeView& view :
         {GlobeView{-30.0, 179.5, 1e6, 20.0, 60.0}, GlobeView{89.0, 30.0, 1e5, 0.0, 50.0}}) {
        stage.look(view);
        const view::DrawnHits shown = stage.drawn();
        const RaySkips none{false, false, false, false, false};
        const HitBuffer all = stage.drawn(none).hits;
        const HitBuffer of_one_thread = stage.drawn({}, 1).hits;
        for (std::size_t i = 0; i < shown.hits.size(); ++i) {
            const Hit& here = shown.hits.samples()[i];
            for (const Hit& there : {all.samples()[i], of_one_thread.samples()[i]}) {
                EXPECT_TRUE((here.is_sky() && there.is_sky()) ||
                            (here.col == there.col && here.row == there.row))
                    << i;
            }
        }
    }
}

// Parts of a beam are lanes, of which sets have 1 to 16.
TEST(GlobeRays, HitWhatTheTruthHitsAtAPoleWithEachInstructionSet) {
    GlobeStage stage(0.5, 0.5, false);
    stage.look({89.0, 30.0, 1e5, 0.0, 50.0});
    for (const SimdTarget& target : simd_targets()) {
        const view::DrawnHits shown = stage.drawn({}, 0, target);
        const truth::GeometricErrors found = stage.errors(shown.hits);
        EXPECT_LE(found.wrong + found.reprojection.unbounded, shown.hits.size() / 2000)
            << target.name;
    }
}

// Ground without poles is seen on both sides of one, where columns are half a turn apart.
TEST(GlobeRays, HitWhatTheTruthHitsBehindAPoleWithoutGround) {
    for (const bool is_streamed : {false, true}) {
        GlobeStage stage(belt(), is_streamed);
        stage.size *= test::cases(2, 4);
        for (const GlobeView& view :
             {GlobeView{58.0, 20.0, 2e7, 3.0, 80.0}, GlobeView{50.0, 179.9, 6e6, 350.0, 55.0}}) {
            stage.look(view);
            expect_true(stage, fmt::format("{} degrees, {}", view.latitude,
                                           is_streamed ? "streamed" : "whole"));
        }
    }
}

TEST(GlobeRays, HitWhatTheTruthHitsOnExaggeratedGround) {
    GlobeStage stage(test::closed_globe(300, 0.5, 0.5, 11), false, 3.0);
    stage.look({10.0, 179.9, 2e5, 100.0, 10.0});
    expect_true(stage, "three times as high");
}

// Also straight down at the pole, over it to the other side, and exactly along a meridian. With
// rows that close the globe at half their distance, or lie on the poles.
TEST(GlobeRays, HitWhatTheTruthHitsAtThePoles) {
    for (const bool is_streamed : {false, true}) {
        for (const double rows : {0.5, 1.0}) {
            if (test::cases(0, 1) == 0 && is_streamed != (rows == 0.5)) {
                continue;
            }
            GlobeStage stage(rows, 0.5, is_streamed);
            for (const GlobeView& view :
                 {GlobeView{85.0, 20.0, 4e5, 0.0, 80.0}, GlobeView{-90.0, 20.0, 4e5, 180.0, 80.0},
                  GlobeView{-89.0, 20.0, 1e5, 180.0, 20.0},
                  GlobeView{45.0, 20.0, 1e7, 0.0, 80.0}}) {
                stage.look(view);
                expect_true(stage,
                            fmt::format("{} degrees, {} m above, rows {}, {}", view.latitude,
                                        view.above, rows, is_streamed ? "streamed" : "whole"));
            }
        }
    }
}

// Nearly a globe. Neither the truth nor rays draw ground in the gap, where longitudes begin anew.
TEST(GlobeRays, HitWhatTheTruthHitsBesideAGapOfADegree) {
    GlobeStage stage(test::geographic_heightfield(
                         test::random_heights(599, 200, -900.0F, 900.0F, 15), 89.9, -179.7, 0.6),
                     false);
    stage.look({75.0, 179.1, 6e4, 15.0, 40.0});
    expect_true(stage, "beside a gap");
}

// Nor beyond a pole at the end of the ground.
TEST(GlobeRays, HitWhatTheTruthHitsBesideAPoleAtTheEndOfTheGround) {
    GlobeStage stage(test::geographic_heightfield(test::random_heights(150, 100, 0.0F, 900.0F, 16),
                                                  90.0, 10.0, 0.1),
                     false);
    stage.look({89.9, 97.5, 1.2e4, 345.0, 70.0});
    expect_true(stage, "beside a pole");
}

TEST(GlobeRays, StateSmallErrorsAtThePoles) {
    GlobeStage stage(0.5, 0.5, false);
    for (const double latitude : {90.0, 89.99, 89.0, -80.0}) {
        stage.look({latitude, 3.0, 3e5, latitude > 0.0 ? 0.0 : 180.0, 70.0});
        EXPECT_LT(stage.drawn().stats.kept_error.value_or(1.0), 0.1) << latitude;
    }
}

TEST(GlobeRays, HitWhatTheTruthHitsOnMaps) {
    for (const bool is_streamed : {false, true}) {
        GlobeStage stage(0.5, 0.5, is_streamed);
        for (const double height : {3e3, 1e6, 2e7}) {
            stage.look({60.0, 20.0, 2e6, 0.0, 80.0});
            stage.look_at_map(height);
            expect_true(stage,
                        fmt::format("{} m high, {}", height, is_streamed ? "streamed" : "whole"));
        }
    }
}

TEST(GlobeRays, AreLeftToTrianglesAtThePolesUnlessTheyAreExact) {
    GlobeStage stage(0.5, 0.5, false);
    stage.look({85.0, 20.0, 4e5, 0.0, 80.0});
    EXPECT_EQ(stage.obstacle_beside_triangles(), "a globe with a pole in view");
    stage.draw_exactly();
    EXPECT_EQ(stage.obstacle_beside_triangles(), "");
}

TEST(GlobeRays, AreNotLeftToTrianglesWhereNoPoleIsShown) {
    GlobeStage stage(0.5, 0.5, false);
    stage.look({20.0, 20.0, 4e5, 0.0, 80.0});
    EXPECT_EQ(stage.obstacle_beside_triangles(), "");
    stage.look_at_map();
    EXPECT_EQ(stage.obstacle_beside_triangles(), "");
    stage.look({80.0, 20.0, 1e6, 180.0, 40.0}); // away from it
    EXPECT_EQ(stage.obstacle_beside_triangles(), "");
    GlobeStage without(belt(), false);
    without.look({58.0, 20.0, 4e6, 0.0, 80.0});
    EXPECT_EQ(without.obstacle_beside_triangles(), "");
}

// A place is seen if no lower ground hides it: if the way to the eye does not meet an ellipsoid.
bool may_see(glm::dvec3 eye, glm::dvec3 place, glm::dvec3 radii) {
    const glm::dvec3 from = eye / radii;
    const glm::dvec3 way = place / radii - from;
    const double nearest = glm::clamp(-glm::dot(from, way) / glm::dot(way, way), 0.0, 1.0);
    return glm::length(from + nearest * way) >= 1.0;
}

TEST(GlobePart, HasAllThatAnEyeMaySee) {
    const terrain::Heightfield globe = test::closed_globe(180, 0.5, 0.5, 12);
    const terrain::Placement placement = test::placed(globe);
    const double around = *placement.columns_all_around();
    Box all;
    const geo::WrappedRows rows = globe.georeference->geodetic.rows();
    all.add(glm::dvec3(0.0, rows.even_row(0.0), -500.0));
    all.add(
        glm::dvec3(globe.heights.cols() - 1.0, rows.even_row(globe.heights.rows() - 1.0), 8000.0));
    const glm::dvec2 earth = geo::radii_of_earth();
    const glm::dvec3 radii = glm::dvec3(earth.x, earth.x, earth.y) - 500.0;
    test::Chance chance(13);
    int seen = 0;
    for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 eye =
            placement
                .world_from_geodetic({chance.between(-90.0, 90.0), chance.between(-180.0, 180.0),
                                      std::pow(10.0, chance.between(1.0, 6.7))})
                .value();
        const auto part = globe_part_from(eye, placement, rows, all);
        ASSERT_TRUE(part);
        for (int j = 0; j < 30; ++j) {
            const glm::dvec3 near = glm::mix(
                eye,
                placement.world_from_sample({chance.between(0.0, around),
                                             chance.between(0.0, globe.heights.rows() - 1.0), 0.0}),
                std::pow(10.0, chance.between(-3.0, 0.0)));
            glm::dvec3 sample = placement.sample_from_world(near).value();
            sample.z = chance.between(-500.0, 8000.0);
            const glm::dvec3 place = placement.world_from_sample(sample);
            const geo::LocalFrame& frame = *placement.frame();
            if (!may_see(frame.geocentric_from_local(eye), frame.geocentric_from_local(place),
                         radii)) {
                continue;
            }
            ++seen;
            sample.x += around * std::round((part->samples.center().x - sample.x) / around);
            sample.y = rows.even_row(sample.y);
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(place, part->local.low)) &&
                        glm::all(glm::lessThanEqual(place, part->local.high)));
            EXPECT_TRUE(sample.x >= part->samples.low.x && sample.x <= part->samples.high.x &&
                        sample.y >= part->samples.low.y && sample.y <= part->samples.high.y)
                << sample.x << ' ' << sample.y;
        }
    }
    EXPECT_GT(seen, 5000);
}

// Parallel rays to all places of a picture, up to the horizon.
TEST(GlobePart, HasAllThatAMapMayShow) {
    const terrain::Heightfield globe = test::closed_globe(180, 0.5, 0.5, 12);
    const terrain::Placement placement = test::placed(globe);
    const geo::WrappedRows rows = globe.georeference->geodetic.rows();
    const double around = *placement.columns_all_around();
    Box all;
    all.add(glm::dvec3(0.0, rows.even_row(0.0), -500.0));
    all.add(
        glm::dvec3(globe.heights.cols() - 1.0, rows.even_row(globe.heights.rows() - 1.0), 8000.0));
    test::Chance chance(14);
    int seen = 0;
    for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 target = placement
                                      .world_from_geodetic({chance.between(-90.0, 90.0),
                                                            chance.between(-180.0, 180.0), 0.0})
                                      .value();
        const glm::dvec3 tilt(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0),
                              chance.between(-1.0, 1.0));
        const glm::dvec3 way = -glm::normalize(placement.up(target) + 0.7 * tilt);
        const ParallelRays rays{{target - 1e7 * way, way},
                                std::pow(10.0, chance.between(2.0, 7.0))};
        const GlobePart part = globe_part_along(rays, placement, rows, all);
        for (int j = 0; j < 30; ++j) {
            const glm::dvec3 near = target + rays.radius * glm::dvec3(chance.between(-1.0, 1.0),
                                                                      chance.between(-1.0, 1.0),
                                                                      chance.between(-1.0, 1.0));
            const auto below = placement.sample_from_world(near);
            if (!below) {
                continue;
            }
            glm::dvec3 sample = *below;
            sample.z = chance.between(-500.0, 8000.0);
            const glm::dvec3 place = placement.world_from_sample(sample);
            const glm::dvec3 to_place = place - rays.middle.origin;
            const double beside = glm::length(to_place - glm::dot(to_place, way) * way);
            if (beside > rays.radius || glm::dot(placement.up(place), way) > -1e-3) {
                continue;
            }
            ++seen;
            sample.x += around * std::round((part.samples.center().x - sample.x) / around);
            sample.y = rows.even_row(sample.y);
            EXPECT_TRUE(sample.x >= part.samples.low.x && sample.x <= part.samples.high.x &&
                        sample.y >= part.samples.low.y && sample.y <= part.samples.high.y)
                << sample.x << ' ' << sample.y;
        }
    }
    EXPECT_GT(seen, 5000);
}

} // namespace
} // namespace reljef::cast
