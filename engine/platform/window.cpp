#include "engine/platform/window.h"

#include <algorithm>
#include <optional>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "engine/core/check.h"
#include "engine/platform/glfw_context.h"
#include "engine/platform/glfw_input.h"

namespace reljef::platform {

namespace {

glm::ivec2 size_in_pixels(GLFWwindow* window) {
    glm::ivec2 size{0, 0};
    glfwGetFramebufferSize(window, &size.x, &size.y);
    return size;
}

/// From GLFW's screen units to framebuffer pixels.
glm::dvec2 in_pixels(GLFWwindow* window, double x, double y) {
    glm::ivec2 units{0, 0};
    glfwGetWindowSize(window, &units.x, &units.y);
    const glm::dvec2 pixels(size_in_pixels(window));
    return glm::dvec2(x, y) * pixels / glm::dvec2(std::max(units.x, 1), std::max(units.y, 1));
}

struct Input {
    std::vector<Event> events;
    ClickCounter clicks;
    std::optional<glm::dvec2> pointer; // of the last move, pixels
};

Input& input_of(GLFWwindow* window) {
    return *static_cast<Input*>(glfwGetWindowUserPointer(window));
}

std::vector<Event>& queue(GLFWwindow* window) {
    return input_of(window).events;
}

// GLFW passes no modifiers with the wheel.
Modifiers held_modifiers(GLFWwindow* window) {
    const auto is_down = [window](int left, int right) {
        return glfwGetKey(window, left) == GLFW_PRESS || glfwGetKey(window, right) == GLFW_PRESS;
    };
    return {.shift = is_down(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT),
            .control = is_down(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL),
            .alt = is_down(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT),
            .super = is_down(GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER)};
}

void on_key(GLFWwindow* window, int key, int /*scancode*/, int action, int modifiers) {
    queue(window).emplace_back(KeyEvent{.key = key_from_glfw(key),
                                        .pressed = action != GLFW_RELEASE,
                                        .repeat = action == GLFW_REPEAT,
                                        .modifiers = modifiers_from_glfw(modifiers)});
}

void on_text(GLFWwindow* window, unsigned int character) {
    queue(window).emplace_back(TextEvent{static_cast<char32_t>(character)});
}

void on_mouse_move(GLFWwindow* window, double x, double y) {
    Input& input = input_of(window);
    input.pointer = in_pixels(window, x, y);
    input.events.emplace_back(MouseMoveEvent{*input.pointer});
}

// Where the pointer was at the events before. GLFW tells where it is now, perhaps far ahead of
// them.
glm::dvec2 pointer_at_event(GLFWwindow* window) {
    if (const auto& pointer = input_of(window).pointer) {
        return *pointer;
    }
    glm::dvec2 at{0.0, 0.0};
    glfwGetCursorPos(window, &at.x, &at.y);
    return in_pixels(window, at.x, at.y);
}

void on_mouse_button(GLFWwindow* window, int button, int action, int modifiers) {
    MouseButtonEvent event{.button = mouse_button_from_glfw(button),
                           .pressed = action == GLFW_PRESS,
                           .position = pointer_at_event(window),
                           .modifiers = modifiers_from_glfw(modifiers)};
    if (event.pressed) {
        event.clicks = input_of(window).clicks.press(event.button, event.position, glfwGetTime());
    }
    queue(window).emplace_back(event);
}

void on_scroll(GLFWwindow* window, double x, double y) {
    queue(window).emplace_back(ScrollEvent{{x, y}, held_modifiers(window)});
}

void on_resize(GLFWwindow* window, int width, int height) {
    queue(window).emplace_back(ResizeEvent{{width, height}});
}

// A window that was covered or hidden loses its content.
void on_refresh(GLFWwindow* window) {
    queue(window).emplace_back(ResizeEvent{size_in_pixels(window)});
}

void on_close(GLFWwindow* window) {
    queue(window).emplace_back(CloseEvent{});
}

void on_focus(GLFWwindow* window, int focused) {
    queue(window).emplace_back(FocusEvent{focused == GLFW_TRUE});
}

class GlfwWindow final : public Window {
public:
    /// Precondition: a GlfwContext.
    explicit GlfwWindow(std::unique_ptr<Context> context)
        : context_(std::move(context)), window_(window_of(*context_)) {
        glfwSetWindowUserPointer(window_, &input_);
        glfwSetKeyCallback(window_, on_key);
        glfwSetCharCallback(window_, on_text);
        glfwSetCursorPosCallback(window_, on_mouse_move);
        glfwSetMouseButtonCallback(window_, on_mouse_button);
        glfwSetScrollCallback(window_, on_scroll);
        glfwSetFramebufferSizeCallback(window_, on_resize);
        glfwSetWindowRefreshCallback(window_, on_refresh);
        glfwSetWindowCloseCallback(window_, on_close);
        glfwSetWindowFocusCallback(window_, on_focus);
        glfwSwapInterval(1);
    }

    Context& context() override { return *context_; }

    [[nodiscard]] bool should_close() const override {
        return glfwWindowShouldClose(window_) == GLFW_TRUE;
    }

    std::vector<Event> wait_events(std::chrono::milliseconds timeout) override {
        if (input_.events.empty() && timeout.count() > 0) {
            glfwWaitEventsTimeout(std::chrono::duration<double>(timeout).count());
        }
        glfwPollEvents();
        return std::exchange(input_.events, {});
    }

    [[nodiscard]] glm::ivec2 framebuffer_size() const override { return size_in_pixels(window_); }
    [[nodiscard]] double content_scale() const override {
        float x = 1.0F;
        float y = 1.0F;
        glfwGetWindowContentScale(window_, &x, &y);
        return std::max(1.0F, std::max(x, y)); // some displays report less than they need
    }
    void set_title(const std::string& title) override {
        glfwSetWindowTitle(window_, title.c_str());
    }
    void swap_buffers() override { glfwSwapBuffers(window_); }
    void set_clipboard(const std::string& text) override {
        glfwSetClipboardString(window_, text.c_str());
    }
    void capture_mouse(bool on) override {
        input_.pointer.reset(); // it is elsewhere then
        glfwSetInputMode(window_, GLFW_CURSOR, on ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    }
    [[nodiscard]] std::string clipboard() const override {
        const char* const text = glfwGetClipboardString(window_);
        return text == nullptr ? std::string() : text;
    }

private:
    static GLFWwindow* window_of(Context& context) {
        auto* owner = dynamic_cast<GlfwContext*>(&context);
        check(owner != nullptr, "a window without a GLFW context");
        return owner->window();
    }

    Input input_;
    std::unique_ptr<Context> context_;
    GLFWwindow* window_;
};

} // namespace

Result<std::unique_ptr<Window>> make_window(const ContextOptions& options) {
    auto context = make_context(ContextKind::glfw, options);
    if (!context) {
        return context.error();
    }
    return std::unique_ptr<Window>(std::make_unique<GlfwWindow>(std::move(*context)));
}

} // namespace reljef::platform
