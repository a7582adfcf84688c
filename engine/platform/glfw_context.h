#pragma once

#include <memory>

#include "engine/platform/context.h"

struct GLFWwindow;

namespace reljef::platform {

/// Keeps GLFW initialized. GLFW is one per process and belongs to the main thread.
class GlfwLibrary {
public:
    GlfwLibrary(const GlfwLibrary&) = delete;
    GlfwLibrary& operator=(const GlfwLibrary&) = delete;
    ~GlfwLibrary();

    /// Fails without a display.
    static Result<std::shared_ptr<GlfwLibrary>> acquire();

private:
    GlfwLibrary() = default;
};

/// A GLFW window and its context.
class GlfwContext final : public Context {
public:
    GlfwContext(std::shared_ptr<GlfwLibrary> library, GLFWwindow* window);
    ~GlfwContext() override;

    [[nodiscard]] ContextKind kind() const override { return ContextKind::glfw; }
    [[nodiscard]] GLFWwindow* window() const { return window_; }

private:
    Result<void> bind() override;
    void unbind() override;
    [[nodiscard]] gl::GetProcAddress get_proc_address() const override;

    std::shared_ptr<GlfwLibrary> library_;
    GLFWwindow* window_;
};

/// A GlfwContext, not current yet. It may be older than 4.5; then make_current() fails.
Result<std::unique_ptr<Context>> create_glfw_context(const ContextOptions& options);

} // namespace reljef::platform
