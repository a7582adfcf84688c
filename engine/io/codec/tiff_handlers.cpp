#include "engine/io/codec/tiff_handlers.h"

#include <atomic>
#include <cstdarg>

#include <tiffio.h>

namespace reljef::io {
namespace {

struct Handlers {
    TIFFErrorHandler error = nullptr;
    TIFFErrorHandler warning = nullptr;
    std::atomic<bool> is_known{false};
};

Handlers& kept() {
    static Handlers handlers;
    return handlers;
}

// libtiff calls a second handler of each kind after the first.
void pass_error(thandle_t /*file*/, const char* module, const char* format, va_list values) {
    kept().is_known.wait(false);
    if (kept().error != nullptr) {
        kept().error(module, format, values);
    }
}

void pass_warning(thandle_t /*file*/, const char* module, const char* format, va_list values) {
    kept().is_known.wait(false);
    if (kept().warning != nullptr) {
        kept().warning(module, format, values);
    }
}

} // namespace

void keep_tiff_handlers(const std::function<void()>& call) {
    const TIFFErrorHandlerExt error = TIFFSetErrorHandlerExt(pass_error);
    const TIFFErrorHandlerExt warning = TIFFSetWarningHandlerExt(pass_warning);
    kept().error = TIFFSetErrorHandler(nullptr);
    kept().warning = TIFFSetWarningHandler(nullptr);
    kept().is_known = true;
    kept().is_known.notify_all();
    call();
    TIFFSetErrorHandler(kept().error);
    TIFFSetWarningHandler(kept().warning);
    TIFFSetErrorHandlerExt(error);
    TIFFSetWarningHandlerExt(warning);
}

} // namespace reljef::io
