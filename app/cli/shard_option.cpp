#include "app/cli/shard_option.h"

#include <array>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "app/cli/parsed_option.h"

namespace reljef::cli {
namespace {

struct Launcher {
    std::string_view name;
    const char* index; // variables
    const char* count; // null: it states none
};

constexpr std::array launchers{
    Launcher{"slurm", "SLURM_PROCID", "SLURM_NTASKS"},
    Launcher{"openmpi", "OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
    Launcher{"kubernetes", "JOB_COMPLETION_INDEX", nullptr},
};

Error wrong_text(const std::string& text) {
    return {
        fmt::format("--shard: '{}' found, I/N with I from 0 to N-1 and N from 1 to {}, or auto, "
                    "slurm, openmpi or kubernetes, with or without /N, was expected",
                    text, max_shards)};
}

std::optional<int> count_from(std::string_view text) {
    const auto count = number_from<int>(text);
    return count && *count >= 1 && *count <= max_shards ? count : std::nullopt;
}

Result<int> count_of(const Launcher& launcher, std::optional<int> stated,
                     const Environment& environment) {
    if (launcher.count == nullptr) {
        return stated
                   ? Result<int>(*stated)
                   : Error{fmt::format("--shard: {} found, which states no number of parts; {}/N "
                                       "was expected",
                                       launcher.name, launcher.name)};
    }
    const char* const text = environment(launcher.count);
    const auto count = text != nullptr ? count_from(text) : std::nullopt;
    if (!count) {
        return Error{
            fmt::format("--shard: ${}: '{}' found, a whole number from 1 to {} was expected",
                        launcher.count, text != nullptr ? text : "", max_shards)};
    }
    if (stated && *stated != *count) {
        return Error{fmt::format("--shard: /{} found, but ${} is {}; the same number was expected",
                                 *stated, launcher.count, *count)};
    }
    return *count;
}

Result<Shard> shard_from(const Launcher& launcher, std::optional<int> stated,
                         const Environment& environment) {
    const auto count = count_of(launcher, stated, environment);
    if (!count) {
        return count.error();
    }
    const char* const text = environment(launcher.index);
    const auto index = number_from<int>(text != nullptr ? text : "");
    if (!index || *index < 0 || *index >= *count) {
        return Error{
            fmt::format("--shard: ${}: '{}' found, a whole number from 0 to {} was expected",
                        launcher.index, text != nullptr ? text : "", *count - 1)};
    }
    return Shard{*index, *count};
}

Result<Shard> shard_from_any(std::optional<int> stated, const Environment& environment) {
    std::optional<Shard> found;
    std::string_view finder;
    for (const Launcher& launcher : launchers) {
        if (environment(launcher.index) == nullptr) {
            continue;
        }
        const auto shard = shard_from(launcher, stated, environment);
        if (!shard) {
            return shard.error();
        }
        if (found && *found != *shard) {
            return Error{fmt::format("--shard: auto found, but {} says {} and {} says {}; one of "
                                     "these words was expected",
                                     finder, shard_text(*found), launcher.name,
                                     shard_text(*shard))};
        }
        found = *shard;
        finder = launcher.name;
    }
    return found
               ? Result<Shard>(*found)
               : Error{"--shard: auto found, but none of $SLURM_PROCID, $OMPI_COMM_WORLD_RANK and "
                       "$JOB_COMPLETION_INDEX is set; I/N was expected"};
}

} // namespace

Result<Shard> parse_shard(const std::string& text, const Environment& environment) {
    const auto slash = text.find('/');
    const std::string word = text.substr(0, slash);
    const bool has_count = slash != std::string::npos;
    const auto count =
        has_count ? count_from(std::string_view(text).substr(slash + 1)) : std::nullopt;
    if (has_count && !count) {
        return wrong_text(text);
    }
    if (word == "auto") {
        return shard_from_any(count, environment);
    }
    for (const Launcher& launcher : launchers) {
        if (word == launcher.name) {
            return shard_from(launcher, count, environment);
        }
    }
    const auto index = number_from<int>(word);
    if (!index || !count || *index < 0 || *index >= *count) {
        return wrong_text(text);
    }
    return Shard{*index, *count};
}

void add_shard_option(CLI::App& command, Shard& shard, const std::string& items) {
    add_parsed(
        command, "--shard", shard,
        [](const std::string& text) {
            return parse_shard(text, [](const char* name) { return std::getenv(name); });
        },
        fmt::format(
            "do only part I of N of the {}, I from 0 to N-1: 2/8; or auto, slurm, openmpi or "
            "kubernetes/N: I and N of this process as its launcher numbers them (0/1)",
            items)
            .c_str(),
        "I/N");
}

std::string shard_text(const Shard& shard) {
    return fmt::format("{}/{}", shard.index, shard.count);
}

} // namespace reljef::cli
