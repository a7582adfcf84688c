// What panels and keys do in the gallery.
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/viewer.h"
#include "app/viewer/viewer_content.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

constexpr glm::ivec2 gallery_window{400, 300};

void settle_gallery(Viewer& viewer) {
    viewer.advance(1.0 / 60.0);
    while (viewer.is_preparing()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1)); // leaves the work a processor
        viewer.advance(1.0 / 60.0);
    }
}

// The gallery's models have techniques of their own.
struct GalleryEffects : testing::Test {
    GalleryEffects() {
        session::SourceOptions source;
        source.terrain =
            folder.write("gallery.toml", "[terrain]\ngenerator = \"gallery\"\nsize = 33\n")
                .string();
        session::SceneOptions view;
        view.prepares_maps = false;
        session::Log silent;
        auto opened = session::open_scene(source, view, silent);
        EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
        scene = std::move(*opened);
        viewer.emplace(scene, scene::orbit_path(scene.bounds, 10.0), gallery_window);
    }
    [[nodiscard]] std::vector<scene::Technique> techniques() const {
        std::vector<scene::Technique> shown;
        for (const scene::Material* const material : scene.materials()) {
            shown.push_back(material->technique);
        }
        return shown;
    }
    void press(Key key) {
        viewer->receive(KeyEvent{.key = key, .pressed = true});
        viewer->receive(KeyEvent{.key = key, .pressed = false});
        settle_gallery(*viewer);
    }

    test::TemporaryFolder folder;
    session::TerrainScene scene;
    std::optional<Viewer> viewer;
};

TEST_F(GalleryEffects, AModelIsEditedAloneUntilAllAreSelected) {
    const std::vector<scene::Technique> before = techniques();
    ASSERT_GT(before.size(), 2U);
    EXPECT_TRUE(viewer->keeps_techniques());
    const scene::Technique relief{scene::Relief{.linear_steps = 20}};
    ASSERT_TRUE(viewer->act(SelectModel{1}));
    EXPECT_EQ(content_of(*viewer, scene, gallery_window).technique.model, 1U);
    ASSERT_TRUE(viewer->act(ChooseTechnique{relief, 1}));
    settle_gallery(*viewer);
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_EQ(techniques()[i], i == 1 ? relief : before[i]) << i;
    }
    EXPECT_FALSE(viewer->keeps_techniques());
    press(Key::right_bracket);
    EXPECT_GT(std::get<scene::Relief>(techniques()[1].parameters).linear_steps, 20);
    EXPECT_EQ(techniques()[0], before[0]);
    ASSERT_TRUE(viewer->act(SelectModel{}));
    ASSERT_TRUE(viewer->act(ChooseTechnique{relief, {}}));
    settle_gallery(*viewer);
    EXPECT_THAT(techniques(), testing::Each(relief));
}

TEST_F(GalleryEffects, TheSelectedModelHasAFrameInTheView) {
    const auto models = [&] { return content_of(*viewer, scene, gallery_window).technique.models; };
    for (const ModelContent& model : models()) {
        EXPECT_FALSE(model.box) << "all are selected";
    }
    ASSERT_TRUE(viewer->act(SelectModel{1}));
    const auto marked = models();
    EXPECT_FALSE(marked.at(0).box);
    ASSERT_TRUE(marked.at(1).box);
    const glm::dvec3 middle = scene.models.at(1)->world_bounds().center();
    const glm::dvec2 pixel =
        scene::project(*scene.camera->get<scene::Camera>(), gallery_window, middle).pixel;
    const PixelBox& box = *marked.at(1).box;
    EXPECT_TRUE(box.low.x < pixel.x && pixel.x < box.high.x);
    EXPECT_TRUE(box.low.y < pixel.y && pixel.y < box.high.y);
    EXPECT_LT(box.high.x - box.low.x, 0.5 * gallery_window.x) << "around one model only";
    auto& camera = *scene.camera->get<scene::Camera>();
    std::swap(camera.eye, camera.target); // all models are behind it
    EXPECT_FALSE(models().at(1).box);
}

TEST_F(GalleryEffects, KeysChangeAllModelsAndTheirLight) {
    press(Key::digit1);
    EXPECT_THAT(techniques(), testing::Each(techniques().front()));
    const scene::Technique first = techniques().front();
    press(Key::t);
    EXPECT_NE(techniques().front(), first);
    const double azimuth = scene.light->get<scene::Light>()->azimuth;
    press(Key::l);
    EXPECT_NEAR(std::fmod(scene.light->get<scene::Light>()->azimuth - azimuth + 360.0, 360.0), 15.0,
                1e-9);
    press(Key::f);
    for (const scene::Material* const material : scene.materials()) {
        EXPECT_TRUE(material->wireframe);
    }
}

// Models have no heights that could be exaggerated or coloured, and no truth.
TEST_F(GalleryEffects, WhatModelsLackIsRefusedWithASentence) {
    for (const Result<void>& refused :
         {viewer->act(SetRamp{"swiss"}), viewer->act(SetImageryShare{0.5}),
          viewer->act(SetExaggeration{2.0}), viewer->act(SetComparison{CompareWith::truth})}) {
        ASSERT_FALSE(refused);
        EXPECT_NE(refused.error().message, "");
    }
    settle_gallery(*viewer);
    EXPECT_EQ(viewer->exaggeration(), 1.0);
}

} // namespace
} // namespace reljef::app
