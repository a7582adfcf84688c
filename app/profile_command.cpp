#include <cmath>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/console_log.h"
#include "app/cli/message.h"
#include "app/cli/options.h"
#include "app/cli/parsed_option.h"
#include "app/cli/standard_input.h"
#include "app/commands.h"
#include "app/place_file.h"
#include "engine/core/atomic_file.h"
#include "engine/session/measuring/terrain_profile.h"

namespace reljef::app {
namespace {

struct ProfileChoice {
    cli::TerrainChoice terrain;
    session::ProfileRequest request;
    std::string output = "-";
};

// For the option --from or --to.
auto place_from(std::string option) {
    return [option = std::move(option)](const std::string& text) -> Result<glm::dvec2> {
        const auto numbers = cli::parse_numbers<2>(option, text, "LAT,LON in degrees");
        if (!numbers) {
            return numbers.error();
        }
        const glm::dvec2 place((*numbers)[0], (*numbers)[1]);
        return is_place(place)
                   ? Result<glm::dvec2>(place)
                   : Error{fmt::format("{}: {} found, a latitude from -90 to 90 and a longitude "
                                       "in degrees were expected",
                                       option, text)};
    };
}

std::string summary_text(const terrain::ProfileSummary& found) {
    std::string text = fmt::format(
        "{:.1f} m along the geodesic, {:.1f} m over the ground, climb {:.1f} m, "
        "descent {:.1f} m, heights {:.1f} to {:.1f} m",
        found.distance, found.over_ground, found.climb, found.descent, found.lowest, found.highest);
    return found.missing > 0 ? text + fmt::format(", {} points without a height", found.missing)
                             : text;
}

Result<void> print_profile(const ProfileChoice& choice, const cli::Interrupt& interrupt) {
    cli::ConsoleLog log(choice.terrain.quiet);
    const auto source =
        session::open_heights(choice.terrain, session::HeightUse::at_places, interrupt.token());
    if (!source) {
        return source.error();
    }
    const auto profile =
        session::profile_of(*source, choice.request, choice.terrain.terrain, interrupt.token());
    if (!profile) {
        return profile.error();
    }
    for (const FileError& error : profile->errors) {
        log.message(session::MessageKind::left_out, error.message);
    }
    const std::string csv = session::profile_csv(*profile);
    if (choice.output == "-") {
        static_cast<void>(std::fwrite(csv.data(), 1, csv.size(), stdout));
    } else if (auto written = write_text_file(choice.output, csv); !written) {
        return written;
    }
    log.note(summary_text(terrain::summarize(profile->points)));
    return session::report_errors(choice.terrain.terrain,
                                  source->tiles.errors().size() + profile->errors.size());
}

} // namespace

cli::Command add_profile_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand("profile", "heights along a geodesic, as CSV");
    auto choice = std::make_shared<ProfileChoice>();
    cli::add_source_options(*arguments, choice->terrain);
    cli::add_parsed(*arguments, "--from", choice->request.from, place_from("--from"),
                    "latitude and longitude of the start, degrees", "LAT,LON")
        ->required();
    cli::add_parsed(*arguments, "--to", choice->request.to, place_from("--to"),
                    "latitude and longitude of the end, degrees", "LAT,LON")
        ->required();
    cli::add_parsed(*arguments, "--step", choice->request.step,
                    cli::number_in("--step", 0.0, 1e9, true),
                    "largest distance between points, metres (half of the finest spacing)", "M");
    arguments->add_option("-o,--output", choice->output, "CSV file; - for standard output (-)")
        ->type_name("FILE");
    arguments->callback([choice] {
        const cli::NamedFile output{"-o", choice->output == "-" ? "" : choice->output};
        const cli::NamedFile input{"TERRAIN", choice->terrain.terrain};
        cli::check_distinct({&output, 1}, {&input, 1});
    });
    arguments->footer(
        "Prints the heading distance,latitude,longitude,height and a line for each point: metres "
        "along the\ngeodesic, degrees, metres above the DEM's zero (nan on voids and outside). "
        "Both ends are points.\nThe heights are those of the source files at full resolution, "
        "whatever their size. A note on stderr\nsums up: distance, length over the ground, climb, "
        "descent, lowest and highest.\n"
        "Examples:\n"
        "  reljef profile N45E006.hgt --from 45.83,6.86 --to 45.92,6.87 -o montblanc.csv\n"
        "  reljef profile tiles/ --from 45.2,6.1 --to 45.8,6.9 --step 100");
    return {arguments, [choice, &interrupt] {
                return cli::with_standard_input(choice->terrain.terrain, interrupt.token(),
                                                [&] { return print_profile(*choice, interrupt); });
            }};
}

} // namespace reljef::app
