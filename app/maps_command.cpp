#include <algorithm>
#include <array>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/console_log.h"
#include "app/cli/output_files.h"
#include "app/cli/parsed_option.h"
#include "app/commands.h"
#include "engine/core/atomic_file.h"
#include "engine/io/image/surface_maps.h"
#include "engine/io/raster/raster.h"
#include "engine/material/straight_walls.h"
#include "engine/session/measuring/straight_heights.h"
#include "engine/session/terrain_source.h"

namespace reljef::app {
namespace {

using io::MapInput;
using io::MapKind;

struct MapOutput {
    MapKind kind;
    std::string option;
    const char* meaning;
    std::string file = {}; // empty: not requested
};

// A terrain whose walls look straight, instead of maps.
struct StraightChoice {
    std::string output; // empty: not requested
    std::optional<double> wall_height;
    int memory_megabytes = 512;
};

struct MapChoice {
    std::string picture;
    StraightChoice straight;
    std::string back; // heights of the back; empty: none
    io::SurfaceMapOptions making;
    int threads = 0;
    bool quiet = false;
    std::array<MapOutput, 6> outputs{
        {{MapKind::heights, "--heights", "heights; computed heights range from black to white"},
         {MapKind::normals, "--normals", "normals of the heights: x, y, z in r, g, b"},
         {MapKind::combined, "--combined", "normals in r, g, b and heights in alpha"},
         {MapKind::cones, "--cones",
          "cone map: an empty cone above each texel (Dummer 2006). The value is the radius in "
          "texels at height 1; formats other than .exr store the square root of radius / 1024"},
         {MapKind::relaxed_cones, "--relaxed-cones",
          "relaxed cone map: a ray in a cone crosses the surface at most once (GPU Gems 3 ch. "
          "18); values as for --cones"},
         {MapKind::layers, "--layers",
          "depths of the layers of a sheet. Without --back, the back equals the front"}}};
};

std::vector<cli::NamedFile> outputs_of(const MapChoice& choice) {
    std::vector<cli::NamedFile> files;
    for (const MapOutput& output : choice.outputs) {
        if (!output.file.empty()) {
            files.push_back({output.option, output.file});
        }
    }
    return files;
}

Result<Grid<float>> read_heights(const std::string& picture, const io::SurfaceMapOptions& options,
                                 session::Log& log) {
    auto read = io::heights_of_picture(picture, options);
    if (!read) {
        return read.error();
    }
    for (const std::string& note : read->notes) {
        log.note(note);
    }
    return std::move(read->heights);
}

// Heights of a sheet's back; empty if none is named.
Result<Grid<float>> read_back(const MapChoice& choice, const Grid<float>& front,
                              session::Log& log) {
    if (choice.back.empty()) {
        return Grid<float>();
    }
    io::SurfaceMapOptions options = choice.making;
    options.input = MapInput::heights;
    auto back = read_heights(choice.back, options, log);
    if (back && (back->cols() != front.cols() || back->rows() != front.rows())) {
        return Error{fmt::format("--back: {}: {} x {} texels found, {} x {} were expected: one "
                                 "size, that of {}",
                                 choice.back, back->cols(), back->rows(), front.cols(),
                                 front.rows(), choice.picture)};
    }
    return back;
}

// A map in a file that is not committed.
Result<AtomicFile> make_map(const MapOutput& output, const Grid<float>& heights,
                            const Grid<float>& back, io::SurfaceMapOptions options,
                            session::Log& log) {
    std::unique_ptr<session::Task> task;
    if (output.kind == MapKind::cones || output.kind == MapKind::relaxed_cones) {
        task = log.start(output.kind == MapKind::cones ? "cones" : "relaxed cones");
        options.parallel.progress = task->callback();
    }
    const bool as_floats = output.file.ends_with(".exr");
    const auto map = io::make_map(heights, output.kind, back, as_floats, options);
    if (!map) {
        return map.error();
    }
    const auto bytes = io::encode_channels(output.file, *map);
    return bytes ? prepare_file(output.file, *bytes)
                 : Error{fmt::format("{}: cannot be written: {}", output.file,
                                     bytes.error().message)};
}

Result<void> make_maps(const MapChoice& choice, const cli::Interrupt& interrupt) {
    const std::array<cli::NamedFile, 2> inputs{
        {{"PICTURE", choice.picture}, {"--back", choice.back}}};
    const auto outputs = outputs_of(choice);
    cli::check_distinct(outputs, inputs);
    if (auto good = cli::check_writable(outputs); !good) {
        return good;
    }
    cli::ConsoleLog log(choice.quiet);
    io::SurfaceMapOptions options = choice.making;
    options.parallel.threads = static_cast<unsigned>(choice.threads);
    options.parallel.stop = interrupt.token();
    const auto heights = read_heights(choice.picture, options, log);
    if (!heights) {
        return heights.error();
    }
    const auto back = read_back(choice, *heights, log);
    if (!back) {
        return back.error();
    }
    std::vector<AtomicFile> files;
    for (const MapOutput& output : choice.outputs) {
        if (output.file.empty()) {
            continue;
        }
        auto file = make_map(output, *heights, *back, options, log);
        if (!file) {
            return file.error();
        }
        files.push_back(std::move(*file));
    }
    return interrupt.requested() ? Error{"interrupted"} : commit_all(files);
}

Result<void> make_straight(const MapChoice& choice, const cli::Interrupt& interrupt) {
    const cli::NamedFile output{"--straight-walls", choice.straight.output};
    const auto description = session::describe(choice.picture);
    if (!description) {
        return description.error();
    }
    std::vector<cli::NamedFile> inputs{{"PICTURE", choice.picture}};
    for (const auto& [what, file] : io::named_files(*description)) {
        inputs.push_back({what, file});
    }
    cli::check_distinct({&output, 1}, inputs);
    if (auto good = cli::check_writable({&output, 1}); !good) {
        return good;
    }
    cli::ConsoleLog log(choice.quiet);
    session::SourceOptions source;
    source.terrain = choice.picture;
    source.threads = choice.threads;
    source.memory_megabytes = choice.straight.memory_megabytes;
    const auto terrain = session::open_terrain(source, log, interrupt.token());
    if (!terrain) {
        return terrain.error();
    }
    const auto task = log.start("straight walls of " + terrain->terrain.name);
    const auto changed = session::write_straight_heights(
        choice.straight.output, terrain->terrain, choice.straight.wall_height,
        {static_cast<unsigned>(choice.threads), interrupt.token(), task->callback()});
    if (!changed) {
        return changed.error();
    }
    log.note(fmt::format("{} of {} samples changed, all at walls, by at most {:.2f} m",
                         changed->changed, terrain->terrain.heightfield.heights.size(),
                         changed->largest));
    return session::report_errors(choice.picture, terrain->terrain.errors.size());
}

Result<void> run(const MapChoice& choice, const cli::Interrupt& interrupt) {
    return choice.straight.output.empty() ? make_maps(choice, interrupt)
                                          : make_straight(choice, interrupt);
}

bool asks_for(const MapChoice& choice, std::initializer_list<MapKind> kinds) {
    return std::any_of(choice.outputs.begin(), choice.outputs.end(), [&](const MapOutput& output) {
        return !output.file.empty() &&
               std::find(kinds.begin(), kinds.end(), output.kind) != kinds.end();
    });
}

// Throws CLI::ParseError without an output, or for a wrong format.
void expect_outputs(const MapChoice& choice) {
    const auto outputs = outputs_of(choice);
    const std::string& straight = choice.straight.output;
    if (!straight.empty() && !outputs.empty()) {
        throw CLI::ValidationError(fmt::format(
            "--straight-walls: found beside {}, one of them was expected", outputs.front().option));
    }
    if (!straight.empty() && !io::names_geotiff(straight)) {
        throw CLI::ValidationError(
            fmt::format("--straight-walls: {} found, a name with .tif was expected", straight));
    }
    if (outputs.empty() && straight.empty()) {
        throw CLI::ValidationError("maps: no output found, --heights, --normals, --combined, "
                                   "--cones, --relaxed-cones, --layers or --straight-walls was "
                                   "expected");
    }
    for (const cli::NamedFile& file : outputs) {
        if (const auto good = io::check_map_name(file.path); !good) {
            throw CLI::ValidationError(fmt::format("{}: {}", file.option, good.error().message));
        }
    }
}

// Throws CLI::ParseError for an option without effect.
void expect_used(const CLI::App& arguments, const MapChoice& choice) {
    const bool makes_normals = asks_for(choice, {MapKind::normals, MapKind::combined});
    const bool has_normals = makes_normals || choice.making.input == MapInput::normals;
    const bool makes_cones = asks_for(choice, {MapKind::cones, MapKind::relaxed_cones});
    const bool has_border = has_normals || makes_cones || choice.making.input == MapInput::colors;
    struct Use {
        const char* option;
        bool has_use;
        const char* expected;
    };
    for (const Use& use :
         {Use{"--back", asks_for(choice, {MapKind::layers}), "--layers"},
          Use{"--wall-height", !choice.straight.output.empty(), "--straight-walls"},
          Use{"--memory", !choice.straight.output.empty(), "--straight-walls"},
          Use{"--from", choice.straight.output.empty(), "another output"},
          Use{"--octaves", choice.making.input == MapInput::colors, "--from colors"},
          Use{"--dark-is-high", choice.making.input == MapInput::colors, "--from colors"},
          Use{"--sobel", makes_normals, "--normals or --combined"},
          Use{"--green", has_normals, "normals, read or made,"},
          Use{"--scale", has_normals, "normals, read or made,"},
          Use{"--border", has_border, "normals, cones or --from colors"}}) {
        if (arguments.count(use.option) > 0 && !use.has_use) {
            throw CLI::ValidationError(fmt::format(
                "{}: found without a use, beside it {} was expected", use.option, use.expected));
        }
    }
}

void add_straight_options(CLI::App& arguments, StraightChoice& choice) {
    arguments
        .add_option("--straight-walls", choice.output,
                    "GeoTIFF of the terrain with walls that look straight: samples at walls get "
                    "heights between roof and ground")
        ->type_name("FILE");
    cli::add_parsed(
        arguments, "--wall-height", choice.wall_height,
        cli::number_in("--wall-height", 0.0, 1e4, true),
        "least rise around a sample that is a wall, metres (2.5, or the spacing if that "
        "is more)",
        "M");
    cli::add_parsed(arguments, "--memory", choice.memory_megabytes,
                    cli::number_in<int>("--memory", 1, 1 << 20),
                    "MB for the terrain of --straight-walls (512)", "MB");
}

void add_map_options(CLI::App& arguments, MapChoice& choice) {
    arguments
        .add_option("PICTURE", choice.picture,
                    "picture to make maps from; for --straight-walls a terrain")
        ->required();
    cli::add_parsed(arguments, "--from", choice.making.input,
                    cli::word_of<MapInput>("--from", {{"heights", MapInput::heights},
                                                      {"normals", MapInput::normals},
                                                      {"colors", MapInput::colors}}),
                    "content of the picture: heights, normals or colors (heights)", "KIND");
    arguments.add_option("--back", choice.back, "heights of the back of a sheet, for --layers")
        ->type_name("FILE");
    cli::add_parsed(
        arguments, "--border", choice.making.border,
        cli::word_of<material::WrapMode>(
            "--border", {{"wrap", material::WrapMode::wrap}, {"clamp", material::WrapMode::clamp}}),
        "beyond the picture: wrap repeats it, clamp repeats its border (wrap)", "RULE");
    cli::add_parsed(arguments, "--scale", choice.making.scale,
                    cli::number_in("--scale", 0.0, 1000.0, true),
                    "height of a value of 1, in widths of the picture (0.05)", "S");
    cli::add_parsed(arguments, "--octaves", choice.making.octaves,
                    cli::number_in<int>("--octaves", 1, 12),
                    "from colors: number of octaves of relief, each twice as coarse (5)", "N");
    arguments.add_flag("--dark-is-high", choice.making.dark_is_high,
                       "from colors: darker is higher");
    cli::add_parsed(arguments, "--green", choice.making.green_up,
                    cli::word_of<bool>("--green", {{"down", false}, {"up", true}}),
                    "direction of the green channel: down (row order) or up (down)", "WAY");
    arguments.add_flag("--sobel", choice.making.sobel,
                       "compute normals with Sobel's filter instead of bilinear slopes");
    cli::add_parsed(arguments, "--threads", choice.threads,
                    cli::number_in<int>("--threads", 0, 1024),
                    "number of threads; 0: one per processor (0)", "N");
    arguments.add_flag("--quiet", choice.quiet, "print no progress and no notes");
}

} // namespace

cli::Command add_maps_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand("maps", "make maps of surface detail from a picture");
    auto choice = std::make_shared<MapChoice>();
    add_map_options(*arguments, *choice);
    for (MapOutput& output : choice->outputs) {
        arguments->add_option(output.option, output.file, output.meaning)->type_name("FILE");
    }
    add_straight_options(*arguments, choice->straight);
    arguments->callback([arguments, choice] {
        expect_outputs(*choice);
        expect_used(*arguments, *choice);
    });
    arguments->footer(
        "Maps are .png or .tif files with 16 bits per channel, or .exr files with floats. If one "
        "map fails, no file is written. Heights from colors are estimates, not measurements.\n"
        "Examples:\n"
        "  reljef maps wall_height.png --normals wall_normal.png --scale 0.08\n"
        "  reljef maps wall.jpg --from colors --heights wall_height.png --combined wall_both.png\n"
        "  reljef maps wall_normal.png --from normals --heights wall_height.png\n"
        "  reljef maps wall_height.png --cones wall_cones.exr --relaxed-cones wall_relaxed.exr\n"
        "  reljef maps front.png --back back.png --layers sheet_layers.png\n"
        "  reljef maps city_dsm.tif --straight-walls city_straight.tif --wall-height 3");
    return {arguments, [choice, &interrupt] { return run(*choice, interrupt); }};
}

} // namespace reljef::app
