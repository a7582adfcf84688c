#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/event.h"
#include "engine/core/result.h"
#include "engine/platform/context.h"

namespace reljef::platform {

/// A window with an OpenGL 4.5 core context and the user's input. Main thread only.
class Window {
public:
    virtual ~Window() = default;
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Of kind glfw; lives as long as the window.
    [[nodiscard]] virtual Context& context() = 0;

    /// Whether the user or request_close() asked to close it.
    [[nodiscard]] virtual bool should_close() const = 0;
    virtual void request_close() = 0;

    /// What happened since the last call, in order; does not wait.
    [[nodiscard]] virtual std::vector<Event> poll_events() = 0;
    /// The same, waiting for the first event for at most `timeout`.
    [[nodiscard]] virtual std::vector<Event> wait_events(std::chrono::milliseconds timeout) = 0;

    /// Pixels; 0 by 0 while minimized.
    [[nodiscard]] virtual glm::ivec2 framebuffer_size() const = 0;
    virtual void set_title(const std::string& title) = 0;
    /// Shows what was drawn to, or blitted onto, the window's back buffer. The context is current.
    virtual void swap_buffers() = 0;
    /// Whether swap_buffers() waits for the screen; on at first. The context is current.
    virtual void set_vsync(bool on) = 0;
    /// Hides the pointer and lets it move without bounds, for mouse look.
    virtual void capture_mouse(bool on) = 0;

protected:
    Window() = default;
};

/// Opens a window of options.size screen units and makes its context current. Fails with one
/// sentence as make_context() does.
Result<std::unique_ptr<Window>> make_window(const ContextOptions& options = {});

} // namespace reljef::platform
