#include "engine/session/scene_renderer.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/session/prepared_maps.h"
#include "engine/session/streaming.h"
#include "engine/view/picture/eye_dome.h"
#include "engine/view/picture/label_picture.h"
#include "tests/app/made_hill.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_scene.h"
#include "tests/session/made_session.h"
#include "tests/session/made_waves.h"
#include "tests/support/temporary_folder.h"

namespace reljef::session {
namespace {

constexpr glm::ivec2 shown_size{160, 120};

// Rises by 5 m to the north and 1 m to the east per sample.
Grid<float> labelled_slope() {
    return test::made_heights(129, 129, [](int col, int row) { return col + 5.0 * (128 - row); });
}

Grid<float> depths_of(const HitBuffer& hits) {
    Grid<float> depths(hits.cols(), hits.rows());
    std::ranges::transform(hits.samples(), depths.samples().begin(), &Hit::depth);
    return depths;
}

class SceneRendererWithRays : public test::GlTest {
protected:
    static SceneRenderer make_renderer() {
        return test::must(SceneRenderer::create(
            {.opengl = opengl_options(), .rays = cast::DriverOptions{.size = shown_size}}));
    }
    static render::DriverOptions opengl_options() {
        render::DriverOptions options;
        options.size = shown_size;
        return options;
    }
    static void use(TerrainScene& scene, const scene::Technique& technique) {
        scene.terrain->get<scene::TerrainNode>()->material.technique = technique;
    }
};

TEST_F(SceneRendererWithRays, EyeDomeDarkensWhatLiesBehind) {
    TerrainScene scene = app::scene_of(test::hills(129, 129, 100.0));
    for (const auto& technique : {scene::Technique{scene::Exact{}}, {scene::Polygons{}}}) {
        use(scene, technique);
        SceneRenderer renderer = make_renderer();
        const auto drawn = [&](double strength) {
            scene.scene.set_eye_dome(strength);
            test::must(renderer.draw(scene.scene));
            return renderer.read_color();
        };
        const Image plain = drawn(0.0);
        const Image domed = drawn(0.8);
        EXPECT_EQ(drawn(0.8), domed);
        const Grid<float> depths = depths_of(test::must(renderer.draw_hits(scene.scene)));
        Image expected = plain;
        view::shade_eye_dome(expected.view(), depths, renderer.selector().selected().list);
        EXPECT_EQ(domed, expected);
        EXPECT_NE(domed, plain);
        EXPECT_EQ(drawn(0.0), plain);
    }
}

// A roof over all of the ground.
TEST_F(SceneRendererWithRays, MeshesHideLabels) {
    TerrainScene scene = app::scene_of(labelled_slope());
    auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    terrain.contours = 40.0;
    scene::Node& roof = scene.scene.add_mesh(scene::plane_mesh(glm::vec2(3000.0F)));
    roof.set_position({0.0, 0.0, 810.0});
    for (const auto& technique : {scene::Technique{scene::Exact{}}, {scene::Polygons{}}}) {
        use(scene, technique);
        SceneRenderer renderer = make_renderer();
        const auto drawn = [&](bool has_labels) {
            terrain.labels_contours = has_labels;
            test::must(renderer.draw(scene.scene));
            return renderer.read_color();
        };
        roof.set_visible(true);
        EXPECT_EQ(drawn(true), drawn(false));
        roof.set_visible(false);
        EXPECT_NE(drawn(true), drawn(false));
    }
}

// Both ways of drawing have the same labels, drawn once, and parts of a picture those of the whole.
TEST_F(SceneRendererWithRays, LabelsContoursOfEachFrame) {
    TerrainScene scene = app::scene_of(labelled_slope());
    auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    terrain.contours = 40.0;
    for (const auto& technique : {scene::Technique{scene::Exact{}}, {scene::Polygons{}}}) {
        use(scene, technique);
        SceneRenderer renderer = make_renderer();
        const auto drawn = [&] {
            test::must(renderer.draw(scene.scene));
            return renderer.read_color();
        };
        terrain.labels_contours = false;
        const Image plain = drawn();
        terrain.labels_contours = true;
        const Image labelled = drawn();
        EXPECT_EQ(drawn(), labelled);
        const auto labels = view::contour_labels(renderer.selector().selected().list);
        ASSERT_FALSE(labels.labels.empty());
        Image expected = plain;
        for (const view::ContourLabel& label : labels.labels) {
            view::draw_label(label, labels.digit_height, expected.view(), {0, 0});
        }
        EXPECT_EQ(labelled, expected);
        renderer.choose_for_parts(scene.scene, shown_size);
        auto& camera = *scene.camera->get<scene::Camera>();
        const scene::Camera whole = camera;
        camera = scene::part_camera(whole, shown_size, {{40, 30}, shown_size});
        EXPECT_EQ(drawn()(0, 0), labelled(40, 30));
        camera = whole;
    }
}

TEST_F(SceneRendererWithRays, LeavesOutLabelsInAreasThatAreKeptClear) {
    TerrainScene scene = app::scene_of(labelled_slope());
    auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    terrain.contours = 40.0;
    use(scene, scene::Technique{scene::Exact{}});
    SceneRenderer renderer = make_renderer();
    const auto drawn = [&](bool has_labels) {
        terrain.labels_contours = has_labels;
        test::must(renderer.draw(scene.scene));
        return renderer.read_color();
    };
    const Image lines = drawn(false);
    const Image labelled = drawn(true);
    ASSERT_NE(labelled, lines);
    renderer.keep_clear({{{0, 0}, shown_size}});
    EXPECT_EQ(drawn(true), lines);
    renderer.keep_clear({{shown_size, {10, 10}}});
    EXPECT_EQ(drawn(true), labelled) << "beside the picture";
}

TEST_F(SceneRendererWithRays, DrawsByRaysWhatTheyCanDrawAndSaysSoWhenThatChanges) {
    TerrainScene scene = app::hill_scene();
    SceneRenderer renderer = make_renderer();
    EXPECT_TRUE(renderer.shows_rays());
    use(scene, {scene::Exact{}});
    EXPECT_GT(test::must(renderer.draw(scene.scene)).rays, 0U);
    EXPECT_EQ(renderer.take_note(), "");
    const Image rays = renderer.read_color();

    use(scene, {scene::Texture{}});
    EXPECT_EQ(test::must(renderer.draw(scene.scene)).rays, 0U);
    EXPECT_FALSE(renderer.shows_rays());
    EXPECT_NE(renderer.take_note().find("technique texture: drawn by OpenGL"), std::string::npos);
    EXPECT_EQ(renderer.take_note(), "");
    EXPECT_NE(renderer.read_color(), rays);

    ASSERT_TRUE(renderer.resize(shown_size / 2));
    use(scene, {scene::Exact{}});
    EXPECT_GT(test::must(renderer.draw(scene.scene)).rays, 0U);
    EXPECT_NE(renderer.take_note().find("again"), std::string::npos);
    EXPECT_EQ(renderer.read_color().cols(), shown_size.x / 2);
}

TEST_F(SceneRendererWithRays, SaysWhyOpenGlDrawsTheFirstFrameIfRaysAreExpected) {
    TerrainScene scene = app::hill_scene();
    use(scene, {scene::Texture{}});
    for (const bool expects_rays : {false, true}) {
        SceneRenderer renderer =
            test::must(SceneRenderer::create({.opengl = opengl_options(),
                                              .rays = cast::DriverOptions{.size = shown_size},
                                              .expects_rays = expects_rays}));
        test::must(renderer.draw(scene.scene));
        EXPECT_EQ(renderer.take_note().empty(), !expects_rays);
    }
}

TEST_F(SceneRendererWithRays, TakesLightForWhateverDrawsNext) {
    TerrainScene scene = app::hill_scene();
    for (const scene::Technique& technique :
         {scene::Technique{scene::Exact{}}, scene::Technique{scene::Texture{}}}) {
        use(scene, technique);
        SceneRenderer renderer = make_renderer();
        auto light = view::prepare_light(*light_request(scene, *scene.light->get<scene::Light>(),
                                                        technique, renderer.max_texture_side()));
        std::fill(light.lit.samples().begin(), light.lit.samples().end(), Rgba8{255, 0, 0, 255});
        renderer.add_light(std::make_shared<const view::PreparedLight>(std::move(light)));
        test::must(renderer.draw(scene.scene));
        const Rgba8 middle = renderer.read_color()(shown_size.x / 2, shown_size.y / 2);
        EXPECT_GT(middle.r, 2 * middle.g) << scene::to_string(technique);
    }
}

TEST_F(SceneRendererWithRays, WhatDrawsNoMoreReleasesItsContent) {
    TerrainScene scene = app::hill_scene();
    SceneRenderer renderer = make_renderer();
    for (int round = 0; round < 2; ++round) {
        for (const scene::Technique& technique :
             {scene::Technique{scene::Exact{}}, scene::Technique{scene::Texture{}}}) {
            use(scene, technique);
            const auto first = test::must(renderer.draw(scene.scene)).upload_bytes;
            const auto again = test::must(renderer.draw(scene.scene)).upload_bytes;
            EXPECT_GT(first, again + 1000) << round << scene::to_string(technique);
        }
    }
}

struct OtherHits {
    int ground = 0;
    int others = 0; // sky, or more than a pixel apart
};

OtherHits compared(const HitBuffer& opengl, const HitBuffer& rays) {
    OtherHits found;
    for (std::size_t i = 0; i < rays.samples().size(); ++i) {
        const Hit& a = opengl.samples()[i];
        const Hit& b = rays.samples()[i];
        found.ground += b.is_sky() ? 0 : 1;
        const double far = 0.005 * std::max(a.depth, b.depth) + 1.0; // metres
        const bool is_apart = !a.is_sky() && !b.is_sky() &&
                              (10.0 * glm::distance(a.place(), b.place()) > 4.0 * far ||
                               std::abs(a.height - b.height) > far);
        found.others += a.is_sky() != b.is_sky() || is_apart ? 1 : 0;
    }
    return found;
}

// Of a stream in a small memory; the tiles are the same.
TEST_F(SceneRendererWithRays, FindsTheHitsOfOpenGlOverStreamedTiles) {
    const test::TemporaryFolder folder;
    test::write_waves(folder.path() / "waves.tif", 1100, 700);
    SourceOptions choice;
    choice.terrain = (folder.path() / "waves.tif").string();
    choice.placement = terrain::PlacementKind::plane;
    choice.memory_megabytes = 8;
    choice.streamed = true;
    SceneOptions view;
    view.pose = scene::Pose::low;
    view.max_error = 0.5;
    Log silent;
    TerrainScene scene = test::must(open_scene(choice, view, silent));
    auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    ASSERT_NE(terrain.stream, nullptr);
    for (const scene::Technique& technique :
         {terrain.material.technique, scene::Technique{scene::Exact{}}}) {
        terrain.material.technique = technique;
        SceneRenderer by_opengl = test::must(test::make_renderer(shown_size));
        SceneRenderer by_rays =
            test::must(SceneRenderer::create({.rays = cast::DriverOptions{.size = shown_size}}));
        for (SceneRenderer* const renderer : {&by_opengl, &by_rays}) {
            wait_for_tiles(scene.scene, shown_size, renderer->selector(), silent, {});
        }
        const OtherHits found = compared(test::must(by_opengl.draw_hits(scene.scene)),
                                         test::must(by_rays.draw_hits(scene.scene)));
        EXPECT_GT(found.ground, shown_size.x * shown_size.y / 4) << scene::to_string(technique);
        EXPECT_LE(found.others, found.ground / 50) << scene::to_string(technique);
        EXPECT_GT(test::must(by_rays.draw(scene.scene)).tiles, 10) << scene::to_string(technique);
    }
}

TEST(SceneRendererOptions, WithRaysAloneNothingElseDraws) {
    TerrainScene scene = app::hill_scene();
    scene.terrain->get<scene::TerrainNode>()->material.technique = {scene::Texture{}};
    SceneRenderer renderer =
        test::must(SceneRenderer::create({.rays = cast::DriverOptions{.size = shown_size}}));
    EXPECT_FALSE(renderer.draw(scene.scene));
}

TEST(SceneSetup, RaysDrawWhatIsNotNamedAsExact) {
    const test::TemporaryFolder folder;
    SourceOptions choice;
    choice.terrain = folder
                         .write("hill.asc", "ncols 3\nnrows 3\nxllcenter 0\nyllcenter 0\n"
                                            "cellsize 1\n0 0 0 0 1 0 0 0 0\n")
                         .string();
    const auto technique_with = [&](const SceneOptions& view) {
        return test::make_scene(std::move(*test::open_terrain(choice)), choice, view)
            .value()
            .terrain->get<scene::TerrainNode>()
            ->material.technique;
    };
    SceneOptions view;
    EXPECT_EQ(technique_with(view).id(), scene::TechniqueId::polygons);
    for (const RayUse use : {RayUse::preferred, RayUse::only}) {
        view = {};
        view.rays = use;
        EXPECT_EQ(technique_with(view).id(), scene::TechniqueId::exact);
        view.max_error = 2.0;
        EXPECT_EQ(technique_with(view).id(), scene::TechniqueId::polygons);
        view.max_error.reset();
        view.wireframe = true;
        EXPECT_EQ(technique_with(view).id(), scene::TechniqueId::polygons);
        view.wireframe = false;
        view.technique = scene::Technique{scene::Texture{}};
        EXPECT_EQ(technique_with(view).id(), scene::TechniqueId::texture);
    }
}

TEST(BackendKind, HasTheNamesOfContexts) {
    for (const BackendKind kind :
         {BackendKind::osmesa, BackendKind::egl, BackendKind::glfw, BackendKind::cpu}) {
        EXPECT_EQ(backend_from_string(to_string(kind)), kind);
    }
    EXPECT_EQ(to_string(BackendKind::cpu), "cpu");
    EXPECT_FALSE(backend_from_string("gpu"));
}

} // namespace
} // namespace reljef::session
