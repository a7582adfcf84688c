// LeakSanitizer names the library of a leak only while that is loaded, and drivers are unloaded
// with their context. So nothing is unloaded in programs that it watches.
#include <dlfcn.h>

extern "C" int dlclose(void* /*handle*/) noexcept {
    return 0;
}
