#include "app/terrain_source.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include <fmt/format.h>

#include "app/message.h"
#include "app/misuse.h"
#include "app/progress_line.h"
#include "engine/core/worker_pool.h"
#include "engine/io/cone_cache.h"
#include "engine/io/geoid_file.h"
#include "engine/io/raster.h"
#include "engine/io/tile_pyramid.h"
#include "engine/io/tree_tile.h"
#include "engine/scene/tile_stream.h"
#include "terrains/built_in.h"
#include "terrains/gallery.h"
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
    if (!fs::exists(path, ignored) && !path.has_extension() && !path.has_parent_path() &&
        !io::is_tile_pyramid(path)) {
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
        refuse(fmt::format("--imagery: {} found, but {} brings its own colours",
                           choice.imagery.front().string(), description.name));
    }
    if (description.generator == "gallery") {
        return terrains::generate_gallery(options);
    }
    return description.generator == "natural" ? terrains::generate_natural(options)
                                              : terrains::generate_urban(options);
}

io::RasterOptions raster_options(const TerrainChoice& choice,
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

// Where the indexes of folders are kept, by the XDG base directory specification; empty where the
// user has no home.
fs::path cache_folder() {
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return fs::path(value != nullptr ? value : "");
    };
    const fs::path cache = variable("XDG_CACHE_HOME");
    if (cache.is_absolute()) {
        return cache / "reljef";
    }
    const fs::path home = variable("HOME");
    return home.is_absolute() ? home / ".cache" / "reljef" : fs::path();
}

Result<io::TileSet> open_set(const TerrainChoice& choice, const io::SceneDescription& description,
                             const std::stop_token& stop) {
    io::TileSetOptions options;
    options.cache_folder = cache_folder();
    options.threads = static_cast<unsigned>(choice.threads);
    options.height_scale = description.height_scale;
    options.height_offset = description.height_offset;
    options.stop = stop;
    return io::TileSet::open(description.heights, options);
}

io::TileTerrainOptions tile_options(const TerrainChoice& choice,
                                    const io::SceneDescription& description,
                                    const std::stop_token& stop) {
    io::TileTerrainOptions options;
    options.raster = raster_options(choice, description, stop);
    options.area = choice.area ? choice.area : description.area;
    if (!options.area && io::is_tile_pyramid(description.heights)) {
        options.area = io::tile_pyramid_area(description.heights);
    }
    options.gaps =
        choice.gaps.value_or(description.gaps == "sea" ? io::Gaps::sea : io::Gaps::holes);
    options.threads = static_cast<unsigned>(choice.threads);
    return options;
}

// Shares of the memory where not all of a terrain fits: an eighth each for its overview, for GDAL's
// blocks, and for what is being read or uploaded; the rest is for tiles.
constexpr std::size_t overview_part = 8;
constexpr std::size_t blocks_part = 8;
constexpr std::size_t work_part = 8;

// Files halve their samples again and again for their own overviews: of the next such reduction
// there is least to be read before the first picture.
std::size_t budget_of_halves(const io::TileSet::TerrainPlan& plan) {
    const auto reduction = std::bit_ceil(static_cast<unsigned>(plan.reduction));
    const io::TileGrid grid = io::TileSet::reduced(plan.grid, static_cast<int>(reduction));
    return io::bytes_per_sample * static_cast<std::size_t>(grid.cols) *
           static_cast<std::size_t>(grid.rows);
}

// What the coarsest views of a terrain that is read part by part take, beside the libraries.
constexpr int least_megabytes = 64;

// What a thread takes to read a tile of heights, and one with a picture, bytes.
constexpr std::size_t bytes_of_reader = std::size_t{4} << 20U;
constexpr std::size_t bytes_of_picture_reader = std::size_t{8} << 20U;

// No more threads than fit what is for reading.
unsigned readers_within(std::size_t budget, unsigned threads, bool with_pictures) {
    const std::size_t each = with_pictures ? bytes_of_picture_reader : bytes_of_reader;
    const std::size_t most = std::max<std::size_t>(1, budget / work_part / each);
    return static_cast<unsigned>(std::min<std::size_t>(thread_count(threads), most));
}

// Samples from vertex to vertex of a tile that is read out of a file without overviews: 4096 a
// side.
constexpr int most_step_read = 4096 / terrain::tile_cells;

// Whether images are finer than one picture over all of the terrain may be.
bool has_finer_pictures(const io::TileSet& tiles, const TerrainChoice& choice,
                        const io::TileTerrainOptions& options) {
    const std::vector<fs::path>& images = options.raster.imagery;
    const auto plan = tiles.plan(options);
    if (!choice.pictures_streamed || images.empty() || !plan) {
        return false;
    }
    const auto imagery = io::ImagerySet::open(images, tiles.crs());
    const io::TileFile& finest = tiles.files().front();
    const double side =
        std::max(plan->grid.cols * finest.spacing.x, plan->grid.rows * finest.spacing.y);
    return imagery && side > io::longest_image_side * imagery->finest_pixel();
}

// How the tiles are to be read as they are needed; nothing where all fits or that is not wanted.
std::optional<StreamSource> stream_source(const io::TileSet& tiles, const TerrainChoice& choice,
                                          io::TileTerrainOptions& options) {
    const auto plan = tiles.plan(options);
    const bool fits = plan && plan->reduction == 1;
    if (!choice.streamed || (fits && !has_finer_pictures(tiles, choice, options)) ||
        std::max(tiles.grid().cols, tiles.grid().rows) > terrain::most_tree_samples) {
        return std::nullopt;
    }
    const std::size_t budget = options.raster.memory_budget;
    options.raster.memory_budget = budget / overview_part;
    auto overview = tiles.plan(options);
    if (overview) {
        options.raster.memory_budget = budget_of_halves(*overview);
        overview = tiles.plan(options);
    }
    if (!overview) {
        options.raster.memory_budget = budget;
        return std::nullopt;
    }
    io::limit_block_cache(budget / blocks_part);
    options.threads = readers_within(budget, options.threads, !options.raster.imagery.empty());
    return StreamSource{*overview,
                        options.gaps,
                        budget - budget / overview_part - budget / blocks_part - budget / work_part,
                        options.threads,
                        0,
                        {}};
}

// So that a texel of the finest tiles is no larger than a pixel of the finest image.
int refinement_for(const io::ImagerySet& imagery, const StreamSource& stream, double spacing) {
    constexpr int most_refinement = 64;
    const int most =
        std::min(most_refinement, terrain::most_tree_samples /
                                      std::max(stream.plan.grid.cols, stream.plan.grid.rows));
    const double texel = spacing / stream.imagery.most_texels;
    int refinement = 1;
    while (2 * refinement <= most && texel > 1.001 * refinement * imagery.finest_pixel()) {
        refinement *= 2;
    }
    return refinement;
}

// The images of a streamed terrain, of which the overview has coarse colours already.
void add_imagery(std::span<const fs::path> images, std::size_t reading_memory,
                 TerrainSource& source) {
    std::vector<std::string>& notes = source.terrain.notes;
    auto imagery = io::ImagerySet::open(images, source.tiles->crs(), reading_memory);
    if (!imagery) {
        notes.push_back(
            fmt::format("finer tiles show the imagery coarsely: {}", imagery.error().message));
        return;
    }
    if (auto missing = imagery->missing_overviews()) {
        notes.push_back(std::move(*missing));
    }
    const glm::dvec2 spacing = source.terrain.heightfield.spacing;
    source.stream->imagery.most_texels =
        scene::TileStream::texels_within(source.stream->memory_budget);
    source.stream->imagery.finest_pixel = imagery->finest_pixel();
    source.stream->imagery.refinement = refinement_for(
        *imagery, *source.stream, std::max(spacing.x, spacing.y) / source.stream->plan.reduction);
    source.imagery = std::make_shared<const io::ImagerySet>(std::move(*imagery));
}

Result<TerrainSource> read_tiles(io::TileSet tiles, const TerrainChoice& choice,
                                 io::SceneDescription description, const std::stop_token& stop) {
    ProgressLine line("reading " + description.name, choice.quiet);
    io::TileTerrainOptions options = tile_options(choice, description, stop);
    options.raster.progress = line.callback();
    std::optional<StreamSource> stream = stream_source(tiles, choice, options);
    auto terrain = tiles.terrain(options);
    if (!terrain) {
        return terrain.error();
    }
    if (stream) {
        terrain->notes.emplace_back("finer tiles are read where the view needs them");
        if (choice.memory_megabytes < least_megabytes) {
            terrain->notes.push_back(fmt::format("--memory {}: the tiles of a view take up to {}",
                                                 choice.memory_megabytes, least_megabytes));
        }
        if (auto missing = io::missing_overviews(tiles)) {
            terrain->notes.push_back(std::move(*missing));
            stream->step_of_overview = std::min(2 * stream->plan.reduction, most_step_read + 1);
        }
    }
    TerrainSource source{std::move(*terrain), std::move(description), std::move(tiles), stream, {}};
    if (stream && !options.raster.imagery.empty()) {
        const std::size_t budget = raster_options(choice, source.description, stop).memory_budget;
        add_imagery(options.raster.imagery, budget / work_part / stream->threads, source);
    }
    return source;
}

// A single file that does not fit the memory, or whose images do not, is read as a set of one, if
// it can be.
std::optional<io::TileSet> set_to_stream(const TerrainChoice& choice,
                                         const io::SceneDescription& description,
                                         const std::stop_token& stop) {
    if (!choice.streamed || !description.generator.empty() || description.spacing) {
        return std::nullopt;
    }
    const auto info = io::read_raster_info(description.heights);
    if (!info || info->crs_name.empty()) {
        return std::nullopt;
    }
    const bool fits = static_cast<double>(info->cols) * info->rows * io::bytes_per_sample <=
                      static_cast<double>(choice.memory_megabytes) * (1U << 20U);
    const io::TileTerrainOptions options = tile_options(choice, description, stop);
    if (fits && options.raster.imagery.empty()) {
        return std::nullopt;
    }
    auto tiles = open_set(choice, description, stop);
    const bool streams = tiles && (!fits || has_finer_pictures(*tiles, choice, options));
    return streams ? std::optional(std::move(*tiles)) : std::nullopt;
}

Result<terrain::Terrain> read(const TerrainChoice& choice, const io::SceneDescription& description,
                              const std::stop_token& stop) {
    ProgressLine line("reading " + description.name, choice.quiet);
    io::RasterOptions options = raster_options(choice, description, stop);
    options.progress = line.callback();
    return io::read_terrain(description.heights, options);
}

bool is_folder(const fs::path& path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored);
}

Result<void> refuse_folder_options(const TerrainChoice& choice,
                                   const io::SceneDescription& description) {
    const char* option = choice.area ? "--area" : choice.gaps ? "--gaps" : nullptr;
    if (option == nullptr && !description.area) {
        return {};
    }
    const std::string message =
        fmt::format("{}: {} found, but it is no folder of tiles, for which alone that was expected",
                    description.name, option != nullptr ? option : "[area]");
    if (option != nullptr) {
        refuse(message);
    }
    return Error{message};
}

Result<TerrainSource> read_source(const TerrainChoice& choice, io::SceneDescription description,
                                  const std::stop_token& stop) {
    if (is_folder(description.heights) || io::is_tile_pyramid(description.heights)) {
        auto tiles = open_set(choice, description, stop);
        if (!tiles) {
            return tiles.error();
        }
        return read_tiles(std::move(*tiles), choice, std::move(description), stop);
    }
    if (auto fits = refuse_folder_options(choice, description); !fits) {
        return fits.error();
    }
    if (auto tiles = set_to_stream(choice, description, stop)) {
        return read_tiles(std::move(*tiles), choice, std::move(description), stop);
    }
    auto terrain = description.generator.empty() ? read(choice, description, stop)
                                                 : generate(choice, description, stop);
    return terrain ? Result<TerrainSource>(
                         TerrainSource{std::move(*terrain), std::move(description), {}, {}, {}})
                   : terrain.error();
}

// Heights above sea level become heights above the ellipsoid by the geoid that the user names, or
// by the installed one where it is the terrain's own.
Result<void> set_geoid(const TerrainChoice& choice, terrain::Terrain& terrain) {
    auto& georeference = terrain.heightfield.georeference;
    const bool is_egm96 =
        georeference && georeference->vertical_datum.find("EGM96") != std::string::npos;
    std::optional<fs::path> file;
    if (choice.geoid.empty() && is_egm96) {
        file = io::installed_geoid();
    } else if (!choice.geoid.empty() && choice.geoid != "none") {
        file = choice.geoid;
    }
    if (!file || !georeference) {
        return {};
    }
    auto geoid = io::read_geoid(*file);
    if (!geoid) {
        return geoid.error();
    }
    georeference->geoid = std::move(*geoid);
    return {};
}

void tell_notes(const TerrainSource& source) {
    for (const std::string& note : source.terrain.notes) {
        tell(fmt::format("reljef: note: {}\n", note));
    }
    for (const std::string& fault : source.terrain.faults) {
        tell(fmt::format("reljef: left out: {}\n", fault));
    }
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
    if (choice.textures && description.generator != "gallery") {
        refuse(fmt::format("--textures: {} found, but only the gallery shows tiles, not {}; "
                           "--detail lays one over a terrain",
                           *choice.textures, description.name));
    }
    auto source = read_source(choice, std::move(description), stop);
    if (!source) {
        return source.error();
    }
    if (auto set = set_geoid(choice, source->terrain); !set) {
        return set.error();
    }
    if (!choice.quiet && notes == Notes::told) {
        tell_notes(*source);
    }
    return source;
}

Result<io::TileSet> open_tiles(const TerrainChoice& choice, const std::stop_token& stop) {
    const auto description = describe(choice.terrain);
    if (!description) {
        return description.error();
    }
    if (!description->generator.empty()) {
        return Error{fmt::format("{}: has no coordinate system, one was expected for places on "
                                 "Earth",
                                 description->name)};
    }
    return open_set(choice, *description, stop);
}

Result<void> report_faults(const std::string& terrain, std::size_t faults) {
    return faults == 0 ? Result<void>()
                       : Error{fmt::format("{}: {} of the files asked for could not be read and {} "
                                           "left out",
                                           terrain, faults, faults == 1 ? "is" : "are")};
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
