#include "bench/options/output_options.h"

#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/usage_error.h"
#include "bench/report/report_json.h"
#include "bench/report/report_text.h"

namespace reljef::bench {
namespace {

std::vector<cli::NamedFile> output_files(const OutputChoice& choice) {
    std::vector<cli::NamedFile> outputs{
        {"--json", choice.json}, {"--csv", choice.csv}, {"--markdown", choice.markdown}};
    std::erase_if(outputs, [](const cli::NamedFile& output) { return output.path.empty(); });
    return outputs;
}

Result<void> write_outputs(const FigureTable& table, const OutputChoice& choice) {
    return write_report(
        choice,
        {.json = [&] { return figure_json(table); },
         .csv = [&] { return figure_csv(table); },
         .markdown = [&] { return figure_markdown(table); },
         .page = [&](const std::filesystem::path& folder) { return prepare_page(folder, table); }});
}

Result<void> write_outputs(const Results& results, const OutputChoice& choice) {
    return write_report(choice, {.json = [&] { return json_report(results); },
                                 .csv = [&] { return csv_report(results); },
                                 .markdown = [&] { return markdown_report(results); },
                                 .page =
                                     [&](const std::filesystem::path& folder) {
                                         return prepare_page(folder, results);
                                     }});
}

} // namespace

void add_output_options(CLI::App& command, OutputChoice& choice) {
    command.add_option("--json", choice.json, "also write the results as JSON")->type_name("FILE");
    command.add_option("--csv", choice.csv, "also write the results as CSV, one line per row")
        ->type_name("FILE");
    command
        .add_option("--html", choice.html,
                    "also write a page with tables, plots and pictures: FOLDER/index.html")
        ->type_name("FOLDER");
    command.add_option("--markdown", choice.markdown, "also write the tables as Markdown")
        ->type_name("FILE");
}

void check_are_files(std::span<const cli::NamedFile> outputs) {
    for (const cli::NamedFile& output : outputs) {
        if (output.path == "-") {
            cli::fail_usage(fmt::format("{}: '-' found, a file was expected; standard output has "
                                        "what the command prints",
                                        output.option));
        }
    }
}

Result<void> check_outputs(const OutputChoice& choice, std::span<const cli::NamedFile> inputs) {
    const std::vector<cli::NamedFile> outputs = output_files(choice);
    auto all = outputs;
    if (!choice.html.empty()) {
        all.push_back({"--html", page_file(choice.html).parent_path()});
        all.push_back({"--html", page_file(choice.html)});
    }
    check_are_files(all);
    cli::check_distinct(all, inputs);
    if (auto writable = cli::check_writable(outputs); !writable || choice.html.empty()) {
        return writable;
    }
    auto page = check_page_target(choice.html);
    std::error_code ignored;
    if (!page && std::filesystem::is_regular_file(choice.html, ignored)) {
        cli::fail_usage(page.error().message);
    }
    return page;
}

// Writes everything beside its target before the first file replaces its target.
Result<void> write_report(const OutputChoice& choice, const ReportForms& forms) {
    std::vector<AtomicFile> files;
    for (const auto& [path, form] : {std::pair(&choice.json, &forms.json),
                                     {&choice.csv, &forms.csv},
                                     {&choice.markdown, &forms.markdown}}) {
        if (path->empty()) {
            continue;
        }
        const std::string text = (*form)();
        auto file = prepare_file(*path, std::as_bytes(std::span(text)));
        if (!file) {
            return file.error();
        }
        files.push_back(std::move(*file));
    }
    if (choice.html.empty()) {
        return commit_all(files);
    }
    auto page = forms.page(choice.html);
    if (!page) {
        return page.error();
    }
    files.push_back(std::move(page->file));
    auto committed = commit_all(files);
    files.clear(); // before the page's folder
    return committed;
}

Result<void> report(const Results& results, const OutputChoice& choice) {
    if (results.rows.empty()) {
        return results.stopped.value_or(Error{"no rows found, some were expected"});
    }
    auto written = results.failed ? Result<void>() : write_outputs(results, choice);
    fmt::print("{}", terminal_report(results));
    if (std::fflush(stdout) != 0 || !written) {
        return written;
    }
    return results.stopped ? Result<void>(*results.stopped) : Result<void>();
}

Result<void> report(const FigureTable& table, const OutputChoice& choice, const std::string& text) {
    if (table.rows.empty()) {
        return table.end.stopped.value_or(Error{"no rows found, some were expected"});
    }
    auto written = table.end.failed ? Result<void>() : write_outputs(table, choice);
    fmt::print("{}", text.empty() ? figure_text(table) : text);
    if (std::fflush(stdout) != 0 || !written) {
        return written;
    }
    return table.end.stopped ? Result<void>(*table.end.stopped) : Result<void>();
}

} // namespace reljef::bench
