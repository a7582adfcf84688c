#include "engine/view/choice/technique_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/view/choice/ray_error.h"
#include "engine/view/occlusion.h"
#include "engine/view/select.h"
#include "tests/render/made_scene.h"
#include "tests/terrain/chance.h"

namespace reljef::view {
namespace {

constexpr glm::ivec2 chosen_size{320, 240};
constexpr TechniqueCosts triangles_only{.frame_ms = 0.0,
                                        .triangle_ns = 0.0,
                                        .touched_pixel_ns = 0.0,
                                        .covered_pixel_ns = 0.0,
                                        .rays_ms = 1.0,
                                        .ray_pixel_ns = 1.0};
constexpr TechniqueCosts rays_only{.frame_ms = 0.0,
                                   .triangle_ns = 1.0,
                                   .touched_pixel_ns = 0.0,
                                   .covered_pixel_ns = 1.0,
                                   .rays_ms = 0.0,
                                   .ray_pixel_ns = 0.0};
constexpr TechniqueCosts both{.frame_ms = 0.0,
                              .triangle_ns = 1000.0,
                              .touched_pixel_ns = 0.0,
                              .covered_pixel_ns = 0.0,
                              .rays_ms = 0.0,
                              .ray_pixel_ns = 100.0};

// Nine tiles seen from above their south, with costs that decide.
struct ChosenView {
    scene::Scene scene;
    scene::Node* node = nullptr;
    scene::Node* camera = nullptr;

    explicit ChosenView(const char* technique = "auto:error=1",
                        Grid<float> heights = test::hills(380, 361, 60.0)) {
        node = &test::add_terrain(scene, test::plane_heightfield(std::move(heights), {10, 10}));
        camera = &scene.add_camera(test::camera_at({0.0, -1500.0, 300.0}, {0.0, 0.0, 0.0}));
        node->get<scene::TerrainNode>()->material.technique =
            scene::parse_technique(technique).value();
    }
    [[nodiscard]] FrameView select(const ChoiceOptions& options, int samples = 1) const {
        TechniqueChooser chooser(options);
        chooser.set_samples(samples);
        return view::select(scene, chosen_size,
                            {.occlusion = true, .refine = [&](DrawList& list, const auto& drop) {
                                 chooser.choose(list, drop);
                             }});
    }
    [[nodiscard]] DrawList chosen(const TechniqueCosts& costs) const {
        return select({.costs = costs}).list;
    }
};

bool has_rays(const DrawList& list) {
    return !searched_terrains(list).empty();
}

// Metres from the eye.
double nearest_hit(const scene::Camera& camera, const scene::TerrainSurface& surface) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int y = 0; y < chosen_size.y; y += 4) {
        for (int x = 0; x < chosen_size.x; x += 4) {
            const Ray ray = scene::view_ray(camera, chosen_size, glm::dvec2(x, y) + 0.5);
            if (const auto hit = surface.pick(ray)) {
                const glm::dvec3 place = surface.placement().world_from_sample(hit->sample);
                nearest = std::min(nearest, glm::distance(camera.eye, place));
            }
        }
    }
    return nearest;
}

// A level plain around the eye, and hills behind it.
Grid<float> plain_before_hills() {
    Grid<float> heights = test::hills(380, 361, 60.0);
    for (int row = 200; row < heights.rows(); ++row) {
        std::ranges::fill(heights.row(row), 0.0F);
    }
    return heights;
}

TEST(ViewPlanTest, IsTheCheapestOfAllRings) {
    const TechniqueCosts costs{.frame_ms = 1.0,
                               .triangle_ns = 100.0,
                               .touched_pixel_ns = 2.0,
                               .covered_pixel_ns = 10.0,
                               .rays_ms = 2.0,
                               .ray_pixel_ns = 50.0};
    const ViewCosts view{.rings = {{0, 100.0, 40e3}, {1, 10e3, 40e3}, {2, 200e3, 20e3}},
                         .box_pixels = 110e3};
    EXPECT_DOUBLE_EQ(plan_up_to(-1, view, costs).ms, 1.0 + 2.0 + 110e3 * 50e-6);
    const double touched = std::sqrt(100.0 * 40e3) + std::sqrt(10e3 * 40e3);
    EXPECT_DOUBLE_EQ(plan_up_to(2, view, costs).ms, 1.0 + 210.1e3 * 1e-4 +
                                                        (touched + std::sqrt(200e3 * 20e3)) * 2e-6 +
                                                        100e3 * 1e-5);
    const ViewPlan best = cheapest_plan(view, costs);
    EXPECT_EQ(best.last_ring, 1);
    EXPECT_DOUBLE_EQ(best.ray_pixels, 30e3);
    EXPECT_DOUBLE_EQ(best.touched_pixels, touched);
    EXPECT_DOUBLE_EQ(best.ms,
                     1.0 + 10.1e3 * 1e-4 + touched * 2e-6 + 80e3 * 1e-5 + 2.0 + 30e3 * 50e-6);
}

TEST(ViewPlanTest, MixesOnlyToSaveAQuarter) {
    const TechniqueCosts costs{.frame_ms = 0.0,
                               .triangle_ns = 0.0,
                               .touched_pixel_ns = 0.0,
                               .covered_pixel_ns = 0.0,
                               .rays_ms = 0.0,
                               .ray_pixel_ns = 1e6};
    ViewCosts view{.rings = {{0, 1.0, 24.0}, {1, 1e12, 76.0}}, .box_pixels = 100.0};
    const TechniqueCosts with_triangles{.frame_ms = 0.0,
                                        .triangle_ns = 1.0,
                                        .touched_pixel_ns = 0.0,
                                        .covered_pixel_ns = 0.0,
                                        .rays_ms = 0.0,
                                        .ray_pixel_ns = 1e6};
    EXPECT_EQ(cheapest_plan(view, with_triangles).last_ring, -1);
    view.rings[0].pixels = 26.0;
    EXPECT_EQ(cheapest_plan(view, with_triangles).last_ring, 0);
    EXPECT_EQ(cheapest_plan(view, costs).last_ring, 1) << "triangles cost nothing";
}

TEST(ViewPlanTest, CountsSamples) {
    const TechniqueCosts costs{.frame_ms = 0.0,
                               .triangle_ns = 1.0,
                               .touched_pixel_ns = 0.0,
                               .covered_pixel_ns = 0.0,
                               .rays_ms = 0.0,
                               .ray_pixel_ns = 1e6,
                               .frame_sample_ms = 100.0,
                               .touched_sample_ns = 1e3,
                               .covered_sample_ns = 1e6};
    const ViewCosts view{.rings = {{0, 1e6, 10.0}, {3, 1e6, 10.0}},
                         .box_pixels = 30.0,
                         .samples_of_rays = 1,
                         .samples_of_both = 4};
    EXPECT_DOUBLE_EQ(plan_up_to(-1, view, costs).ms, 30.0);
    const double touched = std::sqrt(1e6 * 10.0) * 1e-3; // ms of a sample
    EXPECT_DOUBLE_EQ(plan_up_to(0, view, costs).ms,
                     1.0 + 3.0 * (100.0 + touched + 10.0) + 4.0 * 20.0);
    EXPECT_DOUBLE_EQ(plan_up_to(3, view, costs).ms, 2.0 + 3.0 * (100.0 + 2.0 * touched + 20.0));
}

// Steps of 900 m every 200 rows, and walls of one sample: the eye sees few tiles.
Grid<float> valleys_behind_walls() {
    Grid<float> heights = test::hills(700, 700, 20.0);
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            heights(col, row) += row % 200 > 140 ? 900.0F : row % 37 == 0 ? 200.0F : 0.0F;
        }
    }
    return heights;
}

// By their costs, by a limit of triangles, and by bounds that rays keep or miss.
TEST(TechniqueChooserTest, HiddenTilesAreLookedForOnlyWhereTheyMayDecide) {
    ChosenView view("auto:error=1", valleys_behind_walls());
    view.camera->get<scene::Camera>()->eye = {0.0, -1500.0, 200.0};
    view.camera->get<scene::Camera>()->target = {0.0, 1500.0, 200.0};
    auto& terrain = *view.node->get<scene::TerrainNode>();
    TechniqueChooser chooser({});
    test::Chance chance(19);
    const auto any = [&](double low, double high) {
        return low * std::pow(high / low, chance.between(0.0, 1.0));
    };
    std::map<std::pair<bool, bool>, int> cases; // dropped, lacks triangles
    for (int i = 0; i < 300; ++i) {
        terrain.material.technique = {scene::Automatic{.error = i % 2 == 0 ? 1.0 : 0.02}};
        terrain.max_triangles =
            i % 3 == 0 ? static_cast<std::size_t>(any(1e4, 1e7)) : ~std::size_t{0};
        const DrawList all = view::select(view.scene, chosen_size, {.occlusion = false}).list;
        DrawList of_seen = all;
        drop_occluded(of_seen);
        ASSERT_LT(of_seen.tiles.size(), all.tiles.size());
        chooser.set_costs({.triangle_ns = any(1.0, 1e4),
                           .touched_pixel_ns = any(1.0, 1e3),
                           .rays_ms = any(1e-2, 10.0),
                           .ray_pixel_ns = any(1.0, 1e4)});
        chooser.choose(of_seen);
        DrawList of_all = all;
        bool has_dropped = false;
        chooser.choose(of_all, [&] {
            has_dropped = true;
            drop_occluded(of_all);
        });
        ++cases[{has_dropped, of_all.stats.lacks_triangles}];
        ASSERT_EQ(of_seen.tiles.size(), of_all.tiles.size());
        ASSERT_EQ(has_rays(of_seen), has_rays(of_all));
        ASSERT_EQ(of_seen.stats.kept_error, of_all.stats.kept_error);
        ASSERT_EQ(of_seen.stats.lacks_triangles, of_all.stats.lacks_triangles);
        ASSERT_EQ(of_seen.stats.choice->rays_ms, of_all.stats.choice->rays_ms);
        ASSERT_EQ(of_seen.stats.choice->estimated_ms, of_all.stats.choice->estimated_ms);
        ASSERT_EQ(of_seen.stats.choice->ray_pixels, of_all.stats.choice->ray_pixels);
    }
    EXPECT_GT((cases[{false, false}]), 30);
    EXPECT_GT((cases[{true, false}]), 30);
    EXPECT_GT((cases[{true, true}]), 3);
    EXPECT_EQ((cases[{false, true}]), 0);
}

TEST(TechniqueChooserTest, DrawsTrianglesRaysOrBothByTheirCosts) {
    const ChosenView view("auto:error=1", plain_before_hills());
    const DrawList triangles = view.chosen(triangles_only);
    EXPECT_FALSE(has_rays(triangles));
    EXPECT_EQ(triangles.stats.choice->tiles_as_triangles, static_cast<int>(triangles.tiles.size()));
    const DrawList rays = view.chosen(rays_only);
    EXPECT_TRUE(rays.tiles.empty());
    ASSERT_TRUE(has_rays(rays));
    EXPECT_EQ(rays.terrains.front().search->technique.id(), scene::TechniqueId::exact);
    EXPECT_EQ(rays.stats.choice->tiles_by_rays, static_cast<int>(triangles.tiles.size()));
    EXPECT_GT(rays.stats.choice->ray_pixels, 0.3);
    const DrawList mixed = view.chosen(both);
    EXPECT_TRUE(has_rays(mixed));
    EXPECT_EQ(mixed.terrains.size(), 1U);
    EXPECT_FALSE(mixed.tiles.empty());
    EXPECT_LT(mixed.tiles.size(), triangles.tiles.size());
    EXPECT_LT(mixed.stats.choice->ray_pixels, rays.stats.choice->ray_pixels);
    EXPECT_EQ(mixed.stats.kept_error, 1.0);
}

// So that no tile of rays is in front of a triangle.
TEST(TechniqueChooserTest, TrianglesAreAroundTheEye) {
    const ChosenView view("auto:error=1", plain_before_hills());
    const glm::ivec2 below(1, 2); // the tile below the eye
    const auto ring_of = [&](const TileDraw& draw) {
        const glm::ivec2 away = glm::abs(draw.tile->first / terrain::tile_cells - below);
        return std::max(away.x, away.y);
    };
    const DrawList mixed = view.chosen(both);
    int last_ring = 0;
    for (const TileDraw& draw : mixed.tiles) {
        last_ring = std::max(last_ring, ring_of(draw));
    }
    for (const TileDraw& draw : view.chosen(triangles_only).tiles) {
        const bool is_drawn =
            std::any_of(mixed.tiles.begin(), mixed.tiles.end(),
                        [&](const TileDraw& other) { return other.tile == draw.tile; });
        EXPECT_EQ(is_drawn, ring_of(draw) <= last_ring);
    }
}

TEST(TechniqueChooserTest, TheSameViewGetsTheSameChoice) {
    const ChosenView view("auto:error=1", plain_before_hills());
    EXPECT_EQ(view.chosen({}).stats.choice, view.chosen({}).stats.choice);
    EXPECT_EQ(view.chosen(both).tiles.size(), view.chosen(both).tiles.size());
}

TEST(TechniqueChooserTest, LeavesOtherTechniquesAlone) {
    const ChosenView view("polygons:error=1");
    const DrawList list = view.chosen(rays_only);
    EXPECT_FALSE(has_rays(list));
    EXPECT_FALSE(list.stats.choice.has_value());
}

TEST(TechniqueChooserTest, DrawsTrianglesWhereRaysHaveNoProof) {
    ChosenView view;
    const auto expect_triangles = [&](const char* why) {
        const DrawList list = view.chosen(rays_only);
        EXPECT_FALSE(has_rays(list)) << why;
        EXPECT_EQ(list.stats.choice->tiles_by_rays, 0) << why;
        EXPECT_FALSE(list.stats.choice->rays_ms.has_value()) << why;
    };
    scene::Camera& camera = *view.camera->get<scene::Camera>();
    const scene::Camera before = camera;
    camera.projection = scene::ProjectionKind::orthographic;
    camera.view_height = 2000.0;
    expect_triangles("a map");
    camera = before;
    const double ground = test::surface_of(*view.node).height_at(3.0, 4.0).value();
    camera = test::camera_at({3.0, 4.0, ground + 0.003}, {100.0, 0.0, ground});
    camera.near = 0.001; // ground before the near plane is not seen
    expect_triangles("an eye so near that floats round by pixels");
    camera = before;
    view.node->get<scene::TerrainNode>()->material.wireframe = true;
    expect_triangles("a wireframe");
    view.node->get<scene::TerrainNode>()->material.wireframe = false;
    EXPECT_TRUE(has_rays(view.chosen(rays_only)));
    view.scene.add_mesh(scene::plane_mesh({10.0F, 10.0F}), {});
    expect_triangles("a mesh beside it");
}

// Triangles that do not fit are off by more than the bound: rays draw instead, also where they keep
// only a larger one.
TEST(TechniqueChooserTest, RaysDrawWhatTrianglesCannotKeepWithinTheMemory) {
    ChosenView view("auto:error=0.02");
    auto& terrain = *view.node->get<scene::TerrainNode>();
    const auto kept_by_rays = [&](const TechniqueCosts& costs) {
        const DrawList list = view.chosen(costs);
        EXPECT_TRUE(list.tiles.empty());
        EXPECT_EQ(list.stats.lacks_triangles, list.stats.kept_error > 0.02);
        return list.stats.kept_error.value_or(0.0);
    };
    EXPECT_FALSE(has_rays(view.chosen(triangles_only)));
    terrain.max_triangles = 10;
    EXPECT_EQ(kept_by_rays(triangles_only), 0.02);
    const double ground = test::surface_of(*view.node).height_at(3.0, 4.0).value();
    *view.camera->get<scene::Camera>() =
        test::camera_at({3.0, 4.0, ground + 2.0}, {3.5, 4.0, ground});
    const double kept = kept_by_rays(triangles_only);
    EXPECT_GT(kept, 0.02);
    const auto& surface = test::surface_of(*view.node);
    const RayError error(view.scene.camera(), chosen_size, surface, steepest(surface),
                         glm::dvec3(0.0));
    const double needed = error.at(nearest_hit(view.scene.camera(), surface));
    EXPECT_GE(kept, needed);
    EXPECT_LE(kept, 1.3 * needed);
    terrain.max_triangles = std::numeric_limits<std::size_t>::max();
    EXPECT_FALSE(has_rays(view.chosen(rays_only))) << "triangles keep it";
}

// The boxes around cells contain the eye, but the surface is metres away from it.
TEST(TechniqueChooserTest, RaysDrawWallsAroundTheEye) {
    Grid<float> walls(300, 300);
    for (int row = 0; row < walls.rows(); ++row) {
        for (int col = 0; col < walls.cols(); ++col) {
            walls(col, row) = (col + row) % 2 == 1 ? 200.0F : 0.0F;
        }
    }
    ChosenView view("auto:error=0.25", std::move(walls));
    view.node->get<scene::TerrainNode>()->max_triangles = 100'000;
    test::Chance chance(8);
    int by_rays = 0;
    constexpr int views = 20;
    for (int i = 0; i < views; ++i) {
        const glm::dvec2 cell(std::floor(chance.between(-90.0, 90.0)),
                              std::floor(chance.between(-90.0, 90.0)));
        // Above the middle of a cell, which is 100 m high.
        const glm::dvec3 eye(10.0 * (cell + 0.0), 105.0 + chance.between(20.0, 60.0));
        *view.camera->get<scene::Camera>() = test::camera_at(
            eye, eye + glm::dvec3(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0), -2.0));
        const DrawList list = view.chosen(rays_only);
        by_rays += list.tiles.empty() ? 1 : 0;
        EXPECT_LT(list.stats.kept_error.value_or(0.0), 10.0);
    }
    EXPECT_EQ(by_rays, views);
}

// Searches that may skip features are drawn on request only, where most probes are right, and where
// they save more than estimates are off.
TEST(TechniqueChooserTest, DrawsSearchesWithoutAProofOnlyOnRequest) {
    constexpr TechniqueCosts cheap_steps{.frame_ms = 0.0,
                                         .triangle_ns = 1000.0,
                                         .touched_pixel_ns = 0.0,
                                         .covered_pixel_ns = 0.0,
                                         .rays_ms = 0.0,
                                         .ray_pixel_ns = 100.0,
                                         .search_pixel_ns = 10.0,
                                         .search_step_ns = 1.0};
    const DrawList proven = ChosenView().chosen(cheap_steps);
    EXPECT_FALSE(proven.stats.choice->typical.has_value());
    EXPECT_EQ(proven.stats.tiles_unproven, 0);
    const ChosenView view("auto:error=1,typical=1");
    const DrawList list = view.chosen(cheap_steps);
    ASSERT_TRUE(list.stats.choice->typical.has_value());
    const TypicalChoice& typical = *list.stats.choice->typical;
    EXPECT_GE(typical.share, 0.9);
    ASSERT_TRUE(has_rays(list));
    EXPECT_EQ(scene::to_string(list.terrains.front().search->technique), typical.technique);
    EXPECT_EQ(list.stats.tiles_unproven, list.stats.choice->tiles_by_rays);
    EXPECT_GT(list.stats.tiles_unproven, 0);
    EXPECT_FALSE(list.stats.kept_error.has_value());
    TechniqueCosts dear_steps = cheap_steps;
    dear_steps.search_pixel_ns = 95.0;
    EXPECT_FALSE(view.chosen(dear_steps).stats.choice->typical.has_value()) << "saves a twentieth";
}

TEST(TechniqueChooserTest, DrawsNoSearchThatShowsTooManyPixelsWrongly) {
    Grid<float> spikes(380, 361, 0.0F);
    for (int row = 0; row < spikes.rows(); row += 6) {
        for (int col = 0; col < spikes.cols(); col += 6) {
            spikes(col, row) = 300.0F;
        }
    }
    const ChosenView view("auto:error=0.5,typical=1", std::move(spikes));
    TechniqueCosts costs = rays_only;
    costs.ray_pixel_ns = 1e6;
    costs.search_pixel_ns = 0.0;
    costs.search_step_ns = 0.0;
    EXPECT_FALSE(view.chosen(costs).stats.choice->typical.has_value());
}

// Probes search in doubles, and would not notice what floats round.
TEST(TechniqueChooserTest, DrawsNoSearchWhereFloatsRoundByMoreThanTheBound) {
    ChosenView view("auto:error=1,typical=1");
    TechniqueCosts costs = triangles_only;
    costs.triangle_ns = 1e9;
    costs.ray_pixel_ns = 1e6;
    costs.search_pixel_ns = 0.0;
    costs.search_step_ns = 0.0;
    EXPECT_TRUE(view.chosen(costs).stats.choice->typical.has_value());
    const double ground = test::surface_of(*view.node).height_at(3.0, 4.0).value();
    *view.camera->get<scene::Camera>() =
        test::camera_at({3.0, 4.0, ground + 0.003}, {100.0, 0.0, ground});
    EXPECT_FALSE(view.chosen(costs).stats.choice->typical.has_value());
}

TEST(TechniqueChooserTest, CountsTilesOfRaysOnTheCpu) {
    const ChosenView view;
    bool they_draw = true;
    const ChoiceOptions options{.costs = {},
                                .rays_draw = [&](const DrawList&) { return they_draw; }};
    const DrawList list = view.select(options).list;
    EXPECT_EQ(list.stats.choice->tiles_by_rays, static_cast<int>(list.tiles.size()));
    EXPECT_EQ(list.stats.choice->tiles_as_triangles, 0);
    they_draw = false; // OpenGL draws, and its triangles and rays are chosen between
    EXPECT_TRUE(view.select(options).list.stats.choice->rays_ms.has_value());
}

TEST(TechniqueChooserTest, AllPartsOfAPictureShowOneKind) {
    ChosenView view;
    const scene::Camera whole = view.scene.camera();
    constexpr glm::ivec2 part_size{80, 80};
    for (const TechniqueCosts& costs : {triangles_only, rays_only, both, TechniqueCosts()}) {
        TechniqueChooser chooser({.costs = costs});
        *view.camera->get<scene::Camera>() = whole;
        chooser.choose_for_parts(view::select(view.scene, chosen_size).list);
        std::set<bool> kinds;
        for (int row = 0; row < chosen_size.y; row += part_size.y) {
            for (int col = 0; col < chosen_size.x; col += part_size.x) {
                *view.camera->get<scene::Camera>() =
                    scene::part_camera(whole, chosen_size, {{col, row}, part_size});
                DrawList list = view::select(view.scene, part_size).list;
                chooser.choose(list);
                if (list.stats.choice) {
                    EXPECT_TRUE(list.tiles.empty() || !has_rays(list));
                    kinds.insert(list.tiles.empty());
                }
            }
        }
        EXPECT_EQ(kinds.size(), 1U);
    }
}

// A node that is scaled, seen from as many times farther away, shows the same picture.
TEST(TechniqueChooserTest, RaysOverAScaledNodeStateTheErrorOfTheSamePicture) {
    ChosenView view("exact");
    const scene::Camera before = view.scene.camera();
    const auto error_of = [&](glm::dvec3 scale) {
        view.node->set_parent_from_local(glm::scale(glm::dmat4(1.0), scale));
        *view.camera->get<scene::Camera>() =
            test::camera_at(scale.x * before.eye, scale.x * before.target);
        return view.chosen({}).stats.kept_error.value();
    };
    const double unscaled = error_of({1.0, 1.0, 1.0});
    EXPECT_GT(unscaled, 0.0);
    EXPECT_NEAR(error_of({8.0, 8.0, 8.0}) / unscaled, 1.0, 1e-6);
    EXPECT_NEAR(error_of({0.125, 0.125, 0.125}) / unscaled, 1.0, 1e-6);
    EXPECT_GT(error_of({1.0, 1.0, 4.0}), 2.0 * unscaled);
}

// A part in the corner of a picture is as far from its middle as the corner is.
TEST(RayErrorTest, OfAPartIsThatOfTheWholePicture) {
    const ChosenView view;
    const auto& surface = test::surface_of(*view.node);
    const glm::ivec2 whole{8000, 6000};
    const glm::ivec2 size{512, 512};
    const scene::Camera part = scene::part_camera(view.scene.camera(), whole, {{0, 0}, size});
    const RayError of_part(part, size, surface, steepest(surface), glm::dvec3(0.0));
    const RayError of_whole(view.scene.camera(), whole, surface, steepest(surface),
                            glm::dvec3(0.0));
    for (double distance = 0.1; distance < 1e5; distance *= 3.0) {
        EXPECT_NEAR(of_part.at(distance) / of_whole.at(distance), 1.0, 1e-9);
    }
}

TEST(RayErrorTest, GrowsTowardsTheEye) {
    const ChosenView view;
    const RayError error(view.scene.camera(), chosen_size, test::surface_of(*view.node),
                         steepest(test::surface_of(*view.node)), glm::dvec3(0.0));
    double last = std::numeric_limits<double>::infinity();
    for (double distance = 0.01; distance < 1e6; distance *= 2.0) {
        EXPECT_LT(error.at(distance), last);
        last = error.at(distance);
    }
    EXPECT_LT(last, 1e-3);
    EXPECT_TRUE(error.keeps(1.0));
    EXPECT_FALSE(error.keeps(1e-9));
}

} // namespace
} // namespace reljef::view
