#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "app/cli/output_files.h"
#include "bench/page/page.h"
#include "bench/report/figure_table.h"
#include "bench/report/results.h"

namespace CLI {
class App;
}

namespace reljef::bench {

/// Output files; empty paths: none.
struct OutputChoice {
    std::filesystem::path json;
    std::filesystem::path csv;
    std::filesystem::path markdown;
    std::filesystem::path html; ///< a folder
};

/// Adds --json, --csv, --markdown and --html.
void add_output_options(CLI::App& command, OutputChoice& choice);

/// A usage error (CLI::ParseError) if an output is "-": standard output has the table.
void check_are_files(std::span<const cli::NamedFile> outputs);

/// Checks the outputs without a trace. Fails if a file cannot be written. A usage error
/// (CLI::ParseError) if an output is "-", an input or another output, or if --html names a file.
Result<void> check_outputs(const OutputChoice& choice, std::span<const cli::NamedFile> inputs);

/// A report in its forms. Those of requested outputs are made; the others may be empty.
struct ReportForms {
    std::function<std::string()> json = {};
    std::function<std::string()> csv = {};
    std::function<std::string()> markdown = {};
    std::function<Result<PreparedPage>(const std::filesystem::path& folder)> page = {};
};

/// Writes all files and the page, or none if one fails.
Result<void> write_report(const OutputChoice& choice, const ReportForms& forms);

/// Writes all files and the page, or none if one fails, and prints the table. Keeps earlier files
/// if the run failed or has no rows. Also fails with Results::stopped.
Result<void> report(const Results& results, const OutputChoice& choice);

/// The same for a table. Also fails with RunEnd::stopped. `text` is printed; empty: figure_text().
Result<void> report(const FigureTable& table, const OutputChoice& choice,
                    const std::string& text = {});

} // namespace reljef::bench
