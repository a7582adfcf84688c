#pragma once

#include <memory>

#include "engine/platform/context.h"

struct GLFWwindow;

namespace reljef::platform {

/// Keeps GLFW initialized as long as one of them lives. GLFW is one per process and belongs to the
/// main thread.
class GlfwLibrary {
public:
    GlfwLibrary(const GlfwLibrary&) = delete;
    GlfwLibrary& operator=(const GlfwLibrary&) = delete;
    ~GlfwLibrary();

    /// Fails when there is no display.
    static Result<std::shared_ptr<GlfwLibrary>> acquire();

private:
    GlfwLibrary() = default;
};

/// The context of a GLFW window, and the window.
class GlfwContext final : public Context {
public:
    GlfwContext(std::shared_ptr<GlfwLibrary> library, GLFWwindow* window);
    GlfwContext(const GlfwContext&) = delete;
    GlfwContext& operator=(const GlfwContext&) = delete;
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

/// A window with a context, not current yet. It may be older than 4.5 where there is nothing
/// better; make_current() then says so.
Result<std::unique_ptr<GlfwContext>> create_glfw_context(const ContextOptions& options);

} // namespace reljef::platform
