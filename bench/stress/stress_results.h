#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/report/figure_table.h"
#include "bench/report/results.h"
#include "bench/runner/suite_options.h"
#include "engine/core/parallel_for.h"
#include "engine/scene/technique/technique.h"

namespace reljef::bench {

/// A figure of a stress, with its limit.
struct StressRow {
    std::string stress;               ///< the name of the stress, "grazing"
    std::string terrain = {};         ///< empty: none
    std::string technique = {};       ///< its text; empty: none
    std::string figure = {};          ///< what is measured, with its unit
    double value = 0.0;               ///< the worst case; over any limit if it is not a number
    std::optional<double> limit = {}; ///< largest allowed value; absent: reported only
    std::string at = {};              ///< the worst case; empty: all cases are alike
    std::string known = {};           ///< what is known of a figure over its limit; set by add()
    std::string only = {};            ///< the word of --only that measures it
};

enum class StressVerdict {
    within,
    reported, ///< it has no limit
    known,    ///< over the limit, and listed in known_failures.cpp
    over,
};
StressVerdict verdict_of(const StressRow& row);
/// "ok", "reported", "known", "OVER".
std::string_view to_string(StressVerdict verdict);

struct StressOptions {
    SuiteOptions suite;
    std::vector<std::string> terrains;        ///< besides the made ones; empty: natural and urban
    std::vector<scene::Technique> techniques; ///< empty: all that draw terrains
    std::vector<std::string> stresses;        ///< of stress_names(); empty: all
    std::uint32_t seed = 1;                   ///< of random cases
    std::optional<int> poses;                 ///< of the error bound; absent: a usual number
    int skip = 0;                             ///< of these, left out at the beginning
    Shard shard = {};                         ///< of the requested stresses
};

struct StressResults {
    Environment environment = {};
    StressOptions options = {};
    std::vector<StressRow> rows = {};
    RunEnd end = {};

    /// Adds a row, and what is known of it.
    void add(StressRow row);
    /// Rows that are over their limit and not known.
    [[nodiscard]] std::size_t failures() const;
};

inline PartOrigin origin_of(const StressResults& part) {
    return {part.options.shard, part.environment};
}

/// What will bring a row within its limit; empty if it should be within it today.
std::string_view known_failure(const StressRow& row);

/// All rows, for files.
FigureTable figure_table(const StressResults& results);
/// Reads what figure_json() wrote of figure_table(): what of the options is in it, and all rows. A
/// value that was no finite number is not a number. Fails as read_report().
Result<StressResults> read_stress_report(const std::filesystem::path& file);

/// One run from the parts that several processes measured, in any order. `stresses`:
/// stress_names(), the order of the rows. Fails as merged() of Results, and if the parts have other
/// options.
Result<StressResults> merged(std::vector<StressResults> parts,
                             std::span<const std::string> stresses);
/// One line for each stress and figure, the rows over their limits and the known ones.
std::string stress_text(const StressResults& results);

} // namespace reljef::bench
