#include "engine/io/image/texture_files.h"

#include <array>
#include <cmath>
#include <limits>

#include <OpenImageIO/imageio.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "engine/io/image/picture_module.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef::io {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

namespace fs = std::filesystem;

// `at(col, row, channel)` in [0,1].
template <class At>
void write_channels(const fs::path& path, glm::ivec2 size, int channels, OIIO::TypeDesc type,
                    const At& at) {
    std::vector<float> values;
    for (int row = 0; row < size.y; ++row) {
        for (int col = 0; col < size.x; ++col) {
            for (int channel = 0; channel < channels; ++channel) {
                values.push_back(at(col, row, channel));
            }
        }
    }
    ASSERT_TRUE(picture_codec()); // first: it keeps the handlers of libtiff
    OIIO::ImageSpec spec(size.x, size.y, channels, type);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const auto output = OIIO::ImageOutput::create(path.string());
    ASSERT_TRUE(output && output->open(path.string(), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()));
    ASSERT_TRUE(output->close());
}

float wave_height(int col, int row) {
    return 0.5F + 0.25F * std::sin(0.19635F * static_cast<float>(col)) +
           0.25F * std::sin(0.3927F * static_cast<float>(row));
}

class TextureFilesTest : public testing::Test {
protected:
    fs::path file(const char* name) { return folder_.path() / name; }
    TextureFiles written(OIIO::TypeDesc height_type) {
        write_channels(file("a_color.png"), {32, 32}, 3, OIIO::TypeDesc::UINT8,
                       [](int, int, int) { return 0.5F; });
        write_channels(file("a_height.png"), {32, 32}, 1, height_type,
                       [](int col, int row, int) { return wave_height(col, row); });
        return {file("a_color.png"), file("a_height.png"), {}};
    }
    // Normals of the waves at scale 1, with y as the rows run or against them.
    void write_normals(const char* name, float sign) {
        Grid<float> heights(32, 32);
        for (int row = 0; row < 32; ++row) {
            for (int col = 0; col < 32; ++col) {
                heights(col, row) = wave_height(col, row);
            }
        }
        const auto normals =
            material::tile_normals(heights.view(), 0.05F, material::WrapMode::wrap);
        write_channels(file(name), {32, 32}, 3, OIIO::TypeDesc::UINT16,
                       [&](int col, int row, int channel) {
                           const float value = normals(col, row)[channel];
                           return 0.5F + 0.5F * (channel == 1 ? sign * value : value);
                       });
    }

    test::TemporaryFolder folder_;
};

TEST_F(TextureFilesTest, HeightsOf16BitsComeAsTheyAreAndWithoutANote) {
    const auto set = read_texture_set(written(OIIO::TypeDesc::UINT16));
    ASSERT_TRUE(set) << set.error().message;
    EXPECT_THAT(set->notes, IsEmpty());
    for (int i = 0; i < 32; ++i) {
        ASSERT_NEAR(set->heights(i, 7), wave_height(i, 7), 0.5 / 65535.0 + 1e-7);
    }
    EXPECT_EQ(set->normals.cols(), 32);
}

TEST_F(TextureFilesTest, HeightsOf8BitsAreToldOnceWithTheirQuantum) {
    const auto set =
        read_texture_set(written(OIIO::TypeDesc::UINT8), {.scale = 0.1F, .width = 25.5});
    ASSERT_TRUE(set);
    EXPECT_THAT(set->notes,
                testing::ElementsAre(AllOf(HasSubstr("8 bits"), HasSubstr("in steps of 0.01 m"))));
}

TEST_F(TextureFilesTest, NormalsOfEitherConventionFollowTheHeights) {
    TextureFiles files = written(OIIO::TypeDesc::UINT16);
    write_normals("down_normal.png", 1.0F);
    write_normals("up_normal.png", -1.0F);
    files.normals = file("down_normal.png");
    const auto down = read_texture_set(files);
    files.normals = file("up_normal.png");
    const auto up = read_texture_set(files);
    ASSERT_TRUE(down && up);
    const auto expected =
        material::tile_normals(down->heights.view(), 0.05F, material::WrapMode::wrap);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_LT(glm::distance(down->normals.samples()[i], expected.samples()[i]), 1e-3F);
        ASSERT_LT(glm::distance(up->normals.samples()[i], expected.samples()[i]), 1e-3F);
    }
}

TEST_F(TextureFilesTest, HeightsMayStandInTheNormalsAlpha) {
    TextureFiles files = written(OIIO::TypeDesc::UINT8);
    write_channels(file("both_normal.png"), {32, 32}, 4, OIIO::TypeDesc::UINT16,
                   [](int col, int row, int channel) {
                       return channel == 3 ? wave_height(col, row) : channel == 2 ? 1.0F : 0.5F;
                   });
    files.heights.clear();
    files.normals = file("both_normal.png");
    const auto set = read_texture_set(files);
    ASSERT_TRUE(set) << set.error().message;
    EXPECT_NEAR(set->heights(5, 9), wave_height(5, 9), 1e-4);
    EXPECT_NEAR(set->normals(5, 9).z, 1.0F, 1e-4);
}

TEST_F(TextureFilesTest, BadFilesAreOneSentence) {
    TextureFiles files = written(OIIO::TypeDesc::UINT16);
    const auto message = [](const TextureFiles& bad) {
        const auto set = read_texture_set(bad);
        EXPECT_FALSE(set);
        return set ? std::string() : set.error().message;
    };
    TextureFiles bad = files;
    bad.heights = file("none.png");
    EXPECT_THAT(message(bad), HasSubstr("none.png"));
    bad = files;
    bad.color.clear();
    EXPECT_THAT(message(bad), Not(IsEmpty()));
    bad = files;
    bad.normals = files.heights; // one channel
    EXPECT_THAT(message(bad), AllOf(HasSubstr("1 channels found"), HasSubstr("3 were expected")));
    bad = files;
    bad.heights.clear();
    EXPECT_THAT(message(bad), HasSubstr("no heights found"));
}

// Depths of four layers: a slab under another, but none in the first column.
float layer_depth(int col, int channel) {
    constexpr std::array depths{0.125F, 0.25F, 0.5F, 0.75F};
    return col == 0 ? 1.0F : depths[static_cast<std::size_t>(channel)];
}

TEST_F(TextureFilesTest, LayersAreReadAsDepthsAndSeenFromAbove) {
    TextureFiles files = written(OIIO::TypeDesc::UINT16);
    files.heights.clear();
    files.layers = file("a_layers.exr");
    write_channels(files.layers, {16, 8}, 4, OIIO::TypeDesc::FLOAT,
                   [](int col, int, int channel) { return layer_depth(col, channel); });
    const auto set = read_texture_set(files);
    ASSERT_TRUE(set) << set.error().message;
    ASSERT_TRUE(set->layers);
    EXPECT_EQ(set->layers->heights()(5, 3), glm::vec4(0.875F, 0.75F, 0.5F, 0.25F));
    EXPECT_EQ(set->heights(5, 3), 0.875F);
    EXPECT_EQ(set->heights(0, 3), 0.0F);
    const auto found = find_texture_files(folder_.path());
    ASSERT_TRUE(found);
    EXPECT_EQ(found->layers, files.layers);
}

TEST_F(TextureFilesTest, LayersOutOfOrderAreToldWithFileAndPlace) {
    TextureFiles files = written(OIIO::TypeDesc::UINT16);
    files.layers = file("a_layers.exr");
    write_channels(files.layers, {16, 8}, 4, OIIO::TypeDesc::FLOAT,
                   [](int col, int row, int channel) {
                       return col == 7 && row == 2 ? 0.9F - 0.2F * static_cast<float>(channel)
                                                   : layer_depth(col, channel);
                   });
    EXPECT_THAT(
        read_texture_set(files).error().message,
        AllOf(HasSubstr("a_layers.exr"), HasSubstr("column 7, row 2"), HasSubstr("above layer 1")));
    write_channels(files.layers, {16, 8}, 3, OIIO::TypeDesc::FLOAT,
                   [](int, int, int) { return 0.5F; });
    EXPECT_THAT(read_texture_set(files).error().message,
                AllOf(HasSubstr("3 channels found"), HasSubstr("4 were expected")));
}

TEST_F(TextureFilesTest, AMaskPunchesHolesAndABackLiesBehind) {
    TextureFiles files = written(OIIO::TypeDesc::UINT16);
    write_channels(file("a_mask.png"), {32, 32}, 1, OIIO::TypeDesc::UINT8,
                   [](int col, int, int) { return col < 16 ? 0.0F : 1.0F; });
    write_channels(file("a_back_height.png"), {32, 32}, 1, OIIO::TypeDesc::UINT16,
                   [](int, int, int) { return 0.25F; });
    files = find_texture_files(folder_.path()).value();
    EXPECT_EQ(files.heights, file("a_height.png"));
    const auto set = read_texture_set(files, {.border = material::WrapMode::clamp});
    ASSERT_TRUE(set) << set.error().message;
    EXPECT_EQ(set->heights(15, 9), 0.0F);
    EXPECT_NEAR(set->heights(16, 9), wave_height(16, 9), 1e-4);
    EXPECT_NEAR(set->back_heights(3, 3), 0.25F, 1e-4);
    write_channels(file("a_mask.png"), {8, 8}, 1, OIIO::TypeDesc::UINT8,
                   [](int, int, int) { return 1.0F; });
    EXPECT_THAT(read_texture_set(files).error().message,
                AllOf(HasSubstr("a_mask.png"), HasSubstr("8 x 8"), HasSubstr("32 x 32")));
}

TEST_F(TextureFilesTest, FoundByTheirNames) {
    written(OIIO::TypeDesc::UINT16);
    const auto files = find_texture_files(folder_.path());
    ASSERT_TRUE(files);
    EXPECT_EQ(files->color.filename(), "a_color.png");
    EXPECT_EQ(files->heights.filename(), "a_height.png");
    EXPECT_TRUE(files->normals.empty());
    fs::remove(file("a_height.png"));
    const auto missing = find_texture_files(folder_.path());
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error().message, HasSubstr("no heights found among 1 pictures"));
    EXPECT_FALSE(find_texture_files(file("nowhere")));
}

TEST(TextureRoleTest, WholeWordsOfANameSayIt) {
    for (const auto& [stem, role] : std::vector<std::pair<std::string, TextureRole>>{
             {"wall_color", TextureRole::color},
             {"WallBaseColor2", TextureRole::color},
             {"wall.col", TextureRole::color},
             {"Bricks076C_diffspec", TextureRole::color},
             {"WALL_HEIGHT", TextureRole::heights},
             {"back_wall_height", TextureRole::heights},
             {"disp01", TextureRole::heights},
             {"NormalGL", TextureRole::normals},
             {"wall-normal-height", TextureRole::normals},
             {"back wall normal", TextureRole::normals},
             {"sheet_back", TextureRole::back_heights},
             {"sheet_back_height", TextureRole::back_heights},
             {"height-back-2", TextureRole::back_heights},
             {"normal_mask", TextureRole::mask},
             {"a_layers", TextureRole::layers}}) {
        EXPECT_EQ(texture_role(stem), role) << stem;
    }
}

TEST(TextureRoleTest, PartsOfWordsSayNothing) {
    for (const char* stem : {"normandy", "collapsed", "back_wall", "backdrop", "abnormal", "masked",
                             "player", "dispatch", "columns", "alphabet", "", "076", "_-_"}) {
        EXPECT_EQ(texture_role(stem), std::nullopt) << stem;
    }
}

TEST_F(TextureFilesTest, CapitalsInAnExtensionAreSeenAndTwoFilesOfOneMapAreNot) {
    const TextureFiles files = written(OIIO::TypeDesc::UINT16);
    fs::rename(files.heights, file("a_height.PNG"));
    fs::rename(files.color, file("normandy.png"));
    const auto found = find_texture_files(folder_.path());
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found->heights, file("a_height.PNG"));
    EXPECT_EQ(found->color, file("normandy.png"));
    fs::copy(file("a_height.PNG"), file("b_disp.png"));
    const auto both = find_texture_files(folder_.path());
    ASSERT_FALSE(both);
    EXPECT_THAT(both.error().message, AllOf(HasSubstr("a_height.PNG and b_disp.png found"),
                                            HasSubstr(folder_.path().string())));
}

TEST_F(TextureFilesTest, WhatIsNoNumberIsToldWithItsFileAndFirstPlace) {
    const float none = std::nanf("");
    const auto spoilt = [&](const char* name, int channels, float value) {
        write_channels(file(name), {32, 32}, channels, OIIO::TypeDesc::FLOAT,
                       [&](int col, int row, int channel) {
                           const bool bad = row > 4 || (row == 4 && col >= 9);
                           return bad && channel == channels - 1 ? value : 0.75F;
                       });
        return file(name);
    };
    const TextureFiles files = written(OIIO::TypeDesc::UINT16);
    const auto message = [](const TextureFiles& bad) {
        const auto set = read_texture_set(bad);
        return set ? std::string() : set.error().message;
    };
    TextureFiles bad = files;
    bad.color = spoilt("c.exr", 3, none);
    EXPECT_THAT(message(bad),
                AllOf(HasSubstr("c.exr: a colour of nan"), HasSubstr("column 9, row 4")));
    bad = files;
    bad.mask = spoilt("m.exr", 1, none);
    EXPECT_THAT(message(bad),
                AllOf(HasSubstr("m.exr: a mask of nan"), HasSubstr("column 9, row 4")));
    bad = files;
    bad.heights = spoilt("h.exr", 1, 1.5F);
    EXPECT_THAT(message(bad),
                AllOf(HasSubstr("h.exr: a height of 1.5"), HasSubstr("column 9, row 4")));
    bad = files;
    bad.normals = spoilt("n.exr", 3, std::numeric_limits<float>::infinity());
    const auto set = read_texture_set(bad);
    ASSERT_TRUE(set) << set.error().message;
    EXPECT_THAT(set->notes,
                Contains(AllOf(HasSubstr("normals are"), HasSubstr("column 9, row 4"))));
    for (const glm::vec3& normal : set->normals.samples()) {
        ASSERT_NEAR(glm::length(normal), 1.0F, 1e-5F);
    }
}

class RealTextures : public testing::TestWithParam<const char*> {};

TEST_P(RealTextures, AreReadWithNormalsThatAgreeWithTheHeights) {
    const std::string name = std::string("textures/") + GetParam();
    RELJEF_NEED_DATA(name);
    const auto files = find_texture_files(test::data_path(name));
    ASSERT_TRUE(files) << files.error().message;
    const auto set = read_texture_set(*files);
    ASSERT_TRUE(set) << set.error().message;
    const auto made =
        material::tile_normals(set->heights.view(), set->scale, material::WrapMode::wrap);
    glm::dvec2 agreement(0.0);
    for (std::size_t i = 0; i < made.size() && made.size() == set->normals.size(); ++i) {
        agreement +=
            glm::dvec2(glm::vec2(made.samples()[i]) * glm::vec2(set->normals.samples()[i]));
    }
    EXPECT_GT(agreement.x, 0.0);
    EXPECT_GT(agreement.y, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Folders, RealTextures,
                         testing::Values("bricks", "rock20", "rubble", "irrlicht_rockwall"));

} // namespace
} // namespace reljef::io
