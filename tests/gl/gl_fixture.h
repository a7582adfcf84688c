#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <gtest/gtest.h>

#include "engine/core/grid.h"
#include "engine/gl/framebuffer.h"
#include "engine/gl/program.h"
#include "engine/gl/vertex_array.h"
#include "engine/platform/context.h"

namespace reljef::test {

/// Collects the current context's errors and messages above low severity. Needs a debug context;
/// destroy while it is current.
class DebugLog {
public:
    DebugLog();
    DebugLog(const DebugLog&) = delete;
    DebugLog& operator=(const DebugLog&) = delete;
    ~DebugLog();

    [[nodiscard]] const std::vector<std::string>& problems() const { return problems_; }
    void clear() { problems_.clear(); }

private:
    std::vector<std::string> problems_;
};

/// A test with a context of its own (test_context.h); it fails when the driver reports an error or
/// anything above low severity but hints about speed.
class GlTest : public ::testing::Test {
protected:
    void SetUp() override;
    void TearDown() override;

    /// What the driver has complained about so far, and starts anew: for tests that provoke it.
    std::vector<std::string> take_problems();

    [[nodiscard]] bool draws_on_gpu() const { return !context_->is_software(); }

private:
    std::unique_ptr<platform::Context> context_;
    std::optional<DebugLog> log_;
};

/// Fails the test and aborts when there is no value.
template <class T> T must(Result<T> result) {
    if (!result) {
        ADD_FAILURE() << result.error().message;
    }
    return std::move(result).value();
}

/// The depth values, row 0 at the top.
Grid<float> read_depth(const gl::Framebuffer& framebuffer);

/// A float target of that size with depth.
gl::Framebuffer float_target(glm::ivec2 size);

/// A vertex stage that covers the target with one triangle at clip depth `uniform float depth`, and
/// the fragment stage, in which `color` is the float output. `place`: of its corners (0, 0), (1, 0)
/// and (0, 1), as vec2.
gl::Program cover_program(const std::string& fragment_body,
                          const std::string& place = "corner * 4.0 - 1.0");
/// Draws it; the program is ready to use, the target bound.
void cover(const gl::Program& program);

} // namespace reljef::test
