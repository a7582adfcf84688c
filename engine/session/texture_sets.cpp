#include "engine/session/texture_sets.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/message.h"
#include "app/cli/misuse.h"
#include "app/cli/progress_line.h"
#include "engine/io/cache/cone_cache.h"
#include "engine/io/image/texture_files.h"
#include "engine/material/tile_cones.h"
#include "terrains/gallery/detail_tiles.h"

namespace reljef::session {
namespace {

Result<void> add_cones_of(material::TextureSet& set, material::KnownCones side,
                          const cli::TerrainChoice& choice, const std::stop_token& stop) {
    cli::ProgressLine line("cones of " + set.name, choice.quiet);
    io::ConeCacheOptions options{.folder = io::cache_folder(), .parallel = {}};
    options.parallel = {static_cast<unsigned>(choice.threads), stop, line.callback()};
    const Grid<float> heights = material::seen_heights(set.heights, side.from_behind);
    const Grid<float> field = material::cone_field(heights.view(), side.border);
    auto cached = io::cached_cones(field.view(), options);
    if (!cached) {
        return Error{fmt::format("{}: stopped while its cones were made", set.name)};
    }
    if (!cached->note.empty()) {
        set.notes.push_back(cached->note);
    }
    side.of_field = std::move(cached->cones);
    set.cones.push_back(std::move(side));
    return {};
}

} // namespace

Result<material::TextureSet> open_textures(const TextureRequest& request,
                                           const cli::TerrainChoice& choice) {
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
        if (request.asked_by.starts_with("--")) {
            cli::refuse(message);
        }
        return Error{message};
    }
    const auto files = io::find_texture_files(request.folder);
    if (!files) {
        return files.error();
    }
    io::TextureOptions options{.width = request.width};
    options.scale = request.scale ? static_cast<float>(*request.scale) : options.scale;
    return io::read_texture_set(*files, options);
}

Result<void> add_cones(material::TextureSet& set, const scene::Technique& technique,
                       const cli::TerrainChoice& choice, const std::stop_token& stop) {
    if (technique.id() != scene::TechniqueId::cone) {
        return {};
    }
    const bool wraps =
        technique.options.border.value_or(scene::BorderRule::wrap) == scene::BorderRule::wrap;
    material::KnownCones side{wraps ? material::TileBorder::wrap : material::TileBorder::clamp,
                              false, nullptr};
    if (auto made = add_cones_of(set, side, choice, stop); !made || !technique.options.two_sided) {
        return made;
    }
    side.from_behind = true;
    return add_cones_of(set, side, choice, stop);
}

void tell_texture_notes(const material::TextureSet& set, const cli::TerrainChoice& choice) {
    for (const std::string& note : set.notes) {
        if (!choice.quiet) {
            cli::tell(fmt::format("reljef: note: {}\n", note));
        }
    }
}

} // namespace reljef::session
