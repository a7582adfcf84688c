#include "engine/platform/glfw_context.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace reljef::platform {

namespace {

constexpr int max_side = 16384; // X servers kill programs that ask for much more

std::string glfw_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text == nullptr ? "no reason given" : text;
}

GLFWwindow* create(const ContextOptions& options, int major, int minor) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, major);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, minor);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, options.debug ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_VISIBLE, options.visible ? GLFW_TRUE : GLFW_FALSE);
    // Framebuffer objects have the depth.
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    return glfwCreateWindow(options.size.x, options.size.y, options.title.c_str(), nullptr,
                            nullptr);
}

} // namespace

Result<std::shared_ptr<GlfwLibrary>> GlfwLibrary::acquire() {
    static std::weak_ptr<GlfwLibrary> shared;
    if (auto library = shared.lock()) {
        return library;
    }
    if (glfwInit() == GLFW_FALSE) {
        return Error{fmt::format("no display ({}), one in DISPLAY was expected", glfw_error())};
    }
    std::shared_ptr<GlfwLibrary> library(new GlfwLibrary);
    shared = library;
    return library;
}

GlfwLibrary::~GlfwLibrary() {
    glfwTerminate();
}

GlfwContext::GlfwContext(std::shared_ptr<GlfwLibrary> library, GLFWwindow* window)
    : library_(std::move(library)), window_(window) {}

GlfwContext::~GlfwContext() {
    release();
    glfwDestroyWindow(window_);
}

Result<void> GlfwContext::bind() {
    glfwMakeContextCurrent(window_);
    if (glfwGetCurrentContext() != window_) {
        return Error{fmt::format("the window's context cannot be made current ({})", glfw_error())};
    }
    return {};
}

void GlfwContext::unbind() {
    glfwMakeContextCurrent(nullptr);
}

gl::GetProcAddress GlfwContext::get_proc_address() const {
    return glfwGetProcAddress;
}

Result<std::unique_ptr<Context>> create_glfw_context(const ContextOptions& options) {
    const glm::ivec2 size = options.size;
    if (size.x < 1 || size.y < 1 || size.x > max_side || size.y > max_side) {
        return Error{
            fmt::format("window of {} x {}: expected sides of 1 to {}", size.x, size.y, max_side)};
    }
    auto library = GlfwLibrary::acquire();
    if (!library) {
        return library.error();
    }
    GLFWwindow* window = create(options, 4, 5);
    if (window == nullptr) {
        window = create(options, 3, 2);
    }
    if (window == nullptr) {
        return Error{fmt::format("the display gives neither OpenGL 4.5 nor 3.2 core ({}); install "
                                 "the package libgl1-mesa-dri or the GPU's own driver",
                                 glfw_error())};
    }
    return std::unique_ptr<Context>(std::make_unique<GlfwContext>(std::move(*library), window));
}

} // namespace reljef::platform
