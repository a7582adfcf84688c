#include "engine/io/formats/ramp_file.h"

#include <sys/stat.h>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

std::string ramp_error(std::string_view text) {
    const auto ramp = parse_ramp(text, "a.txt");
    return ramp ? "" : ramp.error().message;
}

TEST(RampFile, ReadsWhatGdaldemReads) {
    const auto ramp = parse_ramp("# heights\n"
                                 "\n"
                                 "0 10 20 30\n"
                                 "1200.5,1,2,3,255\r\n"
                                 "40%: white\n"
                                 "-5\tBlue # deep\n"
                                 "nv 7 8 9 0",
                                 "a.txt");
    ASSERT_TRUE(ramp) << ramp.error().message;
    ASSERT_EQ(ramp->stops.size(), 4U);
    EXPECT_EQ(ramp->stops[0].color, glm::vec3(10.0F, 20.0F, 30.0F));
    EXPECT_EQ(ramp->stops[1].height, 1200.5);
    EXPECT_TRUE(ramp->stops[2].is_share);
    EXPECT_EQ(ramp->stops[2].height, 0.4);
    EXPECT_EQ(ramp->stops[3].color, glm::vec3(0.0F, 0.0F, 255.0F));
    EXPECT_EQ(ramp->no_data, (Rgba8{7, 8, 9, 255}));
}

TEST(RampFile, NamesTheFileAndTheLineOfAMistake) {
    EXPECT_EQ(ramp_error("0 1 2 3\n\n100 1 2\n"),
              "a.txt, line 3: '100 1 2' found, a height and a colour (red, green and blue from 0 "
              "to 255, or a name) was expected");
    EXPECT_NE(ramp_error("high 1 2 3").find("line 1: 'high 1 2 3'"), std::string::npos);
    EXPECT_NE(ramp_error("0 1 2 300").find("line 1"), std::string::npos);
    EXPECT_NE(ramp_error("120% 1 2 3").find("0% to 100%"), std::string::npos);
    EXPECT_NE(ramp_error("0 puce").find("line 1"), std::string::npos);
    EXPECT_NE(ramp_error("nan 1 2 3").find("line 1"), std::string::npos);
    EXPECT_NE(ramp_error("# nothing\n").find("at least one was expected"), std::string::npos);
    EXPECT_FALSE(read_ramp_file("/nowhere/a.txt"));
    const test::TemporaryFolder folder;
    const auto pipe = folder.path() / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_FALSE(read_ramp_file(pipe)) << "a pipe that nobody writes would never end";
    EXPECT_FALSE(read_ramp_file("/"));
}

TEST(RampFile, MayBeginWithAByteOrderMark) {
    EXPECT_TRUE(parse_ramp("\xEF\xBB\xBF"
                           "0 red\n",
                           "a.txt"));
}

} // namespace
} // namespace reljef::io
