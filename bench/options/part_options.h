#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/options/output_options.h"
#include "engine/core/parallel_for.h"

namespace CLI {
class App;
}

namespace reljef::bench {

/// The part of a run that this process measures, or the parts that it reports as one run.
struct PartChoice {
    Shard shard;
    bool resume = false;
    std::filesystem::path merged; ///< the name of their JSON files; empty: it measures
};

/// Adds --shard, --resume and --merge. `items`: what is divided, "scenes and poses".
void add_part_options(CLI::App& command, PartChoice& choice, const std::string& items);

/// The outputs of a part: its number replaces "%d" in their names. A usage error (CLI::ParseError)
/// for --resume without --json.
OutputChoice outputs_of_part(OutputChoice outputs, const PartChoice& choice);

/// The files that --merge reads. A usage error (CLI::ParseError) for --merge beside an option that
/// is no output, because nothing is measured.
std::vector<cli::NamedFile> merged_files(const CLI::App& command, const PartChoice& choice);

/// With --resume, whether the JSON file holds complete results of this part already; says so.
bool is_finished(const OutputChoice& outputs, const PartChoice& choice, bool quiet);

} // namespace reljef::bench
