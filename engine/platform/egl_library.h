#pragma once

#include <string_view>
#include <vector>

#ifndef EGL_NO_X11
#define EGL_NO_X11
#endif
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "engine/core/result.h"

namespace reljef::platform {

/// libEGL's functions. The library stays loaded.
struct Egl {
    PFNEGLGETPROCADDRESSPROC get_proc_address = nullptr;
    PFNEGLQUERYSTRINGPROC query_string = nullptr;
    PFNEGLGETERRORPROC get_error = nullptr;
    PFNEGLINITIALIZEPROC initialize = nullptr;
    PFNEGLBINDAPIPROC bind_api = nullptr;
    PFNEGLCREATECONTEXTPROC create_context = nullptr;
    PFNEGLDESTROYCONTEXTPROC destroy_context = nullptr;
    PFNEGLMAKECURRENTPROC make_current = nullptr;
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display = nullptr;
    PFNEGLQUERYDEVICESEXTPROC query_devices = nullptr;            ///< may be null
    PFNEGLQUERYDEVICESTRINGEXTPROC query_device_string = nullptr; ///< may be null
};

/// Loads libEGL.so.1. Fails with the packages to install.
Result<Egl> open_egl();

/// Whether a blank-separated list of extensions contains `name`. `list` may be null.
bool has_extension(const char* list, std::string_view name);

/// A display without a window system.
struct EglCandidate {
    EGLDisplay display = EGL_NO_DISPLAY;
    bool hardware = false; ///< no known CPU rasterizer
};

/// Uninitialized displays, best first: GPUs, Mesa's surfaceless platform, its software device.
std::vector<EglCandidate> egl_candidates(const Egl& egl);

} // namespace reljef::platform
