#include "engine/platform/context.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "engine/core/check.h"
#include "engine/gl/limits.h"
#include "engine/platform/egl_context.h"
#include "engine/platform/glfw_context.h"
#include "engine/platform/osmesa_context.h"

namespace reljef::platform {

namespace {

// The libraries do not release each other's contexts: GLX and EGL refuse a thread on which the
// other has a current context.
thread_local Context* current_context = nullptr;

constexpr std::array<std::string_view, 3> kind_names{"osmesa", "egl", "glfw"}; // by ContextKind

/// Returns the context that was current.
Context* release_current() {
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
    case ContextKind::glfw:
        return create_glfw_context(options);
    }
    abort_with("unknown kind of context");
}

/// Makes a context and makes it current; on failure makes `previous` current again. Precondition:
/// no context is current, because GLFW makes a new window's context current for a moment.
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
    return kind_names[static_cast<std::size_t>(kind)];
}

std::optional<ContextKind> context_kind_from_string(std::string_view text) {
    const auto* const found = std::find(kind_names.begin(), kind_names.end(), text);
    return found == kind_names.end()
               ? std::nullopt
               : std::optional(static_cast<ContextKind>(found - kind_names.begin()));
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
    release_current();
    if (const auto bound = bind(); !bound) {
        return in_context(kind(), bound.error());
    }
    current_context = this;
    if (const auto loaded = gl::load_functions(get_proc_address()); !loaded) {
        release();
        return in_context(
            kind(), Error{fmt::format("{}; {}", loaded.error().message, newer_driver(kind()))});
    }
    gl::Limits limits = gl::query_limits();
    renderer_ = std::move(limits.renderer);
    version_ = std::move(limits.version);
    return {};
}

bool is_software_renderer(std::string_view renderer) {
    constexpr std::array rasterizers{"llvmpipe", "softpipe", "swrast", "SWR"};
    return std::any_of(rasterizers.begin(), rasterizers.end(), [&](const char* name) {
        return renderer.find(name) != std::string_view::npos;
    });
}

bool Context::is_software() const {
    return is_software_renderer(renderer_);
}

RendererInfo info_of(const Context& context) {
    return {context.renderer(), context.version(), std::string(to_string(context.kind())),
            context.is_software()};
}

Result<std::unique_ptr<Context>> make_context(ContextKind kind, const ContextOptions& options) {
    return make_with(release_current(), [&]() -> MadeContext {
        auto made = create(kind, options);
        if (!made) {
            return in_context(kind, made.error());
        }
        return made;
    });
}

namespace {

// On a device that is not known to be a CPU rasterizer; it may turn out to be one.
MadeContext make_egl_context(const ContextOptions& options) {
    return make_with(release_current(),
                     [&] { return create_egl_context(options, EglDevices::hardware); });
}

} // namespace

Result<std::unique_ptr<Context>> make_gpu_context(const ContextOptions& options) {
    auto egl = make_egl_context(options);
    return egl && (*egl)->is_software() ? Error{"no hardware GPU was found"} : std::move(egl);
}

Result<std::unique_ptr<Context>> make_headless_context(const ContextOptions& options) {
    auto egl = make_egl_context(options);
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
