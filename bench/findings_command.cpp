#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/output_files.h"
#include "bench/commands.h"
#include "bench/findings/distance_plot.h"
#include "bench/findings/findings_page.h"
#include "bench/options/output_options.h"
#include "engine/core/atomic_file.h"

namespace reljef::bench {
namespace {

struct FindingsChoice {
    std::filesystem::path results = "bench/results";
    std::filesystem::path markdown; ///< empty: standard output
    std::filesystem::path plot;     ///< empty: none
};

std::vector<cli::NamedFile> results_in(const std::filesystem::path& folder) {
    std::vector<cli::NamedFile> files;
    for (const ResultsSource& source : results_sources()) {
        files.push_back({"--results", folder / source.file()});
    }
    return files;
}

Result<void> write_findings(const FindingsChoice& choice, const std::string& page,
                            const std::string& plot) {
    std::vector<AtomicFile> files;
    for (const auto& [path, text] : {std::pair(&choice.markdown, &page), {&choice.plot, &plot}}) {
        if (path->empty()) {
            continue;
        }
        auto file = prepare_file(*path, std::as_bytes(std::span(*text)));
        if (!file) {
            return file.error();
        }
        files.push_back(std::move(*file));
    }
    return commit_all(files);
}

Result<void> run_findings(const FindingsChoice& choice) {
    std::vector<cli::NamedFile> outputs{{"--markdown", choice.markdown}, {"--plot", choice.plot}};
    std::erase_if(outputs, [](const cli::NamedFile& output) { return output.path.empty(); });
    check_are_files(outputs);
    cli::check_distinct(outputs, results_in(choice.results));
    if (auto writable = cli::check_writable(outputs); !writable) {
        return writable;
    }
    const auto results = read_all_results(choice.results);
    if (!results) {
        return results.error();
    }
    const auto page = findings_page(*results);
    const auto plot = distance_plot(*results);
    if (!page || !plot) {
        return page ? plot.error() : page.error();
    }
    if (auto written = write_findings(choice, *page, *plot); !written || !choice.markdown.empty()) {
        return written;
    }
    fmt::print("{}", *page);
    return std::fflush(stdout) == 0 ? Result<void>()
                                    : Result<void>(Error{"standard output cannot be written"});
}

} // namespace

cli::Command add_findings_command(CLI::App& program, cli::Interrupt& /*interrupt*/) {
    auto* arguments = program.add_subcommand(
        "findings", "judges the conclusions of the sources by the results in a folder");
    auto choice = std::make_shared<FindingsChoice>();
    arguments
        ->add_option("--results", choice->results,
                     "the folder with results, written by --json (bench/results)")
        ->type_name("FOLDER");
    arguments
        ->add_option("--markdown", choice->markdown,
                     "write the page to FILE instead of standard output")
        ->type_name("FILE");
    arguments
        ->add_option("--plot", choice->plot,
                     "write the page's plot of error and time over distance to FILE, an SVG")
        ->type_name("FILE");
    arguments->footer(
        "Measures nothing. A conclusion without results is marked as not measured yet; the page\n"
        "has the commands that measure it.\n"
        "Examples:\n"
        "  reljef-bench findings\n"
        "  reljef-bench findings --markdown docs/findings.md --plot docs/pictures/distance.svg\n"
        "  reljef-bench findings --results my-results --markdown my-findings.md");
    return {arguments, [choice] { return run_findings(*choice); }};
}

} // namespace reljef::bench
