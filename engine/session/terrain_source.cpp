#include "engine/session/terrain_source.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include "engine/io/cache/disk_cache.h"
#include "engine/io/checks/lowercase.h"
#include "engine/io/formats/geoid_file.h"
#include "engine/io/raster/raster.h"
#include "engine/io/raster/web_tiles.h"
#include "engine/io/remote/read_scope.h"
#include "engine/io/terrain_file.h"
#include "engine/io/tree_tile.h"
#include "engine/session/stream_source.h"
#include "terrains/built_in.h"
#include "terrains/gallery/gallery.h"
#include "terrains/generators.h"

namespace reljef::session {
namespace {

namespace fs = std::filesystem;

Result<terrains::City> generate(const SourceOptions& choice,
                                const io::SceneDescription& description, Log& log,
                                const std::stop_token& stop) {
    const auto task = log.start("generating " + description.name);
    const terrains::GeneratorOptions options{.size = description.size,
                                             .seed = description.seed,
                                             .spacing = description.spacing.value_or(0.0),
                                             .tileable = description.tileable,
                                             .walls = choice.walls.value_or(description.walls),
                                             .threads = static_cast<unsigned>(choice.threads),
                                             .progress = task->callback(),
                                             .stop = stop};
    const auto form = choice.buildings.value_or(description.buildings);
    if (choice.walls && form != building::CityForm::heights) {
        return usage_error(
            "--walls: found beside buildings that are meshes, heights were expected");
    }
    if (!choice.imagery.empty()) {
        return usage_error(fmt::format("--imagery: {} found, but {} brings its own colours",
                                       choice.imagery.front().string(), description.name));
    }
    if ((choice.buildings || choice.walls) && description.generator != "urban") {
        return usage_error(fmt::format("--{}: found, but {} was expected to be urban",
                                       choice.buildings ? "buildings" : "walls", description.name));
    }
    if (description.generator == "urban") {
        return terrains::generate_city(options, form);
    }
    auto terrain = description.generator == "gallery" ? terrains::generate_gallery(options)
                                                      : terrains::generate_natural(options);
    return terrain ? Result<terrains::City>(terrains::City{std::move(*terrain), {}, {}})
                   : terrain.error();
}

io::RasterOptions raster_options(const SourceOptions& choice,
                                 const io::SceneDescription& description,
                                 const std::stop_token& stop) {
    io::RasterOptions options;
    options.memory_budget = static_cast<std::size_t>(choice.memory_megabytes) << 20U;
    options.spacing = description.spacing;
    options.height_scale = description.height_scale;
    options.height_offset = description.height_offset;
    options.imagery = choice.imagery.empty() ? description.imagery : choice.imagery;
    options.stop = stop;
    return options;
}

Result<io::TileSet> open_set(const SourceOptions& choice, const io::SceneDescription& description,
                             const std::stop_token& stop) {
    io::TileSetOptions options;
    options.cache_folder = io::cache_folder().value_or(fs::path());
    options.threads = static_cast<unsigned>(choice.threads);
    options.height_scale = description.height_scale;
    options.height_offset = description.height_offset;
    options.allows_planes = true;
    options.spacing = description.spacing;
    options.stop = stop;
    return io::TileSet::open(description.heights, options);
}

io::TileTerrainOptions tile_options(const SourceOptions& choice,
                                    const io::SceneDescription& description,
                                    const std::stop_token& stop) {
    io::TileTerrainOptions options;
    options.raster = raster_options(choice, description, stop);
    options.area = area_of(choice, description);
    options.gaps =
        choice.gaps.value_or(description.gaps == "sea" ? io::Gaps::sea : io::Gaps::holes);
    options.threads = static_cast<unsigned>(choice.threads);
    return options;
}

// A terrain whose tiles may be read on demand.
struct SetToRead {
    std::optional<io::TileSet> tiles;              // absent: a file that is read whole
    std::shared_ptr<const io::ImagerySet> imagery; // null: not opened
    std::optional<Error> obstacle;                 // why the file is not a set, though it should be

    [[nodiscard]] std::optional<double> imagery_white() const {
        return imagery != nullptr ? std::optional(imagery->white()) : std::nullopt;
    }
};

// For the coarsest views of a streamed terrain, without the libraries.
constexpr int min_megabytes = 64;

// Largest step of tiles that are read from a file without overviews: 4096 samples a side.
constexpr int max_step_read = 4096 / terrain::tree_tile_cells;

// Chooses which levels come from the overview; adds notes.
void set_heights_of_tiles(const io::TileSet& tiles, const SourceOptions& choice,
                          StreamSource& stream, std::vector<std::string>& notes) {
    const bool is_whole = stream.plan.reduction == 1;
    notes.emplace_back(is_whole ? "finer parts of the images are read where the view needs them"
                                : "finer tiles are read where the view needs them");
    if (const auto megabytes = stream.megabytes_for_all_heights; megabytes && !is_whole) {
        notes.push_back(fmt::format("--memory {}: beside the images, which are finer than one "
                                    "picture may be, shadows and far ground are of averages; {} "
                                    "keeps all samples",
                                    choice.memory_megabytes, *megabytes));
    }
    if (choice.memory_megabytes < min_megabytes) {
        notes.push_back(fmt::format("--memory {}: the tiles of a view take up to {}",
                                    choice.memory_megabytes, min_megabytes));
    }
    if (is_whole) {
        stream.step_of_overview = 1;
    } else if (auto missing = io::missing_overviews(tiles)) {
        notes.push_back(std::move(*missing));
        stream.step_of_overview = std::min(2 * stream.plan.reduction, max_step_read + 1);
    }
}

Result<TerrainSource> read_tiles(SetToRead set, const SourceOptions& choice,
                                 io::SceneDescription description, Log& log,
                                 const std::stop_token& stop) {
    const auto task = log.start("reading " + description.name);
    io::TileTerrainOptions options = tile_options(choice, description, stop);
    options.raster.progress = task->callback();
    options.raster.imagery_white = set.imagery_white();
    std::optional<StreamSource> stream =
        stream_source(*set.tiles, choice, options, set.imagery.get());
    if (stream) {
        options.raster.memory_budget = stream->overview_budget;
        options.threads = stream->threads;
    }
    auto terrain = set.tiles->terrain(options);
    if (!terrain) {
        return terrain.error();
    }
    if (stream) {
        set_heights_of_tiles(*set.tiles, choice, *stream, terrain->notes);
    }
    TerrainSource source{
        std::move(*terrain), std::move(description), std::move(set.tiles), stream, {}};
    if (stream && set.imagery != nullptr) {
        if (auto missing = set.imagery->missing_overviews()) {
            source.terrain.notes.push_back(std::move(*missing));
        }
        const glm::dvec2 spacing = source.terrain.heightfield.spacing;
        source.stream->imagery = imagery_detail(
            *set.imagery, *stream, std::max(spacing.x, spacing.y) / stream->plan.reduction);
        source.imagery = std::move(set.imagery);
    }
    return source;
}

// A single file is streamed as a set if it, or its imagery, does not fit in memory. Otherwise
// returns its imagery, if that was opened.
Result<SetToRead> set_to_stream(const SourceOptions& choice,
                                const io::SceneDescription& description,
                                const std::stop_token& stop) {
    if (!choice.streamed || !description.generator.empty()) {
        return SetToRead();
    }
    const auto info = io::read_raster_info(description.heights);
    if (!info) {
        return info.error();
    }
    const bool fits = static_cast<double>(info->cols) * info->rows * io::bytes_per_sample <=
                      static_cast<double>(choice.memory_megabytes) * (1U << 20U);
    const io::TileTerrainOptions options = tile_options(choice, description, stop);
    if (fits && (options.raster.imagery.empty() || !choice.pictures_streamed)) {
        return SetToRead();
    }
    auto tiles = open_set(choice, description, stop);
    if (!tiles) {
        return stop.stop_requested() ? Result<SetToRead>(tiles.error())
                                     : SetToRead{{}, {}, tiles.error()};
    }
    auto imagery = open_imagery(*tiles, choice, options);
    if (!imagery) {
        return imagery.error();
    }
    const bool is_read_whole = fits && !has_finer_pictures(*tiles, options, imagery->get());
    return SetToRead{
        is_read_whole ? std::nullopt : std::optional(std::move(*tiles)), std::move(*imagery), {}};
}

Result<terrain::Terrain> read(const SourceOptions& choice, const io::SceneDescription& description,
                              std::optional<double> imagery_white, Log& log,
                              const std::stop_token& stop) {
    const auto task = log.start("reading " + description.name);
    io::RasterOptions options = raster_options(choice, description, stop);
    options.imagery_white = imagery_white;
    options.progress = task->callback();
    return io::read_terrain(description.heights, options);
}

// Half of the memory for what is read; streams leave less.
void limit_block_cache(const SourceOptions& choice) {
    io::limit_block_cache((static_cast<std::size_t>(choice.memory_megabytes) << 20U) / 2);
}

bool has_many_files(const io::SceneDescription& description) {
    std::error_code ignored;
    return fs::is_directory(description.heights, ignored) || io::is_web_tiles(description.heights);
}

Result<void> check_folder_options(const SourceOptions& choice,
                                  const io::SceneDescription& description) {
    const char* option = choice.area ? "--area" : choice.gaps ? "--gaps" : nullptr;
    if (option == nullptr && !description.area) {
        return {};
    }
    const std::string message =
        fmt::format("{}: {} found, but it is no folder of tiles, for which alone that was expected",
                    description.name, option != nullptr ? option : "[area]");
    return option != nullptr ? usage_error(message) : Error{message};
}

Result<void> check_city_options(const SourceOptions& choice,
                                const io::SceneDescription& description) {
    if (choice.buildings && description.generator.empty()) {
        return usage_error(fmt::format("--buildings: found with {}, urban was expected; "
                                       "--footprints puts buildings on other terrains",
                                       description.name));
    }
    if (choice.walls && description.generator.empty()) {
        return usage_error(
            fmt::format("--walls: found with {}, urban was expected", description.name));
    }
    return {};
}

Result<TerrainSource> read_source(const SourceOptions& choice, io::SceneDescription description,
                                  Log& log, const std::stop_token& stop) {
    if (auto good = check_city_options(choice, description); !good) {
        return good.error();
    }
    if (has_many_files(description)) {
        auto tiles = open_set(choice, description, stop);
        if (!tiles) {
            return tiles.error();
        }
        auto imagery = open_imagery(*tiles, choice, tile_options(choice, description, stop));
        if (!imagery) {
            return imagery.error();
        }
        return read_tiles({std::move(*tiles), std::move(*imagery), {}}, choice,
                          std::move(description), log, stop);
    }
    if (auto fits = check_folder_options(choice, description); !fits) {
        return fits.error();
    }
    auto found = set_to_stream(choice, description, stop);
    if (!found) {
        return found.error();
    }
    if (found->tiles) {
        return read_tiles(std::move(*found), choice, std::move(description), log, stop);
    }
    if (!description.generator.empty()) {
        auto city = generate(choice, description, log, stop);
        if (!city) {
            return city.error();
        }
        TerrainSource source{std::move(city->terrain), std::move(description), {}, {}, {}};
        source.buildings = std::move(city->buildings);
        source.city_heights = std::move(city->heights);
        return source;
    }
    auto terrain = read(choice, description, found->imagery_white(), log, stop);
    if (!terrain) {
        return terrain.error();
    }
    if (found->obstacle) {
        terrain->notes.push_back("not read tile by tile: " + found->obstacle->message);
    }
    return TerrainSource{std::move(*terrain), std::move(description), {}, {}, {}};
}

// The geoid of the options, or the installed one if it is the terrain's datum.
std::optional<fs::path> geoid_file(const SourceOptions& choice, const std::string& datum) {
    if (choice.geoid == "none") {
        return std::nullopt;
    }
    if (!choice.geoid.empty()) {
        return fs::path(choice.geoid);
    }
    return geo::is_egm96(datum) ? io::installed_geoid() : std::nullopt;
}

// Heights above sea level become heights above the ellipsoid.
Result<void> set_geoid(const SourceOptions& choice, terrain::Terrain& terrain) {
    auto& georeference = terrain.heightfield.georeference;
    if (!georeference) {
        return {};
    }
    const std::string& datum = georeference->vertical_datum;
    const auto file = geoid_file(choice, datum);
    if (!file) {
        return {};
    }
    if (geo::is_ellipsoidal(datum)) {
        return usage_error(
            fmt::format("--geoid: {} found, but the heights of {} count from the ellipsoid "
                        "({}): none was expected",
                        choice.geoid, terrain.name, datum));
    }
    auto geoid = io::read_geoid(*file);
    if (!geoid) {
        return geoid.error();
    }
    georeference->geoid = std::move(*geoid);
    return {};
}

void log_notes(const TerrainSource& source, Log& log) {
    for (const std::string& note : source.terrain.notes) {
        log.note(note);
    }
    for (const std::string& error : source.terrain.errors) {
        log.message(MessageKind::left_out, error);
    }
}

} // namespace

Result<io::SceneDescription> describe(const std::string& terrain) {
    for (const terrains::BuiltInScene& scene : terrains::built_in_scenes()) {
        if (scene.name == terrain) {
            std::error_code code; // of a folder that was removed; the scene names no files in it
            return io::parse_scene(scene.text, std::string(scene.name), fs::current_path(code));
        }
    }
    const fs::path path(terrain);
    if (io::extension_of(path) == ".toml") {
        return io::read_scene_file(path);
    }
    std::error_code ignored;
    if (!fs::exists(path, ignored) && !path.has_extension() && !path.has_parent_path() &&
        !io::is_web_tiles(path)) {
        std::string names;
        for (const terrains::BuiltInScene& scene : terrains::built_in_scenes()) {
            names += std::string(scene.name) + ", ";
        }
        return Error{
            fmt::format("{}: no such terrain; one of {}a scene file or a DEM file was expected",
                        terrain, names)};
    }
    io::SceneDescription description;
    description.name = (path.has_filename() ? path : path.parent_path()).filename().string();
    description.heights = path;
    return description;
}

std::optional<geo::GeodeticArea> area_of(const SourceOptions& choice,
                                         const io::SceneDescription& description) {
    if (choice.area || description.area) {
        return choice.area ? choice.area : description.area;
    }
    return io::is_web_tiles(description.heights) ? io::web_tiles_area(description.heights)
                                                 : std::nullopt;
}

Result<TerrainSource> open_terrain(const SourceOptions& choice, Log& log,
                                   const std::stop_token& stop) {
    auto description = describe(choice.terrain);
    return description ? open_terrain(std::move(*description), choice, log, stop)
                       : description.error();
}

Result<TerrainSource> open_terrain(io::SceneDescription description, const SourceOptions& choice,
                                   Log& log, const std::stop_token& stop) {
    const io::ReadScope scope(stop);
    if (choice.textures && description.generator != "gallery") {
        return usage_error(
            fmt::format("--textures: {} found, but only the gallery shows tiles, not {}; "
                        "--detail lays one over a terrain",
                        *choice.textures, description.name));
    }
    io::allow_external(choice.allow_external);
    limit_block_cache(choice);
    auto source = read_source(choice, std::move(description), log, stop);
    if (!source) {
        return source.error();
    }
    if (auto set = set_geoid(choice, source->terrain); !set) {
        return set.error();
    }
    log_notes(*source, log);
    return source;
}

Result<HeightSource> open_heights(const SourceOptions& choice, HeightUse use,
                                  const std::stop_token& stop) {
    const io::ReadScope scope(stop);
    const auto description = describe(choice.terrain);
    if (!description) {
        return description.error();
    }
    const Error nowhere{fmt::format("{}: has no coordinate system, one was expected for places on "
                                    "Earth",
                                    description->name)};
    if (!description->generator.empty()) {
        return nowhere;
    }
    if (!has_many_files(*description)) {
        if (auto fits = check_folder_options(choice, *description); !fits) {
            return fits.error();
        }
    }
    io::allow_external(choice.allow_external);
    limit_block_cache(choice);
    auto tiles = open_set(choice, *description, stop);
    if (!tiles) {
        return tiles.error();
    }
    if (use == HeightUse::at_places && tiles->is_on_plane()) {
        return nowhere;
    }
    return HeightSource{std::move(*tiles), choice.area ? choice.area : description->area,
                        tile_options(choice, *description, stop)};
}

Result<void> report_errors(const std::string& terrain, std::size_t errors) {
    return errors == 0 ? Result<void>()
                       : Error{fmt::format("{}: {} of the files asked for could not be read and {} "
                                           "left out",
                                           terrain, errors, errors == 1 ? "is" : "are")};
}

} // namespace reljef::session
