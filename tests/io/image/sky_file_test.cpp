#include "engine/io/image/sky_file.h"

#include <algorithm>
#include <fstream>

#include <glm/common.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef::io {
namespace {

using testing::HasSubstr;

namespace fs = std::filesystem;

Image sheet(glm::ivec2 size, Rgba8 color) {
    Image picture(size.x, size.y);
    std::ranges::fill(picture.samples(), color);
    return picture;
}

class SkyFileTest : public testing::Test {
protected:
    fs::path written(const std::string& name, const Image& picture) {
        EXPECT_TRUE(write_image(folder_.path() / name, picture));
        return folder_.path() / name;
    }
    std::string error_of(const fs::path& path) {
        const auto sky = read_sky(path, 0.0);
        EXPECT_FALSE(sky);
        return sky ? std::string() : sky.error().message;
    }
    test::TemporaryFolder folder_;
};

TEST_F(SkyFileTest, ReadsPanoramasDomesAndCrosses) {
    Image panorama = sheet({64, 32}, {0, 0, 255});
    std::fill(panorama.samples().begin() + 64 * 16, panorama.samples().end(), Rgba8{0, 255, 0});
    const auto whole = read_sky(written("whole.png", panorama), 0.0).value();
    EXPECT_GT(whole.color({0, 1, 0.3}).b, 0.9F);
    EXPECT_GT(whole.color({0, 1, -0.3}).g, 0.9F);
    const auto dome = read_sky(written("dome.png", sheet({64, 16}, {255, 0, 0})), 0.0).value();
    EXPECT_GT(dome.color({0, 1, -0.3}).r, 0.9F);
    Image cross = sheet({64, 48}, {0, 0, 0});
    for (int row = 16; row < 32; ++row) {
        std::ranges::fill(cross.row(row).subspan(32, 16), Rgba8{255, 0, 0});      // right
        std::ranges::fill(cross.row(row - 16).subspan(16, 16), Rgba8{0, 0, 255}); // up
    }
    const auto cube = read_sky(written("cross.png", cross), 0.0).value();
    EXPECT_GT(cube.color({1, 0, 0}).r, 0.9F);
    EXPECT_GT(cube.color({0, 0, 1}).b, 0.9F);
    EXPECT_LT(cube.color({0, 1, 0}).b, 0.1F);
    const auto turned = read_sky(folder_.path() / "cross.png", -90.0).value();
    EXPECT_GT(turned.color({0, 1, 0}).r, 0.9F);
}

TEST_F(SkyFileTest, ReadsAFolderOfFaces) {
    fs::create_directory(folder_.path() / "box");
    int number = 0;
    for (const char* face : {"front", "rt", "BACK", "lf", "up", "dn"}) {
        const auto grey = static_cast<std::uint8_t>(40 * ++number);
        written(std::string("box/dusk_") + face + ".png", sheet({8, 8}, {grey, grey, grey}));
    }
    written("box/cup.png", sheet({8, 8}, {255, 255, 255})); // no word
    std::ofstream(folder_.path() / "box" / "readme.txt") << "by hand\n";
    const auto sky = read_sky(folder_.path() / "box", 0.0).value();
    const auto grey = [](int value) {
        const auto byte = static_cast<std::uint8_t>(value);
        return linear_from_rgba8({byte, byte, byte}).r;
    };
    EXPECT_NEAR(sky.color({0, 1, 0}).r, grey(40), 0.005F);
    EXPECT_NEAR(sky.color({1, 0, 0}).r, grey(80), 0.005F);
    EXPECT_NEAR(sky.color({0, 0, 1}).r, grey(200), 0.005F);
    EXPECT_NEAR(sky.color({0, 0, -1}).r, grey(240), 0.005F);
    std::ofstream(folder_.path() / "box" / "._front.png") << "of another system\n";
    fs::create_directory(folder_.path() / "box" / "old_front");
    EXPECT_TRUE(read_sky(folder_.path() / "box", 0.0)) << "neither is a picture of a face";
    written("box/Skyfront.png", sheet({8, 8}, {}));
    EXPECT_THAT(error_of(folder_.path() / "box"),
                HasSubstr("Skyfront.png and dusk_front.png found"));
    fs::remove(folder_.path() / "box" / "Skyfront.png");
    fs::remove(folder_.path() / "box" / "dusk_up.png");
    EXPECT_THAT(error_of(folder_.path() / "box"), HasSubstr("no face up found"));
    written("box/dusk_up.png", sheet({8, 9}, {}));
    EXPECT_THAT(error_of(folder_.path() / "box"), HasSubstr("8 x 9 pixels found"));
}

TEST_F(SkyFileTest, OtherPicturesAreNoSkies) {
    EXPECT_THAT(error_of(written("square.png", sheet({32, 32}, {}))),
                HasSubstr("32 x 32 pixels found, a sky was expected"));
    Image photo(64, 48);
    for (int i = 0; i < 64; ++i) {
        photo(i, 7) = {255, 255, 255};
    }
    EXPECT_THAT(error_of(written("photo.png", photo)), HasSubstr("empty corners"));
    EXPECT_THAT(error_of(folder_.path() / "absent.png"), HasSubstr("absent.png"));
    std::ofstream(folder_.path() / "text.png") << "no picture\n";
    EXPECT_THAT(error_of(folder_.path() / "text.png"), HasSubstr("text.png"));
}

TEST_F(SkyFileTest, TheSmallestSkiesAreRead) {
    const auto sky = read_sky(written("two.png", sheet({2, 1}, {255, 255, 255})), 0.0).value();
    EXPECT_GT(sky.color({0.3, -0.2, 0.1}).g, 0.99F);
    EXPECT_GT(read_sky(written("four.png", sheet({4, 3}, {255, 255, 255})), 0.0)
                  .value()
                  .color({0, 0, 1})
                  .g,
              0.99F);
}

} // namespace
} // namespace reljef::io
