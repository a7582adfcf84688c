#pragma once

#include <filesystem>
#include <span>

#include "app/cli/output_files.h"
#include "bench/report/results.h"

namespace CLI {
class App;
}

namespace reljef::bench {

/// The files results go to beside the terminal; an empty path is none.
struct OutputChoice {
    std::filesystem::path json;
    std::filesystem::path csv;
    std::filesystem::path markdown;
    std::filesystem::path html; ///< a folder
};

/// Adds --json, --csv, --markdown and --html.
void add_output_options(CLI::App& command, OutputChoice& choice);

/// Fails where a file could not be written, and refuses (CLI::ParseError) one that is an input or
/// another output, and a page into a file: asked before anything is measured, leaves nothing
/// behind.
Result<void> check_outputs(const OutputChoice& choice, std::span<const cli::NamedFile> inputs);

/// Writes the files and the page, with the pictures of the rows that have a view: all, or none
/// where one fails; and prints the table. A run that failed, or has no rows, leaves earlier files
/// as they are. Fails with Results::stopped too.
Result<void> report(const Results& results, const OutputChoice& choice);

} // namespace reljef::bench
