#include "engine/platform/egl_context.h"

#include <vector>

#include <fmt/format.h>

#include "engine/platform/egl_library.h"

namespace reljef::platform {

namespace {

constexpr std::string_view packages =
    "install the packages libegl1, libegl-mesa0 and libgl1-mesa-dri, or the GPU's own driver";

EGLContext create(const Egl& egl, EGLDisplay display, const std::vector<EGLint>& attributes) {
    return egl.create_context(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
}

// If the driver can, it tells when it gives the context up (gl::is_context_lost).
EGLContext create(const Egl& egl, EGLDisplay display, int major, int minor, bool debug) {
    const std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                         major,
                                         EGL_CONTEXT_MINOR_VERSION,
                                         minor,
                                         EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                         EGL_CONTEXT_OPENGL_DEBUG,
                                         debug ? EGL_TRUE : EGL_FALSE,
                                         EGL_NONE};
    std::vector<EGLint> telling = attributes;
    telling.insert(telling.end() - 1,
                   {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
    const EGLContext context = create(egl, display, telling);
    return context != EGL_NO_CONTEXT ? context : create(egl, display, attributes);
}

/// OpenGL 4.5, else 3.2, so that make_current() can report the version.
Result<EGLContext> create(const Egl& egl, EGLDisplay display, bool debug) {
    // All users of the process share a display: it is never terminated.
    if (egl.initialize(display, nullptr, nullptr) == EGL_FALSE) {
        return Error{fmt::format("eglInitialize failed with 0x{:04x}", egl.get_error())};
    }
    const char* extensions = egl.query_string(display, EGL_EXTENSIONS);
    for (const char* needed : {"EGL_KHR_no_config_context", "EGL_KHR_surfaceless_context"}) {
        if (!has_extension(extensions, needed)) {
            return Error{fmt::format("the driver lacks {}", needed)};
        }
    }
    if (egl.bind_api(EGL_OPENGL_API) == EGL_FALSE) {
        return Error{"the driver offers no desktop OpenGL"};
    }
    EGLContext context = create(egl, display, 4, 5, debug);
    if (context == EGL_NO_CONTEXT) {
        context = create(egl, display, 3, 2, debug);
    }
    if (context == EGL_NO_CONTEXT) {
        return Error{fmt::format("the driver gives neither OpenGL 4.5 nor 3.2 core (0x{:04x})",
                                 egl.get_error())};
    }
    return context;
}

class EglContext final : public Context {
public:
    EglContext(const Egl& egl, EGLDisplay display, EGLContext context)
        : egl_(egl), display_(display), context_(context) {}
    ~EglContext() override {
        release();
        egl_.destroy_context(display_, context_);
    }

    [[nodiscard]] ContextKind kind() const override { return ContextKind::egl; }

private:
    Result<void> bind() override {
        egl_.bind_api(EGL_OPENGL_API);
        if (egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
            return Error{fmt::format("eglMakeCurrent failed with 0x{:04x}", egl_.get_error())};
        }
        return {};
    }

    void unbind() override {
        egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }

    [[nodiscard]] gl::GetProcAddress get_proc_address() const override {
        return egl_.get_proc_address;
    }

    Egl egl_;
    EGLDisplay display_;
    EGLContext context_;
};

} // namespace

Result<std::unique_ptr<Context>> create_egl_context(const ContextOptions& options,
                                                    EglDevices devices) {
    const auto egl = open_egl();
    if (!egl) {
        return egl.error();
    }
    std::string reason = "there is no device";
    for (const EglCandidate& candidate : egl_candidates(*egl)) {
        if (devices == EglDevices::hardware && !candidate.hardware) {
            continue;
        }
        const auto context = create(*egl, candidate.display, options.debug);
        if (context) {
            return std::unique_ptr<Context>(
                std::make_unique<EglContext>(*egl, candidate.display, *context));
        }
        reason = context.error().message;
    }
    return Error{fmt::format("no EGL display without a window system: {}; {}", reason, packages)};
}

} // namespace reljef::platform
