#include "engine/session/material_source.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/io/image/texture_files.h"
#include "terrains/gallery/detail_tiles.h"

namespace reljef::session {

Result<material::ReliefMaterial> open_material(const MaterialRequest& request,
                                               const SourceOptions& choice) {
    const std::string& name = request.name;
    const auto names = terrains::detail_names();
    if (std::find(names.begin(), names.end(), name) != names.end()) {
        return terrains::generate_detail(
            name, {.seed = request.seed, .threads = static_cast<unsigned>(choice.threads)});
    }
    std::error_code ignored;
    if (!std::filesystem::is_directory(request.folder, ignored)) {
        const std::string message = fmt::format(
            "{}: texture set '{}' found, one of {}{} or a folder of pictures was expected",
            request.asked_by, name, request.also, fmt::join(names, ", "));
        return request.asked_by.starts_with("--") ? usage_error(message) : Error{message};
    }
    const auto files = io::find_texture_files(request.folder);
    if (!files) {
        return files.error();
    }
    io::TextureOptions options{.width = request.width};
    options.scale = request.scale ? static_cast<float>(*request.scale) : options.scale;
    return io::read_texture_set(*files, options);
}

void log_material_notes(const material::ReliefMaterial& set, Log& log) {
    for (const std::string& note : set.notes) {
        log.note(note);
    }
}

} // namespace reljef::session
