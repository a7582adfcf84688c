#include "engine/core/loading/program_part.h"

#include <algorithm>
#include <array>
#include <system_error>

// Programs that find_package(reljef) define it: the package may lie anywhere.
extern "C" [[gnu::weak]] const char* reljef_parts_folder();

namespace reljef {

namespace fs = std::filesystem;

fs::path program_part(const char* name) {
    std::error_code code;
    const fs::path folder = fs::read_symlink("/proc/self/exe", code).parent_path();
    const fs::path packaged = reljef_parts_folder == nullptr ? "" : reljef_parts_folder();
    const std::array<fs::path, 4> places{folder, folder / ".." / "libexec" / "reljef", packaged,
                                         RELJEF_PARTS};
    const auto* const found = std::find_if(places.begin(), places.end(), [&](const fs::path& at) {
        return at.is_absolute() && fs::is_regular_file(at / name, code);
    });
    return (found != places.end() ? *found : places[0]) / name;
}

} // namespace reljef
