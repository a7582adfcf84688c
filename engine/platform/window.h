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

/// A window with an OpenGL 4.5 core context and user input. Main thread only.
class Window {
public:
    virtual ~Window() = default;
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// The glfw context; lives as long as the window.
    [[nodiscard]] virtual Context& context() = 0;

    /// Whether the user asked to close the window.
    [[nodiscard]] virtual bool should_close() const = 0;

    /// The events since the last call, in order. Waits at most `timeout` for the first one.
    [[nodiscard]] virtual std::vector<Event> wait_events(std::chrono::milliseconds timeout) = 0;

    /// Pixels; 0 x 0 while minimized.
    [[nodiscard]] virtual glm::ivec2 framebuffer_size() const = 0;
    /// Framebuffer pixels per unit of text and panels; 1 on usual screens, 2 on dense ones.
    [[nodiscard]] virtual double content_scale() const = 0;
    virtual void set_title(const std::string& title) = 0;
    /// Shows the back buffer; waits for the screen (vsync). Precondition: the context is current.
    virtual void swap_buffers() = 0;
    virtual void set_clipboard(const std::string& text) = 0;
    /// Hides the pointer and removes its bounds, for mouse look.
    virtual void capture_mouse(bool on) = 0;
    /// The text that the user copied last, UTF-8; empty if it is none.
    [[nodiscard]] virtual std::string clipboard() const = 0;

protected:
    Window() = default;
};

/// Opens a window and makes its context current. Fails as make_context().
Result<std::unique_ptr<Window>> make_window(const ContextOptions& options = {});

} // namespace reljef::platform
