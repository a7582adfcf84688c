#include "engine/platform/egl_library.h"

#include <array>
#include <cstddef>
#include <type_traits>

#include <fmt/format.h>

namespace reljef::platform {

namespace {

bool load_core(Egl& egl) {
    const auto find = [&egl](auto& function, const char* name) {
        function = egl.library.function<std::remove_reference_t<decltype(function)>>(name);
        return function != nullptr;
    };
    return find(egl.get_proc_address, "eglGetProcAddress") &&
           find(egl.query_string, "eglQueryString") && find(egl.get_error, "eglGetError") &&
           find(egl.initialize, "eglInitialize") && find(egl.bind_api, "eglBindAPI") &&
           find(egl.create_context, "eglCreateContext") &&
           find(egl.destroy_context, "eglDestroyContext") &&
           find(egl.make_current, "eglMakeCurrent");
}

void load_extensions(Egl& egl) {
    const auto find = [&egl](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(
            egl.get_proc_address(name));
    };
    const char* client = egl.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (has_extension(client, "EGL_EXT_platform_base")) {
        find(egl.get_platform_display, "eglGetPlatformDisplayEXT");
    }
    if (has_extension(client, "EGL_EXT_platform_device")) {
        find(egl.query_devices, "eglQueryDevicesEXT");
        find(egl.query_device_string, "eglQueryDeviceStringEXT");
    }
}

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
    std::string_view rest = list == nullptr ? std::string_view() : std::string_view(list);
    while (!rest.empty()) {
        const std::size_t end = rest.find(' ');
        if (rest.substr(0, end) == name) {
            return true;
        }
        rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    return false;
}

Result<Egl> open_egl() {
    constexpr std::array<const char*, 2> names{"libEGL.so.1", "libEGL.so"};
    auto library = SharedLibrary::open(names);
    if (!library) {
        return Error{fmt::format("{}; install the packages libegl1 and libegl-mesa0",
                                 library.error().message)};
    }
    Egl egl{std::move(*library)};
    if (!load_core(egl)) {
        return Error{"libEGL lacks core functions, expected EGL 1.5; install the package libegl1"};
    }
    load_extensions(egl);
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
