#pragma once

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "bench/report/results.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// The file of a part: its number instead of "%d" in a name.
std::filesystem::path part_file(const std::filesystem::path& name, const Shard& shard);

/// The files of the parts that are there, counted from 0; without "%d" the file itself.
std::vector<std::filesystem::path> part_files(const std::filesystem::path& name);

inline PartOrigin origin_of(const Results& part) {
    return {part.shard, part.environment};
}

/// Fails unless these are all parts of one run, in their order and of one environment.
Result<void> check_origins(const std::vector<PartOrigin>& parts);

/// All parts of a run by their numbers. `Part` has an origin_of(). Fails as check_origins().
template <class Part> Result<std::vector<Part>> whole_run(std::vector<Part> parts) {
    std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
        return origin_of(a).shard.index < origin_of(b).shard.index;
    });
    std::vector<PartOrigin> origins;
    origins.reserve(parts.size());
    for (const Part& part : parts) {
        origins.push_back(origin_of(part));
    }
    const auto good = check_origins(origins);
    return good ? Result<std::vector<Part>>(std::move(parts)) : good.error();
}

/// Fails if the first part says that it is a whole run, and there is another one.
Result<void> check_whole(const std::filesystem::path& name, const Shard& first);

/// Reads the files of all parts; the first one names their number. Fails as `read`, and as
/// check_whole().
template <class Part>
Result<std::vector<Part>> read_parts(const std::filesystem::path& name,
                                     Result<Part> (*read)(const std::filesystem::path& file)) {
    std::vector<Part> parts;
    int count = 1;
    for (int index = 0; index < count; ++index) {
        auto part = read(part_file(name, {index, count}));
        if (!part) {
            return part.error();
        }
        if (index == 0) {
            const Shard first = origin_of(*part).shard;
            if (auto good = check_whole(name, first); !good) {
                return good.error();
            }
            count = first.count;
        }
        parts.push_back(std::move(*part));
    }
    return parts;
}

/// One run from the parts that several processes measured, in any order: as one process measures
/// it, with rows and fronts in that order. Fails if one is missing, there twice or of another run,
/// or if they were measured in different environments.
Result<Results> merged(std::vector<Results> parts);

/// Reads results; if the name has "%d", all parts ("part-%d.json"), as one run. Fails as
/// read_json_report() and merged().
Result<Results> read_result_parts(const std::filesystem::path& name);

/// Whether a name stands for the files of parts: it has "%d".
bool names_parts(const std::filesystem::path& name);

} // namespace reljef::bench
