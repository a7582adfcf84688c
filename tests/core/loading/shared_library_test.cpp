#include "engine/core/loading/shared_library.h"

#include <array>
#include <cstddef>

#include <gmock/gmock.h>

namespace reljef {
namespace {

TEST(SharedLibraryTest, the_first_that_opens_is_taken) {
    constexpr std::array<const char*, 2> names{"libno_such_library.so.9", "libm.so.6"};
    const auto library = open_library(names);
    ASSERT_TRUE(library) << library.error().message;
    double (*cosine)(double) = nullptr;
    ASSERT_TRUE(load(*library, cosine, "cos"));
    EXPECT_EQ(cosine(0.0), 1.0);
    EXPECT_FALSE(load(*library, cosine, "no_such_function"));
}

TEST(SharedLibraryTest, none_is_an_error_that_names_the_first) {
    constexpr std::array<const char*, 2> names{"libno_such_library.so.9", "libno_other.so"};
    const auto library = open_library(names);
    ASSERT_FALSE(library);
    EXPECT_THAT(library.error().message, ::testing::HasSubstr("libno_such_library.so.9"));
}

} // namespace
} // namespace reljef
