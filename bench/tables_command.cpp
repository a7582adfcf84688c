#include <memory>

#include "app/cli/options.h"
#include "app/cli/parsed_option.h"
#include "app/cli/usage_error.h"
#include "bench/claims/claim_suite.h"
#include "bench/claims/distance_suite.h"
#include "bench/claims/guess_suite.h"
#include "bench/commands.h"
#include "bench/options/output_options.h"
#include "bench/options/suite_arguments.h"
#include "bench/runner/gallery_tiles.h"
#include "bench/suites/tables_suite.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 tables_quick_size{512, 384};

struct TablesChoice {
    TablesOptions options;
    OutputChoice outputs;
    bool distances = false;
    bool guesses = false;
    bool claims = false;
};

void add_tables_options(CLI::App& command, TablesChoice& choice) {
    add_terrains_option(command, choice.options.terrains,
                        "the tests of the sources, on generated terrains; with --technique or "
                        "--pose: natural and urban",
                        true);
    add_techniques_option(command, choice.options.techniques, "all techniques");
    cli::add_parsed(
        command, "--pose", choice.options.pose,
        [](const std::string& text) { return cli::parse_pose(text); },
        "camera pose: overview, oblique, low, grazing, valley or map (overview; gallery: oblique)",
        "NAME");
    command.add_flag(
        "--moving", choice.options.suite.moving,
        "the view moves sideways between frames, which cuts most triangles anew; errors "
        "are of the view at rest");
    command.add_flag("--cold", choice.options.suite.cold,
                     "each frame is drawn as the first one of its view: triangles of an error "
                     "bound are cut anew (OpenGL; rays keep nothing)");
    command.add_flag(
        "--distances", choice.distances,
        "instead of the tables: errors from 100 m to 10 km, without times, of texture, "
        "parallax, relief and exact if there is no --technique");
    command.add_flag(
        "--guesses", choice.guesses,
        "instead of the tables: the error of heights that are guessed from the colours "
        "of each terrain");
    command.add_flag(
        "--claims", choice.claims,
        "instead of the tables: time, memory and error of a city of one repeated tile, of relief "
        "over a city only, of four layers on bricks, and of the phases of warping");
    add_suite_options(command, choice.options.suite);
    add_drawing_options(command, choice.options.suite);
    add_output_options(command, choice.outputs);
}

// The options that replace the tables and are given.
std::vector<std::string> replacements(const TablesChoice& choice) {
    std::vector<std::string> names;
    for (const auto& [is_given, name] : {std::pair{choice.distances, "--distances"},
                                         {choice.guesses, "--guesses"},
                                         {choice.claims, "--claims"}}) {
        if (is_given) {
            names.emplace_back(name);
        }
    }
    return names;
}

void check_tables_options(const TablesChoice& choice) {
    if (choice.options.suite.moving && choice.options.suite.cold) {
        cli::fail_usage("--moving, --cold: both found, one was expected");
    }
    const std::vector<std::string> names = replacements(choice);
    if (names.empty()) {
        return;
    }
    if (names.size() > 1) {
        cli::fail_usage(fmt::format("{}, {}: both found, one was expected", names[0], names[1]));
    }
    const auto forbid = [&](bool is_given, std::string_view other) {
        if (is_given) {
            cli::fail_usage(
                fmt::format("{}: {} found, none was expected with it", names[0], other));
        }
    };
    forbid(choice.options.pose.has_value(), "--pose");
    forbid(!choice.claims && choice.options.suite.rounds > 0, "--rounds");
    forbid(choice.options.suite.moving, "--moving");
    forbid(choice.options.suite.cold, "--cold");
    forbid(!choice.distances && !choice.options.techniques.empty(), "--technique");
    forbid(choice.claims && !choice.options.terrains.empty(), "--terrain");
}

Result<void> measure_distances(const TablesOptions& tables, const OutputChoice& outputs,
                               const std::stop_token& stop) {
    DistanceOptions options;
    options.suite = tables.suite;
    if (!tables.terrains.empty()) {
        options.terrains = tables.terrains;
    }
    if (!tables.techniques.empty()) {
        options.techniques = tables.techniques;
    }
    return report(figure_table(run_distances(options, stop)), outputs);
}

Result<void> measure_guesses(const TablesOptions& tables, const OutputChoice& outputs,
                             const std::stop_token& stop) {
    GuessOptions options;
    options.suite = tables.suite;
    if (!tables.terrains.empty()) {
        options.terrains = tables.terrains;
    }
    return report(figure_table(run_guesses(options, stop)), outputs);
}

Result<void> measure_claims(const TablesOptions& tables, const OutputChoice& outputs,
                            const std::stop_token& stop) {
    ClaimOptions options;
    options.suite = tables.suite;
    options.lone.threads = static_cast<unsigned>(tables.suite.threads);
    return report(figure_table(run_claims(options, stop)), outputs);
}

Result<void> run_tables_command(const TablesChoice& choice, const CLI::App& command,
                                const cli::Interrupt& interrupt) {
    const auto inputs = terrain_files(choice.options.terrains);
    if (auto good = check_outputs(choice.outputs, inputs); !good) {
        return good;
    }
    TablesOptions options = choice.options;
    check_suited(options.techniques, options.terrains.empty()
                                         ? std::vector<std::string>{"natural", "urban"}
                                         : options.terrains);
    options.suite = with_quick_size(options.suite, command, tables_quick_size);
    if (choice.distances) {
        return measure_distances(options, choice.outputs, interrupt.token());
    }
    if (choice.guesses) {
        return measure_guesses(options, choice.outputs, interrupt.token());
    }
    if (choice.claims) {
        return measure_claims(options, choice.outputs, interrupt.token());
    }
    options.suite.keep_views = !choice.outputs.html.empty();
    return report(run_tables(options, interrupt.token()), choice.outputs);
}

} // namespace

cli::Command add_tables_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments =
        program.add_subcommand("tables", "frame time and error of each technique on each terrain");
    auto choice = std::make_shared<TablesChoice>();
    add_tables_options(*arguments, *choice);
    arguments->callback([choice] { check_tables_options(*choice); });
    arguments->footer(
        "Without --terrain, --technique and --pose, the suite runs the seven tests of the sources\n"
        "and shows their figures, which were measured at 1024x768. --quick draws 512x384 pixels\n"
        "unless --size is given.\n"
        "Ctrl-C ends after the current frame; the rows so far are printed and written.\n"
        "Examples:\n"
        "  reljef-bench tables --quick\n"
        "  reljef-bench tables --json tables.json --html report\n"
        "  reljef-bench tables --terrain N45E006.hgt --rounds 50 --csv alps.csv\n"
        "  reljef-bench tables --moving --technique polygons:error=1 --technique auto --pose low\n"
        "  reljef-bench tables --cold --technique polygons:error=1 --technique auto --terrain "
        "natural\n"
        "  reljef-bench tables --distances --json distance.json --html distance\n"
        "  reljef-bench tables --guesses --terrain my-scene.toml\n"
        "  reljef-bench tables --claims --json claims.json");
    return {arguments, [arguments, choice, &interrupt] {
                return run_tables_command(*choice, *arguments, interrupt);
            }};
}

} // namespace reljef::bench
