#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/command.h"
#include "app/options.h"
#include "app/terrain_source.h"
#include "engine/io/raster.h"
#include "terrains/gallery.h"

namespace reljef::app {
namespace {

using Json = nlohmann::ordered_json;

struct InfoChoice {
    TerrainChoice terrain;
    bool json = false;
};

// The first and the last sample that the source itself has: without those that close the globe.
std::pair<glm::dvec2, glm::dvec2> source_samples(const terrain::Heightfield& heightfield) {
    const geo::Closing closing = heightfield.georeference
                                     ? heightfield.georeference->geodetic.rows().closing()
                                     : geo::Closing{};
    const glm::ivec2 last(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1);
    return {glm::dvec2(0, closing.north_rows()),
            glm::dvec2(last - glm::ivec2(closing.cols(), closing.south_rows()))};
}

glm::ivec2 source_size(const terrain::Heightfield& heightfield) {
    const auto [first, last] = source_samples(heightfield);
    return glm::ivec2(last - first) + 1;
}

Json extent_of(const terrain::Heightfield& heightfield) {
    const auto [first, last] = source_samples(heightfield);
    const double cols = last.x - first.x;
    const double rows = last.y - first.y;
    Json extent{{"width_m", cols * heightfield.spacing.x},
                {"height_m", rows * heightfield.spacing.y}};
    if (!heightfield.georeference) {
        return extent;
    }
    double south = 90.0;
    double north = -90.0;
    double west = 1e9;
    double east = -1e9;
    constexpr int steps = 32;
    for (int i = 0; i <= steps; ++i) {
        const double t = static_cast<double>(i) / steps;
        for (const glm::dvec2 sample : {glm::dvec2(t * cols, 0.0), glm::dvec2(t * cols, rows),
                                        glm::dvec2(0.0, t * rows), glm::dvec2(cols, t * rows)}) {
            const auto place =
                heightfield.georeference->geodetic.latitude_longitude(sample + first);
            south = std::min(south, place.x);
            north = std::max(north, place.x);
            west = std::min(west, place.y);
            east = std::max(east, place.y);
        }
    }
    extent["south"] = south;
    extent["north"] = north;
    extent["west"] = west;
    extent["east"] = east;
    return extent;
}

// What the terrain's own file says; a generated one has none.
Json file_info(const io::SceneDescription& description) {
    const auto info = io::read_raster_info(description.heights);
    if (!info) {
        return {};
    }
    return {
        {"format", info->format}, {"type", info->type}, {"cols", info->cols}, {"rows", info->rows}};
}

// What stands on the gallery's floor, with the tiles it shows.
Json models_of(const TerrainSource& source, const TerrainChoice& choice) {
    Json models = Json::array();
    if (source.description.generator == "gallery") {
        const std::string asked_for = choice.textures.value_or(source.description.gallery_textures);
        for (const terrains::GalleryModel& model : terrains::gallery_models()) {
            models.push_back(
                {{"name", model.name},
                 {"textures", asked_for == "mixed" ? std::string(model.textures) : asked_for}});
        }
    }
    return models;
}

// Samples of the finest tiles in one that was read.
int reduction_of(const io::TileSet& tiles, const terrain::Heightfield& heightfield) {
    const auto& georeference = heightfield.georeference;
    const double steps =
        georeference ? std::abs(georeference->crs_from_pixel.x_col / tiles.grid().step.x) : 1.0;
    return static_cast<int>(std::lround(steps));
}

// A folder: how many files of which format, and the samples of its part at the finest spacing.
Json tiles_info(const io::TileSet& tiles, const std::optional<io::GeodeticArea>& area,
                const terrain::Heightfield& heightfield) {
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
    const int reduction = reduction_of(tiles, heightfield);
    return {{"format", "tiles"},
            {"type", fmt::format("{}", fmt::join(types, ", "))},
            {"cols", source_size(heightfield).x * reduction},
            {"rows", source_size(heightfield).y * reduction},
            {"files", count},
            {"formats", std::move(formats)},
            {"finest_spacing_m", finest}};
}

Json geoid_info(const geo::Georeference& georeference) {
    return georeference.geoid ? Json(georeference.geoid->name()) : Json(nullptr);
}

int reduction_of(const terrain::Heightfield& heightfield, const Json& cols) {
    return std::max(1, cols.get<int>() / source_size(heightfield).x);
}

Json describe(const TerrainSource& source, const TerrainChoice& choice) {
    const terrain::Heightfield& heightfield = source.terrain.heightfield;
    const auto& area = choice.area ? choice.area : source.description.area;
    const Json file = source.tiles ? tiles_info(*source.tiles, area, heightfield)
                      : source.description.generator.empty() ? file_info(source.description)
                                                             : Json();
    Json info;
    info["name"] = source.terrain.name;
    const glm::ivec2 size = source_size(heightfield);
    info["cols"] = file.is_null() ? Json(size.x) : file["cols"];
    info["rows"] = file.is_null() ? Json(size.y) : file["rows"];
    info["type"] = file.is_null() ? Json("Float32") : file["type"];
    info["format"] = file.is_null() ? Json("generated") : file["format"];
    if (const auto& georeference = heightfield.georeference) {
        info["crs"] = {{"name", georeference->crs_name},
                       {"code", georeference->crs_code},
                       {"horizontal_unit", georeference->horizontal_unit},
                       {"vertical_datum", georeference->vertical_datum},
                       {"geoid", geoid_info(*georeference)}};
    } else {
        info["crs"] = nullptr;
    }
    if (source.tiles) {
        info["tiles"] = {{"files", file["files"]},
                         {"formats", file["formats"]},
                         {"finest_spacing_m", file["finest_spacing_m"]}};
    }
    // What was read within the memory is all or a whole-number part of the file.
    info["read"] = {
        {"cols", size.x}, {"rows", size.y}, {"reduction", reduction_of(heightfield, info["cols"])}};
    const glm::dvec2 spacing = heightfield.spacing / info["read"]["reduction"].get<double>();
    info["spacing"] = {{"x_m", spacing.x}, {"y_m", spacing.y}};
    info["extent"] = extent_of(heightfield);
    info["height_range"] = {{"low_m", heightfield.range.low}, {"high_m", heightfield.range.high}};
    info["voids"] = heightfield.void_count;
    info["memory_bytes"] = heightfield.heights.size() * io::bytes_per_sample;
    info["notes"] = source.terrain.notes;
    info["faults"] = source.terrain.faults;
    if (const Json models = models_of(source, choice); !models.empty()) {
        info["models"] = models;
    }
    return info;
}

// What heights count from, and whether the geoid is applied.
void print_vertical(const Json& crs) {
    if (crs.is_null()) {
        return;
    }
    const auto datum = crs["vertical_datum"].get<std::string>();
    const std::string geoid =
        crs["geoid"].is_null()
            ? "geoid not applied: none given or installed for it"
            : fmt::format("geoid {} applied on the ellipsoid", crs["geoid"].get<std::string>());
    fmt::print("  zero     {}; {}\n", datum.empty() ? std::string("unnamed") : datum, geoid);
}

void print_text(const Json& info) {
    const auto number = [&](const char* group, const char* key) {
        return info[group][key].get<double>();
    };
    fmt::print("{}: {} x {} {} ({})\n", info["name"].get<std::string>(), info["cols"].get<int>(),
               info["rows"].get<int>(), info["type"].get<std::string>(),
               info["format"].get<std::string>());
    if (info["crs"].is_null()) {
        fmt::print("  CRS      none\n");
    } else {
        const auto code = info["crs"]["code"].get<std::string>();
        fmt::print("  CRS      {}{}\n", info["crs"]["name"].get<std::string>(),
                   code.empty() ? "" : " (" + code + ")");
    }
    print_vertical(info["crs"]);
    if (info.contains("tiles")) {
        fmt::print("  tiles    {} {}\n", info["tiles"]["files"].get<std::size_t>(),
                   info["tiles"]["formats"].dump());
    }
    fmt::print("  spacing  {:.4f} x {:.4f} m\n", number("spacing", "x_m"),
               number("spacing", "y_m"));
    fmt::print("  extent   {:.1f} x {:.1f} m\n", number("extent", "width_m"),
               number("extent", "height_m"));
    if (info["extent"].contains("south")) {
        fmt::print("           latitude {:.6f} to {:.6f}, longitude {:.6f} to {:.6f}\n",
                   number("extent", "south"), number("extent", "north"), number("extent", "west"),
                   number("extent", "east"));
    }
    if (info["read"]["reduction"] != 1) {
        fmt::print("  read     {} x {} samples, each the average of {} x {}: so are the heights "
                   "below\n",
                   info["read"]["cols"].get<int>(), info["read"]["rows"].get<int>(),
                   info["read"]["reduction"].get<int>(), info["read"]["reduction"].get<int>());
    }
    fmt::print("  heights  {:.2f} to {:.2f} m\n", number("height_range", "low_m"),
               number("height_range", "high_m"));
    fmt::print("  voids    {}\n", info["voids"].get<std::size_t>());
    fmt::print("  memory   {:.1f} MB when drawn\n", info["memory_bytes"].get<double>() * 1e-6);
    for (const auto& model : info.value("models", Json::array())) {
        fmt::print("  model    {}, with a tile of {}\n", model["name"].get<std::string>(),
                   model["textures"].get<std::string>());
    }
    for (const auto& note : info["notes"]) {
        fmt::print("  note     {}\n", note.get<std::string>());
    }
    for (const auto& fault : info["faults"]) {
        fmt::print("  left out {}\n", fault.get<std::string>());
    }
}

Result<void> print_info(const InfoChoice& choice, const Interrupt& interrupt) {
    auto source = open_terrain(choice.terrain, interrupt.token(), Notes::kept);
    if (!source) {
        return source.error();
    }
    const Json info = describe(*source, choice.terrain);
    if (choice.json) {
        fmt::print("{}\n", info.dump(2, ' ', false, Json::error_handler_t::replace));
    } else {
        print_text(info);
    }
    return {};
}

} // namespace

Command add_info_command(CLI::App& program, Interrupt& interrupt) {
    auto* arguments = program.add_subcommand("info", "say what a terrain holds");
    auto choice = std::make_shared<InfoChoice>();
    add_terrain_options(*arguments, choice->terrain);
    arguments->add_flag("--json", choice->json, "as JSON");
    arguments->footer("Examples:\n  reljef info N45E006.hgt\n  reljef info dem.tif --json");
    return {arguments, [choice, &interrupt] { return print_info(*choice, interrupt); }};
}

} // namespace reljef::app
