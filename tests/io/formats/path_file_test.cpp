#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/formats/flight_file.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;

Result<std::vector<PathKey>> read(const std::string& text) {
    const test::TemporaryFolder folder;
    auto flight = read_flight(folder.write("path.toml", text));
    return flight ? Result<std::vector<PathKey>>(std::get<std::vector<PathKey>>(flight->keys))
                  : flight.error();
}

std::string key(double time, const std::string& rest = "eye = [1, 2, 3]\nlook = [0, 0, 0]\n") {
    return "[[key]]\ntime = " + std::to_string(time) + "\n" + rest;
}

TEST(PathFile, KeysAreReadInOrder) {
    const auto keys = read(key(0.0) + key(2.5, "eye = [4.5, 5, 6]\nlook = [7, 8, -9]\n"));
    ASSERT_TRUE(keys) << keys.error().message;
    ASSERT_EQ(keys->size(), 2U);
    EXPECT_EQ((*keys)[0].time, 0.0);
    EXPECT_EQ((*keys)[1].time, 2.5);
    EXPECT_EQ((*keys)[1].eye, glm::dvec3(4.5, 5.0, 6.0));
    EXPECT_EQ((*keys)[1].target, glm::dvec3(7.0, 8.0, -9.0));
}

TEST(PathFile, WhatIsWrongIsNamedWithItsLine) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"", "has 0 tables [[key]], 1 to 100000 were expected"},
        {"key = 3", "key is 3, tables [[key]] were expected"},
        {"[key]\ntime = 1", "key is a table"},
        {"[[key]]\ntime = 1\n", "[[key]] eye is missing"},
        {key(0.0) + key(0.0), "path.toml:6: [[key]] time is 0, a time after"},
        {key(3.0) + key(1.0), "a time after the last one's 3 was expected"},
        {key(0.0, "eye = [1, 2, nan]\nlook = [0, 0, 0]"), "eye is [1, 2, nan], three numbers"},
        {key(0.0, "eye = [0, 0, 0]\nlook = [0, 0, 0]"), "look is where eye is"},
        {key(0.0) + "roll = 3", "roll is unknown, one of time, eye, look was expected"},
        {"speed = 3\n" + key(0.0), "speed is unknown"},
        {"[[key]\n", "is no TOML"}};
    for (const auto& [text, words] : cases) {
        const auto keys = read(text);
        ASSERT_FALSE(keys) << text;
        EXPECT_THAT(keys.error().message, HasSubstr("path.toml")) << text;
        EXPECT_THAT(keys.error().message, HasSubstr(words)) << text;
    }
}

TEST(PathFile, MoreThanAHundredThousandKeysAreRefused) {
    std::string text;
    for (int i = 0; i < 100001; ++i) {
        text += "[[key]]\ntime=" + std::to_string(i) + "\neye=[0,0,1]\nlook=[0,0,0]\n";
    }
    const auto keys = read(text);
    ASSERT_FALSE(keys);
    EXPECT_THAT(keys.error().message, HasSubstr("has 100001 tables"));
}

TEST(PathFile, MissingIsAnError) {
    EXPECT_FALSE(read_flight("none/path.toml"));
}

} // namespace
} // namespace reljef::io
