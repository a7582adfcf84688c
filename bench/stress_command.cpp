#include <filesystem>
#include <memory>

#include <fmt/ranges.h>

#include "app/cli/options.h"
#include "app/cli/parsed_option.h"
#include "app/cli/shard_option.h"
#include "app/cli/usage_error.h"
#include "bench/commands.h"
#include "bench/options/output_options.h"
#include "bench/options/part_options.h"
#include "bench/options/suite_arguments.h"
#include "bench/report/result_parts.h"
#include "bench/stress/stress_suite.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 full_size{320, 240};
constexpr glm::ivec2 stress_quick_size{96, 72};

struct StressChoice {
    StressOptions options;
    OutputChoice outputs;
    PartChoice part;
};

Result<void> report_stress(const StressResults& results, const OutputChoice& outputs) {
    if (results.rows.empty()) {
        const Shard& shard = results.options.shard;
        return results.end.stopped.value_or(
            Error{shard.is_whole() ? "no rows found, some were expected"
                                   : fmt::format("--shard: {} found, but there are fewer stresses",
                                                 cli::shard_text(shard))});
    }
    if (auto reported = report(figure_table(results), outputs, stress_text(results)); !reported) {
        return reported;
    }
    const std::size_t failures = results.failures();
    return failures == 0 ? Result<void>()
                         : Error{fmt::format("{} figures over their limits found, none were "
                                             "expected",
                                             failures)};
}

Result<StressResults> read_parts_of(const std::filesystem::path& name) {
    if (!names_parts(name)) {
        return read_stress_report(name);
    }
    auto parts = read_parts(name, read_stress_report);
    if (!parts) {
        return parts.error();
    }
    auto all = merged(std::move(*parts), stress_names());
    return all ? std::move(all) : Error{fmt::format("{}: {}", name.string(), all.error().message)};
}

Result<void> merge_stress(const StressChoice& choice, const CLI::App& command) {
    if (auto good = check_outputs(choice.outputs, merged_files(command, choice.part)); !good) {
        return good;
    }
    const auto all = read_parts_of(choice.part.merged);
    return all ? report_stress(*all, choice.outputs) : all.error();
}

Result<void> run_stress_command(const StressChoice& choice, const CLI::App& command,
                                const cli::Interrupt& interrupt) {
    if (!choice.part.merged.empty()) {
        return merge_stress(choice, command);
    }
    const auto inputs = terrain_files(choice.options.terrains);
    const OutputChoice outputs = outputs_of_part(choice.outputs, choice.part);
    if (auto good = check_outputs(outputs, inputs); !good) {
        return good;
    }
    if (is_finished(outputs, choice.part, choice.options.suite.quiet)) {
        return {};
    }
    for (const scene::Technique& technique : choice.options.techniques) {
        if (!scene::draws_terrain(technique.id())) {
            cli::fail_usage(fmt::format("--technique: {} found, a technique that draws terrains "
                                        "was expected",
                                        scene::technique_info(technique.id()).name));
        }
    }
    StressOptions options = choice.options;
    options.suite = with_quick_size(options.suite, command, stress_quick_size);
    options.shard = choice.part.shard;
    return report_stress(run_stress(options, interrupt.token()), outputs);
}

void add_stress_options(CLI::App& command, StressChoice& choice) {
    choice.options.suite.size = full_size;
    add_terrains_option(command, choice.options.terrains, "natural and urban");
    add_techniques_option(command, choice.options.techniques,
                          "all that draw terrains, and polygons:error=1");
    command
        .add_option("--only", choice.options.stresses,
                    fmt::format("run this stress; may be repeated: {} (all)",
                                fmt::join(stress_names(), ", ")))
        ->type_name("STRESS")
        ->check(cli::one_of(stress_names()))
        ->allow_extra_args(false);
    cli::add_parsed(command, "--seed", choice.options.seed,
                    cli::number_in<std::uint32_t>("--seed", 0, 4'294'967'295U),
                    "of random views and paths (1)", "N");
    cli::add_parsed(command, "--poses", choice.options.poses,
                    cli::number_in<int>("--poses", 1, 1'000'000),
                    "views of error-bound, half of them near the ground, and of each terrain of "
                    "streamed-bound (2000 and 100; with --quick 80 and 4); of terrains with a "
                    "place on the Earth, half of them on the ellipsoid, the others on a plane",
                    "N");
    cli::add_parsed(command, "--skip", choice.options.skip,
                    cli::number_in<int>("--skip", 0, 1'000'000'000),
                    "leave out the first N views of error-bound and streamed-bound, which an "
                    "earlier run with the same terrains, --poses and --seed checked (0)",
                    "N");
    add_suite_options(command, choice.options.suite);
    add_drawing_options(command, choice.options.suite);
    add_output_options(command, choice.outputs);
    add_part_options(command, choice.part, "stresses");
}

} // namespace

cli::Command add_stress_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand(
        "stress", "numerical stability: figures with limits, for all techniques");
    auto choice = std::make_shared<StressChoice>();
    add_stress_options(*arguments, *choice);
    arguments->footer(
        "Moves scenes to the poles, creeps by a millimetre, looks along the ground, scales by a\n"
        "millionth and a million, feeds odd heights and files, and repeats frames. Each figure "
        "has\n"
        "a limit; the exit status is 1 if one is over it. A figure that is known to be over its\n"
        "limit names the work that will fix it. --quick draws 96x72 pixels unless --size is given\n"
        "and leaves out streamed-bound, which writes 1.6 GB of temporary files.\n"
        "Ctrl-C ends after the current frame; the rows so far are printed and written. --skip "
        "goes\n"
        "on where the views of the error bound ended: after as many as these rows have frames.\n"
        "Examples:\n"
        "  reljef-bench stress --quick\n"
        "  reljef-bench stress --terrain N45E006.hgt --only near-ground --technique exact\n"
        "  reljef-bench stress --terrain N45E006.hgt --only error-bound --poses 10000\n"
        "  reljef-bench stress --terrain N45E006.hgt --only error-bound --poses 10000 --skip 4000\n"
        "  reljef-bench stress --json stress.json --html stress\n"
        "  reljef-bench stress --shard 0/4 --json 'stress-%d.json' --resume\n"
        "  reljef-bench stress --merge 'stress-%d.json' --html stress");
    return {arguments, [arguments, choice, &interrupt] {
                return run_stress_command(*choice, *arguments, interrupt);
            }};
}

} // namespace reljef::bench
