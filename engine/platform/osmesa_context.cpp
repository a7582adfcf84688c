#include "engine/platform/osmesa_context.h"

#include <array>
#include <cstddef>

#include <fmt/format.h>
// Before GL/osmesa.h, which includes GL/gl.h: glad blocks that header.
#include <glad/gl.h>

#include <GL/osmesa.h>

#include "engine/core/loading/shared_library.h"

namespace reljef::platform {

namespace {

struct OsMesa {
    decltype(&OSMesaCreateContextAttribs) create_context = nullptr;
    decltype(&OSMesaMakeCurrent) make_current = nullptr;
    decltype(&OSMesaDestroyContext) destroy_context = nullptr;
    decltype(&OSMesaGetProcAddress) get_proc_address = nullptr;
};

Result<OsMesa> open_osmesa() {
    constexpr std::array<const char*, 3> names{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
    const auto library = open_library(names);
    if (!library) {
        return Error{fmt::format("{}; install the package libosmesa6", library.error().message)};
    }
    OsMesa mesa;
    if (load(*library, mesa.create_context, "OSMesaCreateContextAttribs") &&
        load(*library, mesa.make_current, "OSMesaMakeCurrent") &&
        load(*library, mesa.destroy_context, "OSMesaDestroyContext") &&
        load(*library, mesa.get_proc_address, "OSMesaGetProcAddress")) {
        return mesa;
    }
    return Error{"libOSMesa has no OSMesaCreateContextAttribs, expected Mesa 13 or newer; install "
                 "the package libosmesa6"};
}

/// The context needs a buffer; drawing goes to framebuffer objects.
constexpr int buffer_side = 4;

OSMesaContext create(const OsMesa& mesa, int major, int minor) {
    const std::array<int, 9> attributes{OSMESA_PROFILE,
                                        OSMESA_CORE_PROFILE,
                                        OSMESA_CONTEXT_MAJOR_VERSION,
                                        major,
                                        OSMESA_CONTEXT_MINOR_VERSION,
                                        minor,
                                        OSMESA_FORMAT,
                                        OSMESA_RGBA,
                                        0};
    return mesa.create_context(attributes.data(), nullptr);
}

class OsMesaContext final : public Context {
public:
    OsMesaContext(const OsMesa& mesa, OSMesaContext context) : mesa_(mesa), context_(context) {}
    ~OsMesaContext() override {
        release();
        mesa_.destroy_context(context_);
    }

    [[nodiscard]] ContextKind kind() const override { return ContextKind::osmesa; }

private:
    Result<void> bind() override {
        if (mesa_.make_current(context_, buffer_.data(), GL_UNSIGNED_BYTE, buffer_side,
                               buffer_side) == GL_FALSE) {
            return Error{"OSMesaMakeCurrent refused"};
        }
        return {};
    }

    void unbind() override { mesa_.make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }

    [[nodiscard]] gl::GetProcAddress get_proc_address() const override {
        return mesa_.get_proc_address;
    }

    OsMesa mesa_;
    OSMesaContext context_;
    std::array<std::byte, 4UL * buffer_side * buffer_side> buffer_{};
};

} // namespace

Result<std::unique_ptr<Context>> create_osmesa_context() {
    const auto mesa = open_osmesa();
    if (!mesa) {
        return mesa.error();
    }
    OSMesaContext context = create(*mesa, 4, 5);
    if (context == nullptr) {
        context = create(*mesa, 3, 2);
    }
    if (context == nullptr) {
        return Error{"the library gives neither OpenGL 4.5 nor 3.2 core; install the package "
                     "libosmesa6"};
    }
    return std::unique_ptr<Context>(std::make_unique<OsMesaContext>(*mesa, context));
}

} // namespace reljef::platform
