#include "app/viewer/timing/time_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace reljef::app {
namespace {

using testing::HasSubstr;
using testing::Not;

TimeReport made_report() {
    TimeReport report;
    report.first_picture = 0.25;
    report.rows = {{"panels", "panels, of each frame", {1.0, 3.0, 2.0}, {}},
                   {"keys", "answers to keys and mouse", {20.0}, 1},
                   {"controls", "answers of controls", {}, {}}};
    return report;
}

TEST(TimeReport, IsATableWithoutEmptyRows) {
    const std::string text = text_of(made_report());
    EXPECT_THAT(text, HasSubstr("0.250 s after the program began"));
    EXPECT_THAT(text, HasSubstr("complete picture            not shown"));
    EXPECT_THAT(text,
                testing::ContainsRegex("panels, of each frame +3 +2\\.000 +2\\.980 +3\\.000"));
    EXPECT_THAT(text, testing::ContainsRegex("answers to keys and mouse +1 .* 1\n"));
    EXPECT_THAT(text, Not(HasSubstr("controls")));
}

TEST(TimeReport, IsJsonWithAMemberForEachRow) {
    const auto json = nlohmann::json::parse(json_of(made_report()));
    EXPECT_EQ(json["first_picture_s"], 0.25);
    EXPECT_TRUE(json["complete_picture_s"].is_null());
    EXPECT_EQ(json["panels"]["count"], 3);
    EXPECT_EQ(json["panels"]["median_ms"], 2.0);
    EXPECT_EQ(json["panels"]["max_ms"], 3.0);
    EXPECT_FALSE(json["panels"].contains("max_frames"));
    EXPECT_EQ(json["keys"]["max_frames"], 1);
    EXPECT_EQ(json["controls"], nlohmann::json({{"count", 0}}));
}

} // namespace
} // namespace reljef::app
