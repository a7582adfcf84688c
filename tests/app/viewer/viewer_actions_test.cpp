#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/viewer.h"
#include "tests/app/command_line.h"
#include "tests/app/made_hill.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

struct ViewerActions : testing::Test {
    void press(Key key) {
        viewer.receive(KeyEvent{.key = key, .pressed = true});
        viewer.receive(KeyEvent{.key = key, .pressed = false});
    }

    session::TerrainScene scene = hill_scene();
    Viewer viewer{scene, scene::orbit_path(scene.bounds, 10.0), {400, 300}};
};

TEST_F(ViewerActions, ActionsEditThePath) {
    const auto times = [&] {
        std::vector<double> found;
        for (const scene::Keyframe& key : viewer.path_desk().path().keys()) {
            found.push_back(key.time - viewer.path_desk().path().begin());
        }
        return found;
    };
    press(Key::insert);
    press(Key::insert);
    ASSERT_EQ(times(), (std::vector{0.0, 3.0}));
    ASSERT_TRUE(viewer.act(InsertPathKey{1.0}));
    EXPECT_EQ(times(), (std::vector{0.0, 1.0, 3.0}));
    ASSERT_TRUE(viewer.act(RetimePathKey{1, 2.0}));
    EXPECT_EQ(times(), (std::vector{0.0, 2.0, 3.0}));
    EXPECT_FALSE(viewer.act(RetimePathKey{1, 3.0})); // another one is there
    ASSERT_TRUE(viewer.act(SetPathDuration{6.0}));
    EXPECT_EQ(times(), (std::vector{0.0, 4.0, 6.0}));
    ASSERT_TRUE(viewer.act(SeekPath{6.0}));
    ASSERT_TRUE(viewer.act(MovePathKey{0}));
    ASSERT_TRUE(viewer.act(RemovePathKey{2}));
    EXPECT_EQ(times(), (std::vector{0.0, 4.0}));
    EXPECT_LE(viewer.path_time(), 4.0);
    EXPECT_TRUE(viewer.take_content_change());
    ASSERT_TRUE(viewer.act(RemovePathKey{1}));
    EXPECT_FALSE(viewer.act(RemovePathKey{0})); // the only one
    EXPECT_FALSE(viewer.act(MovePathKey{7}));
}

TEST_F(ViewerActions, ActionsKeepNameAndDeleteBookmarks) {
    const test::TemporaryFolder folder;
    Viewer tested(
        scene, scene::orbit_path(scene.bounds, 10.0), {400, 300},
        {.maps = {}, .terrain = "hill.tif", .bookmarks = folder.path() / "data" / "bookmarks.txt"});
    EXPECT_TRUE(tested.known_bookmarks().bookmarks.empty());
    ASSERT_TRUE(tested.act(AddBookmark{}));
    ASSERT_TRUE(tested.act(AddBookmark{"ridge"}));
    EXPECT_TRUE(tested.take_content_change());
    EXPECT_THAT(tested.take_output(), testing::AllOf(testing::HasSubstr("saved bookmark view 1: "),
                                                     testing::HasSubstr("saved bookmark ridge: ")));
    const auto names = [&] {
        std::vector<std::string> found;
        for (const Bookmark& bookmark : tested.known_bookmarks().bookmarks) {
            found.push_back(bookmark.name);
        }
        return found;
    };
    EXPECT_EQ(names(), (std::vector<std::string>{"view 1", "ridge"}));
    ASSERT_TRUE(tested.act(RenameBookmark{tested.known_bookmarks().bookmarks[0], "summit"}));
    EXPECT_EQ(names(), (std::vector<std::string>{"summit", "ridge"}));
    ASSERT_TRUE(tested.act(GoToBookmark{tested.known_bookmarks().bookmarks[0]}));
    EXPECT_TRUE(tested.is_moving());
    const Bookmark ridge = tested.known_bookmarks().bookmarks[1];
    ASSERT_TRUE(tested.act(RemoveBookmark{ridge}));
    EXPECT_EQ(names(), (std::vector<std::string>{"summit"}));
    EXPECT_FALSE(tested.act(RemoveBookmark{ridge})) << "it is gone";
    EXPECT_FALSE(tested.act(RenameBookmark{ridge, "gone"}));
    EXPECT_EQ(names(), (std::vector<std::string>{"summit"}));
}

TEST_F(ViewerActions, WithoutAFileOfBookmarksOneSentenceSaysSo) {
    EXPECT_THAT(viewer.known_bookmarks().note, testing::HasSubstr("$XDG_DATA_HOME"));
    EXPECT_FALSE(viewer.act(AddBookmark{"ridge"}));
    EXPECT_FALSE(viewer.act(RemoveBookmark{}));
}

TEST_F(ViewerActions, TheSpeedIsSet) {
    ASSERT_TRUE(viewer.act(SetSpeed{12.5}));
    EXPECT_EQ(viewer.speed(), 12.5);
}

TEST_F(ViewerActions, AViewshedIsShownOnlyIfThereIsOne) {
    const auto shown = viewer.act(ShowViewshed{});
    ASSERT_FALSE(shown);
    EXPECT_THAT(shown.error().message, testing::HasSubstr("U makes it"));
    EXPECT_FALSE(viewer.shows_viewshed());
    EXPECT_TRUE(viewer.act(ShowViewshed{false}));
}

TEST_F(ViewerActions, ZeroGivesTheGalleryItsFirstTechniques) {
    const test::TemporaryFolder folder;
    session::Log silent;
    session::SourceOptions source;
    source.terrain = test::small_terrain(folder, "gallery");
    session::TerrainScene gallery = session::open_scene(source, {}, silent).value();
    Viewer tested(gallery, scene::orbit_path(gallery.bounds, 10.0), {400, 300});
    const auto shown = [&] {
        std::vector<scene::Technique> found;
        for (const scene::Material* const material : gallery.materials()) {
            found.push_back(material->technique);
        }
        return found;
    };
    const auto start = shown();
    ASSERT_TRUE(std::any_of(start.begin(), start.end(),
                            [&](const auto& other) { return other != start.front(); }));
    ASSERT_TRUE(tested.act(SelectModel{1}));
    ASSERT_TRUE(tested.act(ChooseTechnique{scene::Technique{scene::Texture{}}, 1}));
    ASSERT_TRUE(tested.act(SelectModel{}));
    ASSERT_TRUE(tested.act(ChooseTechnique{scene::Technique{scene::Texture{}}, {}}));
    EXPECT_FALSE(tested.keeps_techniques());
    tested.take_redraw();
    tested.receive(KeyEvent{.key = Key::digit0, .pressed = true});
    while (tested.is_preparing()) {
        tested.advance(0.01);
    }
    EXPECT_EQ(shown(), start);
    EXPECT_TRUE(tested.keeps_techniques());
    EXPECT_TRUE(tested.take_redraw());
}

TEST_F(ViewerActions, SpaceComparesAndSwapsTechniques) {
    press(Key::space);
    EXPECT_EQ(viewer.comparison().with(), CompareWith::truth);
    press(Key::minus);
    EXPECT_NEAR(viewer.comparison().share(), 0.45, 1e-12);
    ASSERT_TRUE(viewer.act(SetOtherTechnique{scene::Technique{scene::Texture{}}}));
    const scene::Technique left = viewer.technique();
    ASSERT_TRUE(viewer.act(SwapTechniques{}));
    EXPECT_EQ(viewer.technique().id(), scene::TechniqueId::texture);
    EXPECT_EQ(viewer.comparison().technique(), left);
    press(Key::space);
    EXPECT_FALSE(viewer.comparison().is_on());
}

} // namespace
} // namespace reljef::app
