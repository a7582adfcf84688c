#include "bench/commands.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stop_token>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/message.h"
#include "bench/report/report_json.h"
#include "bench/suites/compare.h"

namespace reljef::bench {
namespace {

struct CompareChoice {
    std::filesystem::path before;
    std::filesystem::path after;
    double threshold_percent = 10.0;
};

double parse_percent(const std::string& text) {
    double value = 0.0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool fits = code == std::errc{} && end == text.data() + text.size() &&
                      std::isfinite(value) && value >= 0.0;
    if (!fits) {
        throw CLI::ValidationError(
            fmt::format("--threshold: '{}' found, a percentage of at least 0 was expected", text));
    }
    return value;
}

void add_compare_options(CLI::App& command, CompareChoice& choice) {
    command.add_option("BEFORE", choice.before, "results that --json wrote")->required();
    command.add_option("AFTER", choice.after, "results to hold against them")->required();
    command
        .add_option_function<std::string>(
            "--threshold",
            [&choice](const std::string& text) { choice.threshold_percent = parse_percent(text); },
            "changes up to so many percent are none (10)")
        ->type_name("PERCENT");
}

// Reading and comparing leave nothing to tidy up.
void end_at_once() {
    cli::write_stderr("reljef-bench: interrupted\n");
    std::_Exit(1);
}

Result<void> run_compare(const CompareChoice& choice, const cli::Interrupt& interrupt) {
    const std::stop_callback ending(interrupt.token(), end_at_once);
    const auto before = read_json_report(choice.before);
    if (!before) {
        return before.error();
    }
    const auto after = read_json_report(choice.after);
    if (!after) {
        return after.error();
    }
    const Comparison comparison =
        compare(*before, *after, {.threshold = 0.01 * choice.threshold_percent});
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
    auto* arguments = program.add_subcommand(
        "compare", "what is faster, slower, more or less accurate than before");
    auto choice = std::make_shared<CompareChoice>();
    add_compare_options(*arguments, *choice);
    arguments->footer(
        "Changes count beyond the threshold and the noise of both runs. The exit status is 1 where "
        "anything\n"
        "got worse or a row is gone. Rows of under 5 frames get no verdict of time.\n"
        "Examples:\n"
        "  reljef-bench compare before.json after.json\n"
        "  reljef-bench compare before.json after.json --threshold 5");
    return {arguments, [choice, &interrupt] { return run_compare(*choice, interrupt); }};
}

} // namespace reljef::bench
