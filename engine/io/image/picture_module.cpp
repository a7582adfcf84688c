#include "engine/io/image/picture_module.h"

#include <array>
#include <exception>
#include <mutex>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "engine/core/loading/program_part.h"
#include "engine/core/loading/shared_library.h"
#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* module_name = "reljef-pictures.so";

Error no_module(const fs::path& module, std::string_view found) {
    return Error{fmt::format("{}: {}, the library with which this reljef reads and writes pictures "
                             "was expected",
                             module.string(), found)};
}

Result<void> find_module(const fs::path& module) {
    std::error_code code;
    return fs::is_regular_file(module, code) ? Result<void>() : no_module(module, "does not exist");
}

Error unloadable(const fs::path& module, std::string reason) {
    const std::string prefix = module.string() + ": ";
    return no_module(module, fmt::format("cannot be loaded ({})", reason.starts_with(prefix)
                                                                      ? reason.substr(prefix.size())
                                                                      : reason));
}

} // namespace

Result<PictureCodec*> load_picture_codec(const fs::path& module) {
    register_drivers(); // GDAL's handlers of libtiff are there first, and the module keeps them
    if (auto found = find_module(module); !found) {
        return found.error();
    }
    const std::array<const char*, 1> names{module.c_str()};
    const auto library = open_library(names);
    if (!library) {
        return unloadable(module, library.error().message);
    }
    PictureModuleFunction function = nullptr;
    if (!load(*library, function, picture_module_function)) {
        return no_module(module, "is another library");
    }
    const GdalMessages unprinted; // of a TIFF that OpenImageIO looks for
    try {
        const PictureModule* const found = function();
        return found->interface == std::string_view(RELJEF_PICTURE_INTERFACE)
                   ? Result<PictureCodec*>(found->codec)
                   : no_module(module, "belongs to another reljef");
    } catch (const std::exception& problem) {
        return unloadable(module, problem.what());
    }
}

Result<PictureCodec*> picture_codec() {
    static std::mutex mutex;
    static PictureCodec* codec = nullptr;
    const std::scoped_lock lock(mutex);
    if (codec == nullptr) {
        const auto loaded = load_picture_codec(program_part(module_name));
        if (!loaded) {
            return loaded.error();
        }
        codec = *loaded;
    }
    return codec;
}

Result<void> find_picture_module() {
    return find_module(program_part(module_name));
}

} // namespace reljef::io
