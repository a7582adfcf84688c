#include "bench/options/part_options.h"

#include <algorithm>
#include <array>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/console_log.h"
#include "app/cli/shard_option.h"
#include "app/cli/usage_error.h"
#include "bench/report/result_parts.h"
#include "engine/core/atomic_file.h"

namespace reljef::bench {

void add_part_options(CLI::App& command, PartChoice& choice, const std::string& items) {
    cli::add_shard_option(command, choice.shard, items);
    command.add_flag(
        "--resume", choice.resume,
        "do nothing if the file of --json holds complete results of this part already");
    command
        .add_option("--merge", choice.merged,
                    "measure nothing, and report parts as the run of one process; NAME: that of "
                    "their --json, with %d for the number")
        ->type_name("NAME");
}

std::vector<cli::NamedFile> merged_files(const CLI::App& command, const PartChoice& choice) {
    constexpr std::array beside{"--merge", "--json", "--csv", "--markdown", "--html", "--quiet"};
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = option->get_name();
        if (option->count() > 0 && std::find(beside.begin(), beside.end(), name) == beside.end()) {
            cli::fail_usage(fmt::format("--merge: found beside {}, outputs were expected; nothing "
                                        "is measured",
                                        name));
        }
    }
    std::vector<cli::NamedFile> files;
    for (const std::filesystem::path& file : part_files(choice.merged)) {
        files.push_back({"--merge", file});
    }
    return files;
}

OutputChoice outputs_of_part(OutputChoice outputs, const PartChoice& choice) {
    if (choice.resume && outputs.json.empty()) {
        cli::fail_usage("--resume: found without --json FILE, which tells what is complete");
    }
    if (choice.shard.is_whole()) {
        return outputs;
    }
    for (auto* const path : {&outputs.json, &outputs.csv, &outputs.markdown, &outputs.html}) {
        *path = part_file(*path, choice.shard);
    }
    return outputs;
}

bool is_finished(const OutputChoice& outputs, const PartChoice& choice, bool quiet) {
    std::error_code ignored;
    if (!choice.resume || !std::filesystem::is_regular_file(outputs.json, ignored)) {
        return false;
    }
    const auto text = read_text_file(outputs.json);
    const auto json = text ? nlohmann::json::parse(*text, nullptr, false) : nlohmann::json();
    const std::string part = cli::shard_text(choice.shard);
    const bool is_complete = json.is_object() && json.value("complete", nlohmann::json()) == true &&
                             json.value("shard", nlohmann::json("0/1")) == part;
    if (is_complete) {
        cli::ConsoleLog(quiet).note(
            fmt::format("{}: holds complete results of part {}", outputs.json.string(), part));
    }
    return is_complete;
}

} // namespace reljef::bench
