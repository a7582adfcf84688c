#include "bench/tables_command.h"

#include <array>
#include <charconv>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/options.h"
#include "app/output_files.h"
#include "bench/report_json.h"
#include "bench/report_terminal.h"
#include "bench/tables_suite.h"
#include "engine/core/atomic_file.h"

namespace reljef::bench {
namespace {

struct TablesChoice {
    TablesOptions options;
    std::filesystem::path json;
};

// The value, or the parser library's error.
template <class T> T checked(Result<T> value) {
    if (!value) {
        throw CLI::ValidationError(value.error().message);
    }
    return std::move(*value);
}

std::optional<platform::ContextKind> parse_context(const std::string& text) {
    const auto kind = platform::context_kind_from_string(text);
    if (!kind && text != "auto") {
        throw CLI::ValidationError(fmt::format(
            "--context: '{}' found, one of auto, glfw, egl, osmesa was expected", text));
    }
    return kind;
}

CLI::Validator whole_number_in(int low, int high) {
    return CLI::Validator(
        [=](const std::string& text) {
            int value = 0;
            const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
            const bool fits = code == std::errc{} && end == text.data() + text.size() &&
                              value >= low && value <= high;
            return fits ? std::string()
                        : fmt::format("'{}' found, a whole number from {} to {} was expected", text,
                                      low, high);
        },
        "");
}

void add_options(CLI::App& command, TablesChoice& choice) {
    TablesOptions& options = choice.options;
    command
        .add_option(
            "--terrain", options.terrains,
            "natural, urban, a scene file (.toml) or a DEM file; may be given again (natural "
            "and urban)")
        ->type_name("TERRAIN")
        ->allow_extra_args(false);
    command
        .add_option_function<std::vector<std::string>>(
            "--technique",
            [&options](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) {
                    options.techniques.push_back(checked(scene::parse_technique(text)));
                }
            },
            "beside texture; may be given again (all of them)")
        ->type_name("ID[:key=value,...]")
        ->allow_extra_args(false);
    command.add_flag("--quick", options.quick, "done in half a minute, with fewer frames");
    command
        .add_option("--rounds", options.rounds,
                    "frames of each technique (as many as fit in 20 s a terrain, at least 5)")
        ->type_name("N")
        ->check(whole_number_in(1, 1'000'000));
    command
        .add_option_function<std::string>(
            "--size",
            [&options](const std::string& text) { options.size = checked(app::parse_size(text)); },
            "of the picture, pixels (1024x768)")
        ->type_name("WxH");
    command
        .add_option_function<std::string>(
            "--context",
            [&options](const std::string& text) { options.context = parse_context(text); },
            "auto, glfw (window), egl (GPU without a window) or osmesa (CPU)")
        ->type_name("KIND");
    command.add_option("--threads", options.threads, "0: as many as the machine has (0)")
        ->type_name("N")
        ->check(whole_number_in(0, 1024));
    command.add_option("--json", choice.json, "write the results there too")->type_name("FILE");
    command.add_flag("--quiet", options.quiet, "no progress and no notes on stderr");
}

Result<void> check_target(const TablesChoice& choice) {
    if (choice.json.empty()) {
        return {};
    }
    std::vector<app::NamedFile> terrains;
    for (const std::string& terrain : choice.options.terrains) {
        terrains.push_back({"--terrain", terrain});
    }
    const std::array outputs{app::NamedFile{"--json", choice.json}};
    if (auto apart = app::check_apart(outputs, terrains); !apart) {
        return apart;
    }
    const auto writable = AtomicFile::create(choice.json);
    return writable ? Result<void>() : writable.error();
}

Result<void> run(const TablesChoice& choice, const app::Interrupt& interrupt) {
    if (auto good = check_target(choice); !good) { // not only after all the measuring
        return good;
    }
    const Results results = run_tables(choice.options, interrupt.token());
    if (results.rows.empty()) {
        return *results.stopped;
    }
    fmt::print("{}", terminal_report(results));
    std::fflush(stdout);
    if (!choice.json.empty()) {
        if (auto written = write_json_report(choice.json, results); !written) {
            return written;
        }
    }
    return results.stopped ? Result<void>(*results.stopped) : Result<void>();
}

} // namespace

app::Command add_tables_command(CLI::App& program, app::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand(
        "tables", "frame times of the techniques, the whole terrain in view");
    auto choice = std::make_shared<TablesChoice>();
    add_options(*arguments, *choice);
    arguments->footer(
        "Ctrl-C ends after the frame being drawn; the rows so far are shown and written.\n"
        "Examples:\n"
        "  reljef-bench tables --quick\n"
        "  reljef-bench tables --terrain N45E006.hgt --rounds 50 --json alps.json");
    return {arguments, [choice, &interrupt] { return run(*choice, interrupt); }};
}

} // namespace reljef::bench
