#include "engine/platform/egl_library.h"

#include <array>
#include <cstddef>
#include <string>
#include <type_traits>

#include <fmt/format.h>

#include "engine/core/loading/shared_library.h"

namespace reljef::platform {

namespace {

std::vector<EGLDeviceEXT> devices(const Egl& egl) {
    EGLint count = 0;
    if (egl.query_devices == nullptr || egl.query_devices(0, nullptr, &count) == EGL_FALSE ||
        count < 1) {
        return {};
    }
    std::vector<EGLDeviceEXT> found(static_cast<std::size_t>(count));
    if (egl.query_devices(count, found.data(), &count) == EGL_FALSE) {
        return {};
    }
    found.resize(static_cast<std::size_t>(count));
    return found;
}

bool is_software(const Egl& egl, EGLDeviceEXT device) {
    return egl.query_device_string != nullptr &&
           has_extension(egl.query_device_string(device, EGL_EXTENSIONS),
                         "EGL_MESA_device_software");
}

} // namespace

bool has_extension(const char* list, std::string_view name) {
    const std::string padded = fmt::format(" {} ", list == nullptr ? "" : list);
    return padded.find(fmt::format(" {} ", name)) != std::string::npos;
}

Result<Egl> open_egl() {
    constexpr std::array<const char*, 2> names{"libEGL.so.1", "libEGL.so"};
    const auto library = open_library(names);
    if (!library) {
        return Error{fmt::format("{}; install the packages libegl1 and libegl-mesa0",
                                 library.error().message)};
    }
    Egl egl;
    const bool has_core = load(*library, egl.get_proc_address, "eglGetProcAddress") &&
                          load(*library, egl.query_string, "eglQueryString") &&
                          load(*library, egl.get_error, "eglGetError") &&
                          load(*library, egl.initialize, "eglInitialize") &&
                          load(*library, egl.bind_api, "eglBindAPI") &&
                          load(*library, egl.create_context, "eglCreateContext") &&
                          load(*library, egl.destroy_context, "eglDestroyContext") &&
                          load(*library, egl.make_current, "eglMakeCurrent");
    if (!has_core) {
        return Error{"libEGL lacks core functions, expected EGL 1.5; install the package libegl1"};
    }
    const auto load_extension = [&](auto& function, const char* extension, const char* name) {
        if (has_extension(egl.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS), extension)) {
            function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(
                egl.get_proc_address(name));
        }
    };
    load_extension(egl.get_platform_display, "EGL_EXT_platform_base", "eglGetPlatformDisplayEXT");
    load_extension(egl.query_devices, "EGL_EXT_platform_device", "eglQueryDevicesEXT");
    load_extension(egl.query_device_string, "EGL_EXT_platform_device", "eglQueryDeviceStringEXT");
    if (egl.get_platform_display == nullptr) {
        return Error{"libEGL lacks EGL_EXT_platform_base; install the packages libegl1 and "
                     "libegl-mesa0, or the GPU's own driver"};
    }
    return egl;
}

std::vector<EglCandidate> egl_candidates(const Egl& egl) {
    std::vector<EglCandidate> candidates;
    const auto add = [&](EGLenum platform, void* native, bool hardware) {
        const EGLDisplay display = egl.get_platform_display(platform, native, nullptr);
        if (display != EGL_NO_DISPLAY) {
            candidates.push_back({display, hardware});
        }
    };
    const std::vector<EGLDeviceEXT> all = devices(egl);
    for (EGLDeviceEXT device : all) {
        if (!is_software(egl, device)) {
            add(EGL_PLATFORM_DEVICE_EXT, device, true);
        }
    }
    if (has_extension(egl.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS),
                      "EGL_MESA_platform_surfaceless")) {
        add(EGL_PLATFORM_SURFACELESS_MESA, nullptr, false);
    }
    for (EGLDeviceEXT device : all) {
        if (is_software(egl, device)) {
            add(EGL_PLATFORM_DEVICE_EXT, device, false);
        }
    }
    return candidates;
}

} // namespace reljef::platform
