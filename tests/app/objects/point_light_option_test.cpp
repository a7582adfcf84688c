#include "app/objects/point_light_option.h"

#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

using testing::HasSubstr;

TEST(PointLightOption, ReadsAPlaceAndALight) {
    const auto light =
        parse_point_light("46.5,-7.25:height=-3,intensity=4e4,range=2000,color=#FFcc88");
    ASSERT_TRUE(light) << light.error().message;
    EXPECT_EQ(light->at, glm::dvec2(46.5, -7.25));
    EXPECT_EQ(light->height, -3.0);
    EXPECT_EQ(light->intensity, 4e4);
    EXPECT_EQ(light->range, 2000.0);
    EXPECT_EQ(light->color, (Rgba8{255, 204, 136, 255}));
    const auto plain = parse_point_light("1,2");
    ASSERT_TRUE(plain) << plain.error().message;
    EXPECT_EQ(plain->height, 5.0);
    EXPECT_EQ(plain->color, (Rgba8{255, 255, 255, 255}));
    EXPECT_EQ(io::range_of(*plain), 50.0) << "where 25 are 1 % of white";
}

TEST(PointLightOption, WritesWhatItReads) {
    for (const std::string text : {"46.5,-7.25:height=5,intensity=25,color=#ffffff",
                                   "-1,2:height=0.125,intensity=40000,range=2000,color=#ffcc08"}) {
        EXPECT_EQ(to_text(parse_point_light(text).value()), text);
    }
}

TEST(PointLightOption, NamesWhatIsWrong) {
    const std::vector<std::pair<std::string, std::string>> wrong{
        {"", "'' found, LAT,LON in degrees"},
        {"1", "'1' found"},
        {"1,2,3", "'1,2,3' found"},
        {"nan,2", "'nan,2' found"},
        {"1e30,2", "'1e30,2' found, at most"},
        {"1,2:height=1e9", "height: '1e9' found"},
        {"1,2:height=1,height=2", "height found twice"},
        {"1,2:intensity=0", "intensity: '0' found, a number above 0 and at most"},
        {"1,2:intensity=inf", "intensity: 'inf' found"},
        {"1,2:range=-5", "range: '-5' found"},
        {"1,2:color=red", "color 'red' found, a color such as #ffcc88"},
        {"1,2:color=#ffcc8", "color '#ffcc8' found"},
        {"1,2:color=#ffcc8g", "color '#ffcc8g' found"},
        {"1,2:size=3", "'size' found, height, intensity, range or color"}};
    for (const auto& [text, part] : wrong) {
        const auto refused = parse_point_light(text);
        ASSERT_FALSE(refused) << text;
        EXPECT_THAT(refused.error().message, HasSubstr(part));
        EXPECT_THAT(refused.error().message, HasSubstr("--point-light"));
        EXPECT_THAT(refused.error().message, HasSubstr("expected")) << text;
    }
}

// The pictures of a scene file and of the option are the same, also beside a negative place.
TEST(PointLightsInPictures, ComeFromOptionsAndSceneFiles) {
    const test::TemporaryFolder folder;
    const std::filesystem::path scene = folder.write(
        "lit.toml", "[terrain]\ngenerator = \"natural\"\nsize = 65\n[sun]\naltitude = -8\n"
                    "[[point_light]]\nat = [-20, 30]\nintensity = 1e6\nrange = 900\n"
                    "color = \"#ffcc88\"\nheight = 60\n");
    const std::filesystem::path dark =
        folder.write("dark.toml", "[terrain]\ngenerator = \"natural\"\nsize = 65\n"
                                  "[sun]\naltitude = -8\n");
    const auto draw = [&](const std::vector<std::string>& arguments, const std::string& name) {
        std::vector<std::string> all{"render"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        for (const std::string part : {"--context", "cpu", "--size", "64x48", "-o"}) {
            all.push_back(part);
        }
        all.push_back((folder.path() / name).string());
        const test::ProgramResult drawn = test::reljef(all);
        EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
        return io::read_image(folder.path() / name).value();
    };
    const Image from_file = draw({scene.string()}, "a.png");
    EXPECT_EQ(draw({dark.string(), "--point-light",
                    "-20,30:intensity=1e6,range=900,color=#ffcc88,height=60"},
                   "b.png"),
              from_file);
    EXPECT_NE(draw({dark.string()}, "c.png"), from_file);
}

TEST(PointLightsInPictures, NotesOnceThatSomeAreLeftOut) {
    const test::TemporaryFolder folder;
    const auto notes_of = [&](int lamps) {
        std::vector<std::string> arguments{"render",    test::small_terrain(folder, "natural"),
                                           "--context", "cpu",
                                           "--size",    "32x24",
                                           "-o",        (folder.path() / "a.png").string(),
                                           "--light",   "90,20"};
        for (int i = 1; i < lamps; ++i) {
            arguments.insert(arguments.end(), {"--point-light", fmt::format("{},0", i)});
        }
        const test::ProgramResult drawn = test::reljef(arguments);
        EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
        return test::without_progress(drawn.err);
    };
    EXPECT_THAT(
        notes_of(17),
        HasSubstr("of 17 lights besides the sun, each picture shows the 16 brightest at the eye"));
    EXPECT_THAT(notes_of(16), testing::Not(HasSubstr("lights besides")));
}

} // namespace
} // namespace reljef::app
