#include "app/cli/options.h"

#include <gtest/gtest.h>

#include "app/cli/parsed_option.h"

namespace reljef::app {
namespace {

TEST(ParseSize, takes_two_sides) {
    const auto size = cli::parse_size("1024x768");
    ASSERT_TRUE(size);
    EXPECT_EQ(*size, glm::ivec2(1024, 768));
}

TEST(ParseSize, refuses_what_is_no_size) {
    for (const char* text : {"", "x", "1024", "1024x", "x768", "1024x768x3", "-1x5", "0x5",
                             "5x16385", "1e3x5", " 5x5", "99999999999x5"}) {
        EXPECT_FALSE(cli::parse_size(text)) << text;
    }
}

TEST(ParseNumbers, takes_exactly_as_many_as_asked_for) {
    const auto numbers = cli::parse_numbers<3>("--eye", "1,-2.5,3e2", "x,y,z");
    ASSERT_TRUE(numbers);
    EXPECT_EQ((*numbers)[1], -2.5);
    for (const char* text : {"", "1,2", "1,2,3,4", "1,2,", ",1,2", "1,2,x", "1,2,nan", "1,2,inf"}) {
        EXPECT_FALSE(cli::parse_numbers<3>("--eye", text, "x,y,z")) << text;
    }
}

} // namespace
} // namespace reljef::app
