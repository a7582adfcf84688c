#include "engine/gl/functions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/platform/context.h"

namespace reljef::gl {
namespace {

auto nothing(const char* /*name*/) -> void (*)() {
    return nullptr;
}

TEST(FunctionsGlTest, a_library_without_functions_is_an_error) {
    const auto loaded = load_functions(nothing);
    ASSERT_FALSE(loaded);
    EXPECT_THAT(loaded.error().message, ::testing::HasSubstr("expected OpenGL 4.5 core"));
}

TEST(FunctionsGlTest, the_table_recovers_with_the_next_context) {
    ASSERT_FALSE(load_functions(nothing));
    EXPECT_TRUE(platform::make_context(platform::ContextKind::osmesa));
}

} // namespace
} // namespace reljef::gl
