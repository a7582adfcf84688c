#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stop_token>
#include <utility>
#include <vector>

#include "app/cli/message.h"
#include "app/cli/parsed_option.h"
#include "bench/commands.h"
#include "bench/options/output_options.h"
#include "bench/report/document.h"
#include "bench/report/result_parts.h"
#include "bench/suites/compare_figures.h"

namespace reljef::bench {
namespace {

struct CompareChoice {
    std::filesystem::path before;
    std::filesystem::path after;
    double threshold_percent = 10.0;
    OutputChoice outputs;
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

std::vector<cli::NamedFile> files_of(const CompareChoice& choice) {
    std::vector<cli::NamedFile> files;
    for (const auto& [what, name] :
         {std::pair("BEFORE", &choice.before), {"AFTER", &choice.after}}) {
        for (const std::filesystem::path& file : part_files(*name)) {
            files.push_back({what, file});
        }
    }
    return files;
}

const Environment& machine_of(const Document& document) {
    const auto* const table = std::get_if<FigureTable>(&document);
    return table != nullptr ? table->environment : std::get<Results>(document).environment;
}

// Of the pictures: "1024x768"; empty: not known, or a part of the rows' names.
std::string size_of(const Document& document) {
    const auto* const table = std::get_if<FigureTable>(&document);
    const bool has_size = table != nullptr && table->settings.is_object() &&
                          table->settings.contains("size") && table->settings["size"].is_string();
    return has_size ? table->settings["size"].get<std::string>() : std::string();
}

// Fails with one sentence if the runs cannot be compared.
Result<Comparison> compare_documents(const CompareChoice& choice, const Document& before,
                                     const Document& after) {
    const std::string suite = suite_of(before);
    const std::string other = suite_of(after);
    if (before.index() != after.index() || (suite != other && !suite.empty() && !other.empty())) {
        return Error{
            fmt::format("{} has results of {}, and {} of {}; two of one suite were expected",
                        choice.before.string(), cli::printable(suite), choice.after.string(),
                        cli::printable(other))};
    }
    if (size_of(before) != size_of(after) && !size_of(before).empty() && !size_of(after).empty()) {
        return Error{fmt::format("{}: pictures of {} found, {} as in {} was expected",
                                 choice.after.string(), cli::printable(size_of(after)),
                                 cli::printable(size_of(before)), choice.before.string())};
    }
    const double threshold = 0.01 * choice.threshold_percent;
    const auto* const table = std::get_if<FigureTable>(&before);
    Comparison comparison =
        table != nullptr ? compare(*table, std::get<FigureTable>(after), threshold)
                         : compare(std::get<Results>(before), std::get<Results>(after), threshold);
    if (comparison.changes.empty() && comparison.untimed.empty()) {
        return Error{fmt::format("{} and {}: no row found in both, some were expected",
                                 choice.before.string(), choice.after.string())};
    }
    return comparison;
}

Result<void> run_compare(const CompareChoice& choice, const cli::Interrupt& interrupt) {
    const std::stop_callback on_stop(interrupt.token(), exit_at_once);
    if (auto good = check_outputs(choice.outputs, files_of(choice)); !good) {
        return good;
    }
    const auto before = read_document_parts(choice.before);
    if (!before) {
        return before.error();
    }
    const auto after = read_document_parts(choice.after);
    if (!after) {
        return after.error();
    }
    const auto comparison = compare_documents(choice, *before, *after);
    if (!comparison) {
        return comparison.error();
    }
    const FigureTable table =
        figure_table(*comparison, {.before = choice.before.string(),
                                   .after = choice.after.string(),
                                   .suite = suite_of(*after),
                                   .threshold = 0.01 * choice.threshold_percent,
                                   .environment = machine_of(*after)});
    if (auto reported = report(table, choice.outputs, comparison_report(*comparison)); !reported) {
        return reported;
    }
    const std::size_t regressions = comparison->regressions();
    return regressions == 0
               ? Result<void>()
               : Error{fmt::format("{}: {} figure{} worse or gone, against {}",
                                   choice.after.string(), regressions, regressions == 1 ? "" : "s",
                                   choice.before.string())};
}

} // namespace

cli::Command add_compare_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand(
        "compare", "changes of times and errors between two runs of a suite");
    auto choice = std::make_shared<CompareChoice>();
    arguments
        ->add_option("BEFORE", choice->before,
                     "results of the first run, written by --json; of parts (--shard): their "
                     "name with %d for the number")
        ->required();
    arguments->add_option("AFTER", choice->after, "results of the second run")->required();
    cli::add_parsed(*arguments, "--threshold", choice->threshold_percent, parse_percent,
                    "ignore changes of at most PERCENT percent (10)", "PERCENT");
    add_output_options(*arguments, choice->outputs);
    arguments->footer(
        "Parts of a run are read as one: 'part-%d.json' is part-0.json, part-1.json, …\n"
        "A change counts if it is larger than the threshold and the noise of both runs. Times of\n"
        "rows with fewer than 5 frames are not compared. Times of other machines are not "
        "compared\n"
        "either, but for ratios to texture. The exit status is 1 if a figure is worse or a row is\n"
        "missing.\n"
        "Examples:\n"
        "  reljef-bench compare before.json after.json\n"
        "  reljef-bench compare before.json after.json --threshold 5\n"
        "  reljef-bench compare peers-before.json peers-after.json --html changes\n"
        "  reljef-bench compare before.json 'part-%d.json' --json changes.json");
    return {arguments, [choice, &interrupt] { return run_compare(*choice, interrupt); }};
}

} // namespace reljef::bench
