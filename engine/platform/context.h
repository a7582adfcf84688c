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
    bool debug = false; ///< a debug context, see gl::DebugLog
    glm::ivec2 size{1024,
                    768}; ///< of the window; headless contexts draw to framebuffer objects only
    std::string title = "reljef"; ///< of the window
    bool visible = true;          ///< of the window
};

/// A current OpenGL 4.5 core context. Create, use and destroy on one thread; those of kind glfw on
/// the main thread. Its GL objects must be gone before it is.
class Context {
public:
    virtual ~Context() = default;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    [[nodiscard]] virtual ContextKind kind() const = 0;
    /// Makes this context current on the calling thread and loads its functions; needed only when
    /// another one was made, made current or destroyed since.
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
    virtual Result<void> bind() = 0; ///< while no other one is current
    virtual void unbind() = 0;
    [[nodiscard]] virtual gl::GetProcAddress get_proc_address() const = 0;

    std::string renderer_;
    std::string version_;
};

/// Makes a context of the kind and makes it current. Fails with one sentence: which context, which
/// version was found, what to install.
Result<std::unique_ptr<Context>> make_context(ContextKind kind, const ContextOptions& options = {});

/// For rendering without a window: EGL where it finds a hardware GPU, else OSMesa.
Result<std::unique_ptr<Context>> make_headless_context(const ContextOptions& options = {});

} // namespace reljef::platform
