#include "app/objects/light_option.h"

#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::app {
namespace {

using testing::HasSubstr;

TEST(LightOption, ReadsADirectionAndALight) {
    const auto light = parse_light("-90,30.5:intensity=2,color=#FFcc88");
    ASSERT_TRUE(light) << light.error().message;
    EXPECT_EQ(light->azimuth, -90.0);
    EXPECT_EQ(light->altitude, 30.5);
    EXPECT_EQ(light->intensity, 2.0);
    EXPECT_EQ(light->color, (Rgba8{255, 204, 136, 255}));
    const auto plain = parse_light("265,0");
    ASSERT_TRUE(plain) << plain.error().message;
    EXPECT_EQ(plain->intensity, 0.5);
}

TEST(LightOption, WritesWhatItReads) {
    for (const std::string text :
         {"46.5,7.25:intensity=0.5,color=#ffffff", "-1,90:intensity=1000,color=#ffcc08"}) {
        EXPECT_EQ(to_text(parse_light(text).value()), text);
    }
}

TEST(LightOption, NamesWhatIsWrong) {
    const std::vector<std::pair<std::string, std::string>> wrong{
        {"", "'' found, AZIMUTH,ALTITUDE"},
        {"1", "'1' found"},
        {"1,2,3", "'1,2,3' found"},
        {"nan,2", "'nan,2' found"},
        {"361,2", "azimuth 361 found, -360 to 360"},
        {"1,-1", "altitude -1 found, 0 to 90"},
        {"1,91", "altitude 91 found"},
        {"1,2:intensity=0", "intensity: '0' found, a number above 0 and at most"},
        {"1,2:intensity=1001", "intensity: '1001' found"},
        {"1,2:color=red", "color 'red' found, a color such as #ffcc88"},
        {"1,2:range=3", "'range' found, intensity or color"},
        {"1,2:", "'' found, intensity or color"}};
    for (const auto& [text, part] : wrong) {
        const auto refused = parse_light(text);
        ASSERT_FALSE(refused) << text;
        EXPECT_THAT(refused.error().message, HasSubstr(part));
        EXPECT_THAT(refused.error().message, HasSubstr("--light"));
        EXPECT_THAT(refused.error().message, HasSubstr("expected")) << text;
    }
}

} // namespace
} // namespace reljef::app
