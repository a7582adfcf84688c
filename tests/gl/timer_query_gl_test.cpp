#include "engine/gl/timer_query.h"

#include <chrono>

#include <glad/gl.h>

#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using TimerQueryGlTest = test::GlTest;
using std::chrono::nanoseconds;
using std::chrono::steady_clock;

TEST_F(TimerQueryGlTest, no_time_before_an_end) {
    TimerQuery query = TimerQuery::create();
    EXPECT_FALSE(query.poll());
    query.begin();
    EXPECT_FALSE(query.poll());
    query.end();
    EXPECT_FALSE(TimerQuery().poll());
}

TEST_F(TimerQueryGlTest, time_is_positive_and_no_longer_than_the_wall_clock) {
    const Framebuffer target = test::float_target({256, 256});
    const Program program =
        test::cover_program("void main() { color = sin(gl_FragCoord.xyxy) * 0.5; }");
    target.bind();
    test::cover(program);
    glFinish();
    TimerQuery query = TimerQuery::create();
    const auto start = steady_clock::now();
    query.begin();
    for (int draw = 0; draw < 20; ++draw) {
        test::cover(program);
    }
    query.end();
    glFinish();
    const nanoseconds wall = steady_clock::now() - start;
    auto time = query.poll();
    while (!time && steady_clock::now() - start < std::chrono::minutes(1)) {
        time = query.poll();
    }
    ASSERT_TRUE(time);
    EXPECT_GT(*time, nanoseconds(0));
    EXPECT_LE(*time, wall);
}

TEST_F(TimerQueryGlTest, moved_from_has_no_time) {
    TimerQuery first = TimerQuery::create();
    first.begin();
    first.end();
    glFinish();
    const TimerQuery second = std::move(first);
    // NOLINTBEGIN(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
    EXPECT_FALSE(first.poll());
    EXPECT_TRUE(second.poll());
    // NOLINTEND(bugprone-use-after-move,clang-analyzer-cplusplus.Move)
}

} // namespace
} // namespace reljef::gl
