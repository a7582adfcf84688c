#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/console_log.h"
#include "app/cli/options.h"
#include "app/cli/output_files.h"
#include "app/cli/parsed_option.h"
#include "app/cli/standard_input.h"
#include "app/commands.h"
#include "app/place_file.h"
#include "engine/session/measuring/terrain_viewshed.h"
#include "engine/session/terrain_source.h"

namespace reljef::app {
namespace {

struct ViewshedChoice {
    cli::TerrainChoice terrain;
    session::ViewshedRequest request;
    std::string output;
};

constexpr double max_eye_height = 1e6; // metres

// LAT,LON or LAT,LON,HEIGHT; throws CLI::ValidationError.
void read_eye(const std::string& text, session::ViewshedRequest& request) {
    constexpr const char* expected = "LAT,LON or LAT,LON,HEIGHT in degrees and metres";
    const auto three = cli::parse_numbers<3>("--from", text, expected);
    const auto two = cli::parse_numbers<2>("--from", text, expected);
    if (!two && !three) {
        throw CLI::ValidationError(two.error().message);
    }
    request.from = two ? glm::dvec2((*two)[0], (*two)[1]) : glm::dvec2((*three)[0], (*three)[1]);
    request.eye_height = three ? (*three)[2] : request.eye_height;
    if (!is_place(request.from) || !(request.eye_height >= 0.0) ||
        !(request.eye_height <= max_eye_height)) {
        throw CLI::ValidationError(fmt::format(
            "--from: {} found, a latitude from -90 to 90, a longitude in degrees and a height "
            "above the ground from 0 to {} m were expected",
            text, max_eye_height));
    }
}

Result<void> make_viewshed(const ViewshedChoice& choice, const cli::Interrupt& interrupt) {
    cli::ConsoleLog log(choice.terrain.quiet);
    const cli::NamedFile output{"-o", choice.output};
    if (auto writable = cli::check_writable({&output, 1}); !writable) {
        return writable;
    }
    const auto source = session::open_terrain(choice.terrain, log, interrupt.token());
    if (!source) {
        return source.error();
    }
    session::ViewshedRequest request = choice.request;
    request.placement = choice.terrain.placement.value_or(request.placement);
    const auto task = log.start("viewshed of " + source->terrain.name);
    const auto found =
        session::viewshed_of(source->terrain, request,
                             {.threads = static_cast<unsigned>(choice.terrain.threads),
                              .stop = interrupt.token(),
                              .progress = task->callback()});
    if (!found) {
        return found.error();
    }
    if (auto written = session::write_viewshed(choice.output, *found, source->terrain.heightfield);
        !written) {
        return written;
    }
    log.note(fmt::format("{:.2f} % of the terrain is visible", 100.0 * found->visible_share));
    return session::report_errors(choice.terrain.terrain, source->terrain.errors.size());
}

void add_viewshed_options(CLI::App& arguments, ViewshedChoice& choice) {
    arguments
        .add_option_function<std::string>(
            "--from", [&choice](const std::string& text) { read_eye(text, choice.request); },
            "latitude and longitude of the eye, degrees, and its height above the ground, metres "
            "(2)")
        ->type_name("LAT,LON[,HEIGHT]")
        ->required();
    cli::add_parsed(arguments, "--target-height", choice.request.target_height,
                    cli::number_in("--target-height", 0.0, max_eye_height),
                    "height of what is looked at above the ground, metres (0)", "M");
    cli::add_parsed(arguments, "--max-distance", choice.request.max_distance,
                    cli::number_in("--max-distance", 0.0, 1e9, true),
                    "samples farther away count as hidden, metres (no limit)", "M");
    cli::add_parsed(arguments, "--placement", choice.terrain.placement,
                    cli::word_of<std::optional<terrain::PlacementKind>>(
                        "--placement", {{"plane", terrain::PlacementKind::plane},
                                        {"ellipsoid", terrain::PlacementKind::ellipsoid}}),
                    "ellipsoid: the Earth is curved; plane: it is flat (ellipsoid)", "KIND");
    arguments.add_option("-o,--output", choice.output, "GeoTIFF (.tif) or picture (.png, ...)")
        ->type_name("FILE")
        ->required();
}

} // namespace

cli::Command add_viewshed_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand("viewshed", "what can be seen from a place");
    auto choice = std::make_shared<ViewshedChoice>();
    cli::add_source_options(*arguments, choice->terrain);
    add_viewshed_options(*arguments, *choice);
    arguments->callback([choice] {
        if (auto good = session::check_viewshed_name(choice->output); !good) {
            throw CLI::ValidationError("-o: " + good.error().message);
        }
        const cli::NamedFile output{"-o", choice->output};
        const cli::NamedFile input{"TERRAIN", choice->terrain.terrain};
        cli::check_distinct({&output, 1}, {&input, 1});
    });
    arguments->footer(
        "Casts an exact ray from the eye to each sample. A sample is 255 if it is visible, 0 if it "
        "is hidden,\nand 128 on a void. On the ellipsoid the Earth is curved; the air bends no "
        "rays (gdal_viewshed -cc 1).\nA terrain that does not fit --memory is read at a coarser "
        "spacing, and a note says so.\n"
        "Examples:\n"
        "  reljef viewshed N45E006.hgt --from 45.8326,6.8652,2 -o montblanc.tif\n"
        "  reljef viewshed alps.tif --from 46.5,8.0,30 --target-height 2 --max-distance 50000 -o "
        "seen.png");
    return {arguments, [choice, &interrupt] {
                return cli::with_standard_input(choice->terrain.terrain, interrupt.token(),
                                                [&] { return make_viewshed(*choice, interrupt); });
            }};
}

} // namespace reljef::app
