#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <nlohmann/json.hpp>

#include "app/cli/console_log.h"
#include "app/cli/options.h"
#include "app/cli/standard_input.h"
#include "app/commands.h"
#include "engine/io/raster/raster.h"
#include "engine/session/scene_daylight.h"
#include "engine/session/terrain_source.h"
#include "terrains/gallery/gallery.h"

namespace reljef::app {
namespace {

using Json = nlohmann::ordered_json;

struct InfoChoice {
    cli::TerrainChoice terrain;
    bool json = false;
};

// The samples of the source. The samples that were read may be averages of them.
struct FullGrid {
    int cols = 0;
    int rows = 0;
    int reduction = 1; // source samples per read sample, along each side
    // The first and last source sample, in read samples.
    glm::dvec2 first{0.0};
    glm::dvec2 last{0.0};
};

// Rows and columns that were read; some may be added to wrap the globe.
geo::WrappedRows rows_of(const terrain::Heightfield& heightfield) {
    return heightfield.georeference ? heightfield.georeference->geodetic.rows()
                                    : geo::WrappedRows();
}

// Number of samples that were read, without those added to wrap the globe.
glm::ivec2 size_that_was_read(const terrain::Heightfield& heightfield) {
    const geo::WrappedRows rows = rows_of(heightfield);
    return {heightfield.heights.cols() - rows.wrap().cols(),
            heightfield.heights.rows() - rows.wrap().rows()};
}

// The place of a source sample, both in read samples.
glm::dvec2 read_from_source(const terrain::Heightfield& heightfield, glm::dvec2 sample) {
    return {sample.x, rows_of(heightfield).closed_row(sample.y)};
}

bool has_inside(const geo::GeodeticMap& map, const FullGrid& grid, double latitude) {
    const auto sample = map.sample(latitude, 0.0);
    return sample && glm::all(glm::greaterThan(*sample, grid.first)) &&
           glm::all(glm::lessThan(*sample, grid.last));
}

geo::GeodeticArea area_of(const geo::GeodeticMap& map, const FullGrid& grid) {
    geo::GeodeticArea box{90.0, 1e9, -90.0, -1e9};
    constexpr int steps = 32;
    for (int i = 0; i <= steps; ++i) {
        const glm::dvec2 at = glm::mix(grid.first, grid.last, static_cast<double>(i) / steps);
        for (const glm::dvec2 sample :
             {glm::dvec2(at.x, grid.first.y), glm::dvec2(at.x, grid.last.y),
              glm::dvec2(grid.first.x, at.y), glm::dvec2(grid.last.x, at.y)}) {
            const auto place = map.latitude_longitude(sample);
            box.south = std::min(box.south, place.x);
            box.north = std::max(box.north, place.x);
            box.west = std::min(box.west, place.y);
            box.east = std::max(box.east, place.y);
        }
    }
    const bool has_south = has_inside(map, grid, -90.0);
    const bool has_north = has_inside(map, grid, 90.0);
    const bool has_pole = has_south || has_north; // all meridians lead to it
    return {has_south ? -90.0 : box.south, has_pole ? -180.0 : box.west,
            has_north ? 90.0 : box.north, has_pole ? 180.0 : box.east};
}

Json extent_of(const terrain::Heightfield& heightfield, const FullGrid& grid) {
    const glm::dvec2 spacing = heightfield.spacing / static_cast<double>(grid.reduction);
    Json extent{{"width_m", (grid.cols - 1) * spacing.x},
                {"height_m", (grid.rows - 1) * spacing.y}};
    if (heightfield.georeference) {
        const geo::GeodeticArea box = area_of(heightfield.georeference->geodetic, grid);
        extent["south"] = box.south;
        extent["north"] = box.north;
        extent["west"] = box.west;
        extent["east"] = box.east;
    }
    return extent;
}

// Properties of the terrain's file; null for a generated terrain.
Json file_info(const io::SceneDescription& description) {
    const auto info = io::read_raster_info(description.heights);
    if (!info) {
        return {};
    }
    return {
        {"format", info->format}, {"type", info->type}, {"cols", info->cols}, {"rows", info->rows}};
}

Json models_of(const session::TerrainSource& source, const cli::TerrainChoice& choice) {
    Json models = Json::array();
    if (source.description.generator == "gallery") {
        const std::string requested = choice.textures.value_or(source.description.gallery_textures);
        for (const terrains::GalleryModel& model : terrains::gallery_models()) {
            models.push_back(
                {{"name", model.name},
                 {"textures", requested == "mixed" ? std::string(model.textures) : requested}});
        }
    }
    return models;
}

Json tiles_info(const io::TileSet& tiles, const std::optional<geo::GeodeticArea>& area,
                const FullGrid& grid) {
    Json formats = Json::object();
    std::set<std::string> types;
    int count = 0;
    double finest = std::numeric_limits<double>::infinity();
    for (const io::TileFile& file : tiles.files()) {
        if (!area || io::reaches_into(file, *area)) {
            formats[file.format] = formats.value(file.format, 0) + 1;
            types.insert(file.type);
            finest = std::min({finest, file.spacing.x, file.spacing.y});
            ++count;
        }
    }
    return {{"format", "tiles"},
            {"type", fmt::format("{}", fmt::join(types, ", "))},
            {"cols", grid.cols},
            {"rows", grid.rows},
            {"files", count},
            {"formats", std::move(formats)},
            {"finest_spacing_m", finest}};
}

// The grid of the finest tiles in the area.
std::optional<FullGrid> grid_of_tiles(const io::TileSet& tiles,
                                      const std::optional<geo::GeodeticArea>& area,
                                      const terrain::Heightfield& heightfield) {
    const auto grid = area ? tiles.part(tiles.grid(), *area) : Result<io::TileGrid>(tiles.grid());
    if (!grid || !heightfield.georeference) {
        return std::nullopt;
    }
    const geo::PixelAffine& affine = heightfield.georeference->crs_from_pixel;
    const glm::dvec2 step(affine.x_col, affine.y_row);
    FullGrid full{grid->cols, grid->rows, 1, {}, {}};
    full.reduction = static_cast<int>(std::lround(std::abs(step.x / grid->step.x)));
    const glm::dvec2 first = (grid->first - glm::dvec2(affine.x0, affine.y0)) / step -
                             glm::dvec2(0, rows_of(heightfield).wrap().north_rows());
    const glm::dvec2 last = first + grid->step / step * glm::dvec2(grid->cols - 1, grid->rows - 1);
    full.first = read_from_source(heightfield, first);
    full.last = read_from_source(heightfield, last);
    return full;
}

// The grid of a file that is read from its first column and row on.
FullGrid grid_of_file(int cols, int rows, const terrain::Heightfield& heightfield) {
    const int reduction = std::max(1, cols / size_that_was_read(heightfield).x);
    const double half = 0.5 * (reduction - 1);
    const glm::dvec2 last =
        (glm::dvec2(cols - 1, rows - 1) - half) / static_cast<double>(reduction);
    return {cols, rows, reduction, read_from_source(heightfield, glm::dvec2(-half / reduction)),
            read_from_source(heightfield, last)};
}

Json describe(const session::TerrainSource& source, const cli::TerrainChoice& choice) {
    const terrain::Heightfield& heightfield = source.terrain.heightfield;
    const auto area = session::area_of(choice, source.description);
    const Json own_file = source.tiles || !source.description.generator.empty()
                              ? Json()
                              : file_info(source.description);
    const glm::ivec2 read = size_that_was_read(heightfield);
    const FullGrid read_grid = grid_of_file(read.x, read.y, heightfield);
    const FullGrid grid =
        source.tiles ? grid_of_tiles(*source.tiles, area, heightfield).value_or(read_grid)
        : own_file.is_null()
            ? read_grid
            : grid_of_file(own_file["cols"].get<int>(), own_file["rows"].get<int>(), heightfield);
    const Json file = source.tiles ? tiles_info(*source.tiles, area, grid) : own_file;
    Json info;
    info["name"] = source.terrain.name;
    info["cols"] = grid.cols;
    info["rows"] = grid.rows;
    info["type"] = file.is_null() ? Json("Float32") : file["type"];
    info["format"] = file.is_null() ? Json("generated") : file["format"];
    if (const auto& georeference = heightfield.georeference) {
        info["crs"] = {
            {"name", georeference->crs_name},
            {"code", georeference->crs_code},
            {"horizontal_unit", georeference->horizontal_unit},
            {"vertical_datum", georeference->vertical_datum},
            {"geoid", georeference->geoid ? Json(georeference->geoid->name()) : Json(nullptr)}};
    } else {
        info["crs"] = nullptr;
    }
    if (source.tiles) {
        info["tiles"] = {{"files", file["files"]},
                         {"formats", file["formats"]},
                         {"finest_spacing_m", file["finest_spacing_m"]}};
    }
    info["read"] = {{"cols", read.x}, {"rows", read.y}, {"reduction", grid.reduction}};
    const glm::dvec2 spacing = heightfield.spacing / static_cast<double>(grid.reduction);
    info["spacing"] = {{"x_m", spacing.x}, {"y_m", spacing.y}};
    info["extent"] = extent_of(heightfield, grid);
    info["height_range"] = {{"low_m", heightfield.range.low}, {"high_m", heightfield.range.high}};
    info["voids"] = heightfield.void_count;
    info["memory_bytes"] = heightfield.heights.size() * io::bytes_per_sample;
    info["notes"] = source.terrain.notes;
    for (const std::string& note : session::shape_notes(
             source.terrain, choice.exaggeration.value_or(source.description.exaggeration))) {
        info["notes"].push_back(note);
    }
    info["faults"] = source.terrain.errors;
    if (const Json models = models_of(source, choice); !models.empty()) {
        info["models"] = models;
    }
    return info;
}

std::string geoid_text(const Json& crs, const cli::TerrainChoice& choice) {
    if (!crs["geoid"].is_null()) {
        return fmt::format("geoid {} applied on the ellipsoid", crs["geoid"].get<std::string>());
    }
    if (geo::is_ellipsoidal(crs["vertical_datum"].get<std::string>())) {
        return "no geoid needed on the ellipsoid";
    }
    return choice.geoid == "none" ? "geoid not applied: --geoid none"
                                  : "geoid not applied: none given or installed for it";
}

// With so many decimals, or with three digits if these would be lost.
std::string metres(double value, int decimals) {
    const bool is_lost = value != 0.0 && std::abs(value) < 10.0 * std::pow(10.0, -decimals);
    return is_lost ? fmt::format("{:.3g}", value) : fmt::format("{:.{}f}", value, decimals);
}

std::string text(const Json& value) {
    return value.get<std::string>();
}

double number(const Json& value) {
    return value.get<double>();
}

void print_crs(const Json& crs, const cli::TerrainChoice& choice) {
    if (crs.is_null()) {
        fmt::print("  CRS      none\n");
        return;
    }
    const std::string code = text(crs["code"]);
    const std::string datum = text(crs["vertical_datum"]);
    fmt::print("  CRS      {}{}\n", text(crs["name"]), code.empty() ? "" : " (" + code + ")");
    fmt::print("  zero     {}; {}\n", datum.empty() ? "unnamed" : datum, geoid_text(crs, choice));
}

void print_text(const Json& info, const cli::TerrainChoice& choice) {
    fmt::print("{}: {} x {} {} ({})\n", text(info["name"]), info["cols"].dump(),
               info["rows"].dump(), text(info["type"]), text(info["format"]));
    print_crs(info["crs"], choice);
    if (info.contains("tiles")) {
        fmt::print("  tiles    {} {}\n", info["tiles"]["files"].dump(),
                   info["tiles"]["formats"].dump());
    }
    const Json& extent = info["extent"];
    fmt::print("  spacing  {} x {} m\n", metres(number(info["spacing"]["x_m"]), 4),
               metres(number(info["spacing"]["y_m"]), 4));
    fmt::print("  extent   {} x {} m\n", metres(number(extent["width_m"]), 1),
               metres(number(extent["height_m"]), 1));
    if (extent.contains("south")) {
        fmt::print("           latitude {:.6f} to {:.6f}, longitude {:.6f} to {:.6f}\n",
                   number(extent["south"]), number(extent["north"]), number(extent["west"]),
                   number(extent["east"]));
    }
    if (const Json& read = info["read"]; read["reduction"] != 1) {
        fmt::print("  read     {} x {} samples, each the average of {} x {}: so are the heights "
                   "and voids below\n",
                   read["cols"].dump(), read["rows"].dump(), read["reduction"].dump(),
                   read["reduction"].dump());
    }
    fmt::print("  heights  {} to {} m\n", metres(number(info["height_range"]["low_m"]), 2),
               metres(number(info["height_range"]["high_m"]), 2));
    fmt::print("  voids    {}\n", info["voids"].dump());
    fmt::print("  memory   {:.1f} MB when drawn\n", number(info["memory_bytes"]) * 1e-6);
    for (const auto& model : info.value("models", Json::array())) {
        fmt::print("  model    {}, with the detail texture {}\n", text(model["name"]),
                   text(model["textures"]));
    }
    for (const auto& note : info["notes"]) {
        fmt::print("  note     {}\n", text(note));
    }
    for (const auto& error : info["faults"]) {
        fmt::print("  left out {}\n", text(error));
    }
}

class ProgressLog : public cli::ConsoleLog {
public:
    using cli::ConsoleLog::ConsoleLog;
    void message(session::MessageKind /*kind*/, std::string_view /*sentence*/) override {}
};

Result<void> print_info(const InfoChoice& choice, const cli::Interrupt& interrupt) {
    ProgressLog log(choice.terrain.quiet);
    auto source = session::open_terrain(choice.terrain, log, interrupt.token());
    if (!source) {
        return source.error();
    }
    const Json info = describe(*source, choice.terrain);
    if (choice.json) {
        fmt::print("{}\n", info.dump(2, ' ', false, Json::error_handler_t::replace));
    } else {
        print_text(info, choice.terrain);
    }
    return session::report_errors(choice.terrain.terrain, source->terrain.errors.size());
}

} // namespace

cli::Command add_info_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand("info", "print the properties of a terrain");
    auto choice = std::make_shared<InfoChoice>();
    cli::add_terrain_options(*arguments, choice->terrain);
    arguments->add_flag("--json", choice->json, "print JSON");
    arguments->footer("Examples:\n  reljef info N45E006.hgt\n  reljef info dem.tif --json");
    return {arguments, [choice, &interrupt] {
                return cli::with_standard_input(choice->terrain.terrain, interrupt.token(),
                                                [&] { return print_info(*choice, interrupt); });
            }};
}

} // namespace reljef::app
