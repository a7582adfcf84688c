#include "app/viewer/places/bookmarks.h"

#include <array>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/cli/message.h"
#include "app/viewer/camera_text.h"
#include "engine/scene/motion/camera_gestures.h"
#include "tests/app/made_hill.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

using testing::HasSubstr;

std::string content_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

const Bookmark ridge{"alps.tif", "Ridge", "--camera 46,8,2000,10,-5"};
const Bookmark lake{"alps.tif", "Žabljak, lake", "--eye 1,2,3 --look 4,5,6"};
const Bookmark other{"city.tif", "square", "--eye 1,2,3 --look 4,5,6"};

TEST(Bookmarks, AreReadAsTheyWereWritten) {
    const test::TemporaryFolder folder;
    const Bookmarks marks(folder.path() / "new" / "folder" / "bookmarks.txt");
    EXPECT_TRUE(marks.of("alps.tif")->bookmarks.empty());
    for (const Bookmark& mark : {ridge, other, lake}) {
        ASSERT_TRUE(marks.add(mark));
    }
    const auto found = marks.of("alps.tif");
    ASSERT_TRUE(found);
    EXPECT_THAT(found->bookmarks, testing::ElementsAre(ridge, lake));
    EXPECT_EQ(found->note, "");
    ASSERT_TRUE(marks.remove(ridge));
    EXPECT_THAT(marks.of("alps.tif")->bookmarks, testing::ElementsAre(lake));
    EXPECT_THAT(marks.of("city.tif")->bookmarks, testing::ElementsAre(other));
    EXPECT_FALSE(marks.remove(ridge));
}

TEST(Bookmarks, TabsAndLineEndsInNamesHarmNothing) {
    const test::TemporaryFolder folder;
    const Bookmarks marks(folder.path() / "bookmarks.txt");
    ASSERT_TRUE(marks.add({"a\tb.tif", "one\ttwo\nthree", ridge.camera}));
    EXPECT_EQ(marks.of("a b.tif")->bookmarks.front().name, "one two three");
}

TEST(Bookmarks, AreRenamedInTheirPlace) {
    const test::TemporaryFolder folder;
    const Bookmarks marks(folder.write(
        "bookmarks.txt", "# mine\nalps.tif\tRidge\t--camera 46,8,2000,10,-5\r\nhalf\n"));
    ASSERT_TRUE(marks.add(lake));
    ASSERT_TRUE(marks.rename(ridge, "Grat\tim Süden"));
    EXPECT_THAT(marks.of("alps.tif")->bookmarks,
                testing::ElementsAre(Bookmark{"alps.tif", "Grat im Süden", ridge.camera}, lake));
    EXPECT_THAT(content_of(marks.file()), testing::StartsWith("# mine\nalps.tif\tGrat im Süden\t"));
    EXPECT_THAT(content_of(marks.file()), HasSubstr("\nhalf\n"));
    const std::string before = content_of(marks.file());
    EXPECT_THAT(marks.rename(ridge, "gone").error().message, HasSubstr("no bookmark 'Ridge'"));
    EXPECT_THAT(marks.rename(lake, "").error().message, HasSubstr("a name was expected"));
    EXPECT_EQ(content_of(marks.file()), before);
}

TEST(Bookmarks, FilesOfOneNameAndNamesLikeCommentsHaveTheirOwn) {
    const test::TemporaryFolder folder;
    folder.write("one/#dem.tif", "");
    folder.write("two/#dem.tif", "");
    const Bookmarks marks(folder.path() / "bookmarks.txt");
    const std::string first = folder.path() / "one/#dem.tif";
    ASSERT_TRUE(marks.add({first, "ridge", ridge.camera}));
    EXPECT_EQ(marks.of(folder.path() / "one/../one/#dem.tif")->bookmarks.size(), 1U);
    EXPECT_TRUE(marks.of(folder.path() / "two/#dem.tif")->bookmarks.empty());
}

TEST(Bookmarks, DamagedLinesAreKeptAndNamed) {
    const test::TemporaryFolder folder;
    const std::string damaged = "# mine\n\nalps.tif\tRidge\t--camera 46,8,2000,10,-5\nhalf a li\n" +
                                std::string("\0\xff\tx\ty\n", 7) + "\t\t\n";
    const Bookmarks marks(folder.write("bookmarks.txt", damaged + "no end"));
    const auto found = marks.of("alps.tif");
    ASSERT_TRUE(found);
    EXPECT_THAT(found->bookmarks, testing::ElementsAre(ridge));
    EXPECT_THAT(found->note, HasSubstr("4 lines found that are no bookmark, the first is line 4"));
    ASSERT_TRUE(marks.add(lake));
    EXPECT_THAT(content_of(marks.file()), testing::StartsWith(damaged + "no end\n"));
    EXPECT_THAT(marks.of("alps.tif")->bookmarks, testing::ElementsAre(ridge, lake));
}

TEST(Bookmarks, FileThatCannotBeReadOrWrittenStays) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "bookmarks.txt");
    const Bookmarks marks(folder.path() / "bookmarks.txt");
    EXPECT_FALSE(marks.of("alps.tif"));
    const auto added = marks.add(ridge);
    ASSERT_FALSE(added);
    EXPECT_THAT(added.error().message, HasSubstr("bookmarks.txt"));
    EXPECT_TRUE(std::filesystem::is_directory(marks.file()));
    folder.write("file", "x");
    EXPECT_FALSE(Bookmarks(folder.path() / "file" / "bookmarks.txt").add(ridge));
}

TEST(CameraText, IsReadAsTheSameCamera) {
    const session::TerrainScene scene = hill_scene();
    const auto& surface = *scene.terrain->get<scene::TerrainNode>()->surface;
    const scene::Camera camera = scene::camera_from_angles({1.0, 2.0, 300.0}, 123.0, -20.0);
    const auto read = camera_from_text(surface, camera_text(surface, camera), camera);
    ASSERT_TRUE(read);
    EXPECT_LT(glm::distance(read->eye, camera.eye), 1e-4);
    EXPECT_LT(glm::distance(scene::view_axes(*read).forward, scene::view_axes(camera).forward),
              1e-5);
}

TEST(CameraText, PlacesBeyondTheWorldAreNoCameras) {
    const auto scene = hill_scene();
    const auto& surface = *scene.terrain->get<scene::TerrainNode>()->surface;
    for (const char* const text : {"--eye 1e300,0,0 --look 0,0,0", "--eye 0,0,0 --look 0,-1e300,0",
                                   "--camera 0,0,1e300,0,0", "--camera 0,0,0,0,91"}) {
        EXPECT_FALSE(camera_from_text(surface, text, {})) << text;
    }
}

// Two windows at a time: each has read the file that the other one changes.
TEST(Bookmarks, OfTwoWindowsAreAllKept) {
    const test::TemporaryFolder folder;
    constexpr int count = 25;
    const auto add_all = [&](const std::string& name) {
        const Bookmarks bookmarks(folder.path() / "marks.txt");
        for (int i = 0; i < count; ++i) {
            const auto added = bookmarks.add({"alps.tif", name + std::to_string(i), ridge.camera});
            EXPECT_TRUE(added) << added.error().message;
        }
    };
    std::thread second(add_all, "b");
    add_all("a");
    second.join();
    const auto all = Bookmarks(folder.path() / "marks.txt").of("alps.tif");
    ASSERT_TRUE(all) << all.error().message;
    EXPECT_EQ(all->bookmarks.size(), 2U * count);
}

TEST(Printable, EscapesWhatSteersATerminalOrIsNoUtf8) {
    EXPECT_EQ(cli::printable("Mont Blanc, Žabljak, 岩, 🏔"), "Mont Blanc, Žabljak, 岩, 🏔");
    EXPECT_EQ(cli::printable("a\x1b[31m\x7f\n"), "a\\x1b[31m\\x7f\\x0a");
    EXPECT_EQ(cli::printable("\x9b"
                             "31m\xc2\x9b"
                             "31m"),
              "\\x9b31m\\x9b31m");
    EXPECT_EQ(cli::printable("\xe5\xb2|\xff|\xc3"), "\\xe5\\xb2|\\xff|\\xc3");
}

TEST(CameraText, OtherTextIsNoCamera) {
    const session::TerrainScene scene = hill_scene();
    const auto& surface = *scene.terrain->get<scene::TerrainNode>()->surface;
    for (const char* text :
         {"", " ", "--eye", "--eye 1,2,3", "--eye 1,2,3 --look 1,2,3", "--eye 1,2 --look 1,2,3",
          "--eye 1,2,nan --look 1,2,3", "--eye 1,2,inf --look 4,5,6", "--eye a,b,c --look 1,2,3",
          "--eye 1,2,3, --look 4,5,6", "--camera 46,8,2000,0,0", "--camera 1,2", "--camera"}) {
        EXPECT_FALSE(camera_from_text(surface, text, {})) << text;
    }
}

} // namespace
} // namespace reljef::app
