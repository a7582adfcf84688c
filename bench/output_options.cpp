#include "bench/output_options.h"

#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/usage_error.h"
#include "bench/page/page.h"
#include "bench/report/report_json.h"
#include "bench/report/report_text.h"
#include "engine/core/atomic_file.h"

namespace reljef::bench {
namespace {

std::vector<cli::NamedFile> outputs_of(const OutputChoice& choice) {
    std::vector<cli::NamedFile> outputs;
    for (const cli::NamedFile& output :
         {cli::NamedFile{"--json", choice.json}, cli::NamedFile{"--csv", choice.csv},
          cli::NamedFile{"--markdown", choice.markdown}}) {
        if (!output.path.empty()) {
            outputs.push_back(output);
        }
    }
    return outputs;
}

// The page and its folder are no files of others.
std::vector<cli::NamedFile> with_page(std::vector<cli::NamedFile> outputs,
                                      const std::filesystem::path& html) {
    if (!html.empty()) {
        outputs.push_back({"--html", page_file(html).parent_path()});
        outputs.push_back({"--html", page_file(html)});
    }
    return outputs;
}

std::string output_text(const std::string& option, const Results& results) {
    if (option == "--json") {
        return json_report(results);
    }
    return option == "--csv" ? csv_report(results) : markdown_report(results);
}

std::vector<RowPictures> pictures_of(const Results& results) {
    std::vector<RowPictures> pictures;
    for (std::size_t i = 0; i < results.rows.size(); ++i) {
        if (const auto& view = results.rows[i].view) {
            pictures.push_back({i, view});
        }
    }
    return pictures;
}

Result<std::vector<AtomicFile>> prepare_outputs(const Results& results,
                                                const OutputChoice& choice) {
    std::vector<AtomicFile> files;
    for (const cli::NamedFile& output : outputs_of(choice)) {
        const std::string text = output_text(output.option, results);
        auto file = prepare_file(output.path, std::as_bytes(std::span(text)));
        if (!file) {
            return file.error();
        }
        files.push_back(std::move(*file));
    }
    return files;
}

// All are written before the first takes its place.
Result<void> write_outputs(const Results& results, const OutputChoice& choice) {
    auto files = prepare_outputs(results, choice);
    if (!files || choice.html.empty()) {
        return files ? commit_all(*files) : files.error();
    }
    auto page = prepare_page(choice.html, json_report(results), pictures_of(results));
    if (!page) {
        return page.error();
    }
    files->push_back(std::move(page->file));
    auto committed = commit_all(*files);
    files->clear(); // before the page's folder
    return committed;
}

} // namespace

void add_output_options(CLI::App& command, OutputChoice& choice) {
    command.add_option("--json", choice.json, "write the results there too")->type_name("FILE");
    command.add_option("--csv", choice.csv, "write a line a row there too")->type_name("FILE");
    command
        .add_option("--html", choice.html,
                    "write a page there: tables, plots and pictures in one file, index.html")
        ->type_name("FOLDER");
    command.add_option("--markdown", choice.markdown, "write the tables there too")
        ->type_name("FILE");
}

Result<void> check_outputs(const OutputChoice& choice, std::span<const cli::NamedFile> inputs) {
    const std::vector<cli::NamedFile> outputs = outputs_of(choice);
    cli::expect_apart(with_page(outputs, choice.html), inputs);
    for (const cli::NamedFile& output : outputs) {
        if (const auto writable = AtomicFile::create(output.path); !writable) {
            return writable.error();
        }
    }
    if (choice.html.empty()) {
        return {};
    }
    auto page = check_page_target(choice.html);
    std::error_code ignored;
    if (!page && std::filesystem::is_regular_file(choice.html, ignored)) {
        cli::fail_usage(page.error().message);
    }
    return page;
}

Result<void> report(const Results& results, const OutputChoice& choice) {
    if (results.rows.empty()) {
        return results.stopped.value_or(Error{"no rows found, some were expected"});
    }
    // What failed on the way is no reason to lose earlier results.
    auto written = results.failed ? Result<void>() : write_outputs(results, choice);
    fmt::print("{}", terminal_report(results));
    if (std::fflush(stdout) != 0 || !written) {
        return written;
    }
    return results.stopped ? Result<void>(*results.stopped) : Result<void>();
}

} // namespace reljef::bench
