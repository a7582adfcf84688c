#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stop_token>

#include "app/cli/message.h"
#include "app/cli/parsed_option.h"
#include "bench/commands.h"
#include "bench/report/result_parts.h"
#include "bench/suites/compare.h"

namespace reljef::bench {
namespace {

struct CompareChoice {
    std::filesystem::path before;
    std::filesystem::path after;
    double threshold_percent = 10.0;
};

Result<double> parse_percent(const std::string& text) {
    const auto value = cli::number_from<double>(text);
    if (!value || !std::isfinite(*value) || *value < 0.0) {
        return Error{
            fmt::format("--threshold: '{}' found, a percentage of at least 0 was expected", text)};
    }
    return *value;
}

void exit_at_once() {
    cli::write_stderr("reljef-bench: interrupted\n");
    std::_Exit(1);
}

Result<void> run_compare(const CompareChoice& choice, const cli::Interrupt& interrupt) {
    const std::stop_callback on_stop(interrupt.token(), exit_at_once);
    const auto before = read_result_parts(choice.before);
    if (!before) {
        return before.error();
    }
    const auto after = read_result_parts(choice.after);
    if (!after) {
        return after.error();
    }
    const Comparison comparison = compare(*before, *after, 0.01 * choice.threshold_percent);
    if (comparison.changes.empty() && comparison.untimed.empty()) {
        return Error{fmt::format("{} and {}: no row found in both, some were expected",
                                 choice.before.string(), choice.after.string())};
    }
    fmt::print("{}", comparison_report(comparison));
    const std::size_t regressions = comparison.regressions();
    return regressions == 0
               ? Result<void>()
               : Error{fmt::format("{}: {} figure{} worse or gone, against {}",
                                   choice.after.string(), regressions, regressions == 1 ? "" : "s",
                                   choice.before.string())};
}

} // namespace

cli::Command add_compare_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments =
        program.add_subcommand("compare", "changes of frame time and error between two runs");
    auto choice = std::make_shared<CompareChoice>();
    arguments
        ->add_option("BEFORE", choice->before,
                     "results of the first run, written by --json; of parts (--shard): their "
                     "name with %d for the number")
        ->required();
    arguments->add_option("AFTER", choice->after, "results of the second run")->required();
    cli::add_parsed(*arguments, "--threshold", choice->threshold_percent, parse_percent,
                    "ignore changes of at most PERCENT percent (10)", "PERCENT");
    arguments->footer(
        "Parts of a run are read as one: 'part-%d.json' is part-0.json, part-1.json, …\n"
        "A change counts if it is larger than the threshold and the noise of both runs. Times of\n"
        "rows with fewer than 5 frames are not compared. The exit status is 1 if a figure is "
        "worse\n"
        "or a row is missing.\n"
        "Examples:\n"
        "  reljef-bench compare before.json after.json\n"
        "  reljef-bench compare before.json after.json --threshold 5\n"
        "  reljef-bench compare before.json 'part-%d.json'");
    return {arguments, [choice, &interrupt] { return run_compare(*choice, interrupt); }};
}

} // namespace reljef::bench
