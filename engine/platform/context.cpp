#include "engine/platform/context.h"

#include <utility>

#include <fmt/format.h>

#include "engine/core/check.h"
#include "engine/gl/limits.h"
#include "engine/platform/egl_context.h"
#include "engine/platform/glfw_context.h"
#include "engine/platform/osmesa_context.h"

namespace reljef::platform {

namespace {

// GL itself keeps one current context a thread. Its owner is remembered, because the libraries do
// not release each other's: GLX and EGL refuse a thread that has a context of the other.
thread_local Context* current_context = nullptr;

/// The one that was current, for later.
Context* leave_current() {
    Context* previous = current_context;
    if (previous != nullptr) {
        previous->release();
    }
    return previous;
}

Error in_context(ContextKind kind, const Error& error) {
    return Error{fmt::format("context {}: {}", to_string(kind), error.message)};
}

std::string_view newer_driver(ContextKind kind) {
    return kind == ContextKind::osmesa
               ? "install the package libosmesa6 of Debian 12 or newer"
               : "install the package libgl1-mesa-dri or the GPU's own driver, or use --context "
                 "osmesa";
}

using MadeContext = Result<std::unique_ptr<Context>>;

MadeContext create(ContextKind kind, const ContextOptions& options) {
    switch (kind) {
    case ContextKind::osmesa:
        return create_osmesa_context();
    case ContextKind::egl:
        return create_egl_context(options);
    case ContextKind::glfw: {
        auto context = create_glfw_context(options);
        if (!context) {
            return context.error();
        }
        return std::unique_ptr<Context>(std::move(*context));
    }
    }
    abort_with("unknown kind of context");
}

/// Makes a context and makes it current; on failure the one that was current is so again. None may
/// be current meanwhile: GLFW makes a new window's context current for a moment.
template <class Maker> MadeContext make_with(Context* previous, const Maker& maker) {
    MadeContext made = maker();
    if (made) {
        const auto current = (*made)->make_current();
        if (current) {
            return made;
        }
        made = current.error();
    }
    if (previous != nullptr) {
        static_cast<void>(previous->make_current());
    }
    return made;
}

} // namespace

std::string_view to_string(ContextKind kind) {
    switch (kind) {
    case ContextKind::osmesa:
        return "osmesa";
    case ContextKind::egl:
        return "egl";
    case ContextKind::glfw:
        return "glfw";
    }
    abort_with("unknown kind of context");
}

std::optional<ContextKind> context_kind_from_string(std::string_view text) {
    for (const ContextKind kind : {ContextKind::osmesa, ContextKind::egl, ContextKind::glfw}) {
        if (text == to_string(kind)) {
            return kind;
        }
    }
    return std::nullopt;
}

bool Context::is_current() const {
    return current_context == this;
}

void Context::release() {
    if (is_current()) {
        unbind();
        current_context = nullptr;
    }
}

Result<void> Context::make_current() {
    leave_current();
    if (const auto bound = bind(); !bound) {
        return in_context(kind(), bound.error());
    }
    current_context = this;
    if (const auto loaded = gl::load_functions(get_proc_address()); !loaded) {
        release();
        return in_context(
            kind(), Error{fmt::format("{}; {}", loaded.error().message, newer_driver(kind()))});
    }
    const gl::Limits limits = gl::query_limits();
    renderer_ = limits.renderer;
    version_ = limits.version;
    return {};
}

bool Context::is_software() const {
    for (const std::string_view rasterizer : {"llvmpipe", "softpipe", "swrast", "SWR"}) {
        if (renderer_.find(rasterizer) != std::string::npos) {
            return true;
        }
    }
    return false;
}

Result<std::unique_ptr<Context>> make_context(ContextKind kind, const ContextOptions& options) {
    return make_with(leave_current(), [&]() -> MadeContext {
        auto made = create(kind, options);
        if (!made) {
            return in_context(kind, made.error());
        }
        return made;
    });
}

Result<std::unique_ptr<Context>> make_headless_context(const ContextOptions& options) {
    auto egl = make_with(leave_current(),
                         [&] { return create_egl_context(options, EglDevices::hardware); });
    if (egl && !(*egl)->is_software()) {
        return egl;
    }
    auto osmesa = make_context(ContextKind::osmesa, options);
    if (osmesa || !egl) {
        return osmesa;
    }
    return egl;
}

} // namespace reljef::platform
