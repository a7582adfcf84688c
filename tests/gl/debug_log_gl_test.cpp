#include "engine/gl/debug_log.h"

#include <glad/gl.h>
#include <gmock/gmock.h>

#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class DebugLogGlTest : public ::testing::Test {
protected:
    void SetUp() override {
        context_ =
            test::must(platform::make_context(platform::ContextKind::osmesa, {.debug = true}));
    }

private:
    std::unique_ptr<platform::Context> context_;
};

void insert(Severity severity, const char* text) {
    const GLenum level =
        severity == Severity::high ? GL_DEBUG_SEVERITY_HIGH : GL_DEBUG_SEVERITY_LOW;
    glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_OTHER, 42, level, -1, text);
}

TEST_F(DebugLogGlTest, deliberate_error_is_caught_inside_its_call) {
    DebugLog log;
    EXPECT_THAT(log.problems(), IsEmpty());
    glEnable(GL_TEXTURE_2D_ARRAY);
    ASSERT_THAT(log.problems(), ElementsAre(HasSubstr("GL_INVALID_ENUM")));
    EXPECT_TRUE(log.messages().front().error);
    log.clear();
    EXPECT_THAT(log.messages(), IsEmpty());
}

TEST_F(DebugLogGlTest, low_severity_is_kept_but_no_problem) {
    const DebugLog log;
    insert(Severity::low, "slow");
    insert(Severity::high, "bad");
    ASSERT_EQ(log.messages().size(), 2U);
    EXPECT_EQ(log.messages().front().text, "slow");
    EXPECT_EQ(log.messages().front().id, 42U);
    EXPECT_EQ(log.messages().front().severity, Severity::low);
    EXPECT_THAT(log.problems(), ElementsAre("bad"));
}

TEST_F(DebugLogGlTest, notifications_are_left_out) {
    const DebugLog log;
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 1, -1, "group");
    glPopDebugGroup();
    EXPECT_THAT(log.messages(), IsEmpty());
}

TEST_F(DebugLogGlTest, moving_keeps_the_messages_coming) {
    DebugLog first;
    insert(Severity::high, "before");
    const DebugLog second(std::move(first));
    insert(Severity::high, "after");
    EXPECT_THAT(second.problems(), ElementsAre("before", "after"));
}

TEST_F(DebugLogGlTest, after_its_end_errors_go_nowhere) {
    { const DebugLog log; }
    glEnable(GL_TEXTURE_2D_ARRAY);
    const DebugLog next;
    EXPECT_THAT(next.messages(), IsEmpty());
}

TEST_F(DebugLogGlTest, severities_have_names) {
    EXPECT_EQ(to_string(Severity::low), "low");
    EXPECT_EQ(to_string(Severity::medium), "medium");
    EXPECT_EQ(to_string(Severity::high), "high");
}

} // namespace
} // namespace reljef::gl
