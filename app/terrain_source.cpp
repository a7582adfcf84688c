#include "app/terrain_source.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/message.h"
#include "app/progress_line.h"
#include "engine/io/cone_cache.h"
#include "engine/io/raster.h"
#include "terrains/built_in.h"
#include "terrains/generators.h"

namespace reljef::app {
namespace {

namespace fs = std::filesystem;

Result<io::SceneDescription> describe(const std::string& terrain) {
    for (const terrains::BuiltInScene& scene : terrains::built_in_scenes()) {
        if (scene.name == terrain) {
            return io::parse_scene(scene.text, std::string(scene.name), fs::current_path());
        }
    }
    const fs::path path(terrain);
    if (path.extension() == ".toml") {
        return io::read_scene_file(path);
    }
    std::error_code ignored;
    if (!fs::exists(path, ignored) && !path.has_extension() && !path.has_parent_path()) {
        std::string names;
        for (const terrains::BuiltInScene& scene : terrains::built_in_scenes()) {
            names += std::string(scene.name) + ", ";
        }
        return Error{
            fmt::format("{}: no such terrain; one of {}a scene file or a DEM file was expected",
                        terrain, names)};
    }
    io::SceneDescription description;
    description.name = path.filename().string();
    description.heights = path;
    return description;
}

Result<terrain::Terrain> generate(const TerrainChoice& choice,
                                  const io::SceneDescription& description,
                                  const std::stop_token& stop) {
    ProgressLine line("generating " + description.name, choice.quiet);
    const terrains::GeneratorOptions options{.size = description.size,
                                             .seed = description.seed,
                                             .spacing = description.spacing.value_or(0.0),
                                             .tileable = description.tileable,
                                             .threads = static_cast<unsigned>(choice.threads),
                                             .progress = line.callback(),
                                             .stop = stop};
    if (!choice.imagery.empty()) {
        return Error{fmt::format("--imagery: {} found, but {} brings its own colours",
                                 choice.imagery.string(), description.name)};
    }
    return description.generator == "natural" ? terrains::generate_natural(options)
                                              : terrains::generate_urban(options);
}

Result<terrain::Terrain> read(const TerrainChoice& choice, const io::SceneDescription& description,
                              const std::stop_token& stop) {
    ProgressLine line("reading " + description.name, choice.quiet);
    io::RasterOptions options;
    options.memory_budget = static_cast<std::size_t>(choice.memory_megabytes) << 20U;
    options.spacing = description.spacing;
    options.height_scale = description.height_scale;
    options.height_offset = description.height_offset;
    options.imagery = choice.imagery.empty() ? description.imagery : choice.imagery;
    options.progress = line.callback();
    options.stop = stop;
    return io::read_terrain(description.heights, options);
}

} // namespace

Result<TerrainSource> open_terrain(const TerrainChoice& choice, const std::stop_token& stop,
                                   Notes notes) {
    auto description = describe(choice.terrain);
    if (!description) {
        return description.error();
    }
    return open_terrain(std::move(*description), choice, stop, notes);
}

Result<TerrainSource> open_terrain(io::SceneDescription description, const TerrainChoice& choice,
                                   const std::stop_token& stop, Notes notes) {
    auto terrain = description.generator.empty() ? read(choice, description, stop)
                                                 : generate(choice, description, stop);
    if (!terrain) {
        return terrain.error();
    }
    if (!choice.quiet && notes == Notes::told) {
        for (const std::string& note : terrain->notes) {
            tell(fmt::format("reljef: note: {}\n", note));
        }
    }
    return TerrainSource{std::move(*terrain), std::move(description)};
}

Result<void> prepare_technique(TerrainSource& source, const scene::Technique& technique,
                               const TerrainChoice& choice, const std::stop_token& stop) {
    const Grid<float>& heights = source.terrain.heightfield.heights;
    if (technique.id != scene::TechniqueId::cone || heights.cols() < 2 || heights.rows() < 2) {
        return {};
    }
    ProgressLine line("cones of " + source.description.name, choice.quiet);
    io::ConeCacheOptions options{.folder = io::cache_folder(), .parallel = {}};
    options.parallel = {static_cast<unsigned>(choice.threads), stop, line.callback()};
    auto cached = io::cached_cones(terrain::unit_heights(heights.view()).view(), options);
    if (!cached) {
        return Error{fmt::format("{}: stopped while its cones were made", source.terrain.name)};
    }
    if (!choice.quiet && !cached->note.empty()) {
        tell(fmt::format("reljef: note: {}\n", cached->note));
    }
    source.terrain.cones = std::move(cached->cones);
    return {};
}

} // namespace reljef::app
