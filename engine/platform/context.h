#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/gl/functions.h"

namespace reljef::platform {

enum class ContextKind { osmesa, egl, glfw };

/// "osmesa", "egl", "glfw".
std::string_view to_string(ContextKind kind);
std::optional<ContextKind> context_kind_from_string(std::string_view text);

struct ContextOptions {
    bool debug = false; ///< a GL debug context
    // Of the window; headless contexts draw to framebuffer objects only.
    glm::ivec2 size{1024, 768}; ///< screen units
    std::string title = "reljef";
    bool visible = true;
};

/// An OpenGL 4.5 core context. Create, use and destroy it on one thread; glfw: on the main thread.
/// Destroy its GL objects first.
class Context {
public:
    virtual ~Context() = default;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    [[nodiscard]] virtual ContextKind kind() const = 0;
    /// Makes this context current on the calling thread and loads its functions. Needed only after
    /// another context was made, made current or destroyed.
    Result<void> make_current();
    [[nodiscard]] bool is_current() const;
    /// Leaves the thread without a context if this one is current.
    void release();

    [[nodiscard]] const std::string& renderer() const { return renderer_; } ///< GL_RENDERER
    [[nodiscard]] const std::string& version() const { return version_; }   ///< GL_VERSION
    /// Whether the renderer is a CPU rasterizer (llvmpipe, softpipe, swrast).
    [[nodiscard]] bool is_software() const;

protected:
    Context() = default;

private:
    virtual Result<void> bind() = 0; ///< precondition: no other context is current
    virtual void unbind() = 0;
    [[nodiscard]] virtual gl::GetProcAddress get_proc_address() const = 0;

    std::string renderer_;
    std::string version_;
};

/// Whether GL_RENDERER names a CPU rasterizer (llvmpipe, softpipe, swrast).
bool is_software_renderer(std::string_view renderer);

/// What draws, for reports.
struct RendererInfo {
    std::string renderer;
    std::string version;
    std::string context; ///< as on the command line
    bool is_software = true;
};
RendererInfo info_of(const Context& context);

/// Makes a context and makes it current. Fails with the kind, the found version and the packages to
/// install.
Result<std::unique_ptr<Context>> make_context(ContextKind kind, const ContextOptions& options = {});

/// An EGL context on a hardware GPU. Fails without one.
Result<std::unique_ptr<Context>> make_gpu_context(const ContextOptions& options = {});

/// A context without a window: EGL on a hardware GPU if there is one, else OSMesa.
Result<std::unique_ptr<Context>> make_headless_context(const ContextOptions& options = {});

} // namespace reljef::platform
