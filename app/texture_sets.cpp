#include "app/texture_sets.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/message.h"
#include "app/misuse.h"
#include "app/progress_line.h"
#include "engine/io/cone_cache.h"
#include "engine/io/texture_files.h"
#include "engine/terrain/tile_cones.h"
#include "terrains/detail_tiles.h"

namespace reljef::app {
namespace {

Result<void> add_cones_of(terrain::TextureSet& set, terrain::KnownCones side,
                          const TerrainChoice& choice, const std::stop_token& stop) {
    ProgressLine line("cones of " + set.name, choice.quiet);
    io::ConeCacheOptions options{.folder = io::cache_folder(), .parallel = {}};
    options.parallel = {static_cast<unsigned>(choice.threads), stop, line.callback()};
    const Grid<float> heights = terrain::seen_heights(set.heights, side.from_behind);
    const Grid<float> field = terrain::cone_field(heights.view(), side.border);
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

Result<terrain::TextureSet> open_textures(const TextureRequest& request,
                                          const TerrainChoice& choice) {
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
            refuse(message);
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

Result<void> add_cones(terrain::TextureSet& set, const scene::Technique& technique,
                       const TerrainChoice& choice, const std::stop_token& stop) {
    if (technique.id != scene::TechniqueId::cone) {
        return {};
    }
    const bool wraps =
        technique.options.border.value_or(scene::BorderRule::wrap) == scene::BorderRule::wrap;
    terrain::KnownCones side{wraps ? terrain::TileBorder::wrap : terrain::TileBorder::clamp, false,
                             nullptr};
    if (auto made = add_cones_of(set, side, choice, stop); !made || !technique.options.two_sided) {
        return made;
    }
    side.from_behind = true;
    return add_cones_of(set, side, choice, stop);
}

void tell_texture_notes(const terrain::TextureSet& set, const TerrainChoice& choice) {
    for (const std::string& note : set.notes) {
        if (!choice.quiet) {
            tell(fmt::format("reljef: note: {}\n", note));
        }
    }
}

} // namespace reljef::app
