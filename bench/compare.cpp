#include "bench/compare.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace reljef::bench {
namespace {

// Of errors, pixels and percent: below it lies rounding.
constexpr double least_error_change = 1e-3;

std::string row_name(const Row& row) {
    return fmt::format("{}, {}{}, {}, {}, {}x{}", row.suite,
                       row.test.empty() ? "" : row.test + ", ", row.scene,
                       scene::to_string(row.pose), row.setting.label, row.size.x, row.size.y);
}

bool is_same_environment(const Environment& a, const Environment& b) {
    return a.renderer == b.renderer && a.gl == b.gl && a.context == b.context &&
           a.threads == b.threads && a.cpu == b.cpu;
}

bool counts(const Row& row) {
    return !row.null_row && !row.missing();
}

const Row* row_named(const std::vector<Row>& rows, const std::string& name) {
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& row) {
        return counts(row) && row_name(row) == name;
    });
    return found == rows.end() ? nullptr : &*found;
}

std::vector<std::string> names_only_in(const Results& here, const Results& there) {
    std::vector<std::string> names;
    for (const Row& row : here.rows) {
        if (counts(row) && row_named(there.rows, row_name(row)) == nullptr) {
            names.push_back(row_name(row));
        }
    }
    return names;
}

Verdict verdict_of(const Change& change, bool is_beyond_noise) {
    if (!is_beyond_noise || change.after == change.before) {
        return Verdict::same;
    }
    return change.after < change.before ? Verdict::better : Verdict::worse;
}

bool overlap(const ConfidenceInterval& a, const ConfidenceInterval& b) {
    return a.low <= b.high && b.low <= a.high;
}

ConfidenceInterval scaled(const ConfidenceInterval& interval, double factor) {
    return {factor * interval.low, factor * interval.high};
}

// Times, or their ratios to texture.
Change time_change(const Row& a, const Row& b, bool as_ratio, double threshold) {
    const auto unit = [&](const Timing& timing) {
        return as_ratio ? timing.ratio_to_texture / timing.ms.median : 1.0;
    };
    const double unit_a = unit(*a.timing);
    const double unit_b = unit(*b.timing);
    Change change{row_name(a), as_ratio ? "ratio to texture" : "median ms",
                  unit_a * a.timing->ms.median, unit_b * b.timing->ms.median};
    change.noise = std::max(
        {threshold, a.timing->noise_floor.value_or(0.0), b.timing->noise_floor.value_or(0.0)});
    const bool is_beyond =
        relative_distance(change.before, change.after) > change.noise &&
        !overlap(scaled(a.timing->interval, unit_a), scaled(b.timing->interval, unit_b));
    change.verdict = verdict_of(change, is_beyond);
    return change;
}

Change error_change(const std::string& row, const std::string& figure, double before, double after,
                    double threshold) {
    Change change{row, figure, before, after, threshold};
    const double distance = std::abs(after - before);
    const bool is_beyond = before != after && distance > least_error_change &&
                           (std::isinf(distance) || distance > threshold * std::min(before, after));
    change.verdict = verdict_of(change, is_beyond);
    return change;
}

double reprojection_of(const RowError& error) {
    return error.reprojection_px && error.reprojection_px->unbounded == 0
               ? error.reprojection_px->distribution.rms
               : std::numeric_limits<double>::infinity();
}

std::vector<Change> changes_of(const Row& a, const Row& b, bool as_ratio, double threshold) {
    std::vector<Change> changes{time_change(a, b, as_ratio, threshold)};
    if (a.error && b.error) {
        changes.push_back(error_change(row_name(a), "error px", reprojection_of(*a.error),
                                       reprojection_of(*b.error), threshold));
        changes.push_back(error_change(row_name(a), "wrong %", a.error->wrong_percent,
                                       b.error->wrong_percent, threshold));
    }
    return changes;
}

// "3.20" to "4.80" as "+50 %"; from nothing, or to no bound, nothing to tell in percent.
std::string percent_text(const Change& change) {
    const double share = (change.after - change.before) / change.before;
    return std::isfinite(share) ? fmt::format(" ({:+.1f} %)", 100.0 * share) : "";
}

std::string changes_text(const std::vector<Change>& changes, Verdict verdict,
                         std::string_view title) {
    std::string text;
    for (const Change& change : changes) {
        if (change.verdict == verdict) {
            text += fmt::format("  {}: {} {:.4g} -> {:.4g}{}\n", change.row, change.figure,
                                change.before, change.after, percent_text(change));
        }
    }
    return text.empty() ? "" : fmt::format("{}:\n{}", title, text);
}

std::string names_text(const std::vector<std::string>& names, std::string_view title) {
    std::string text;
    for (const std::string& name : names) {
        text += fmt::format("  {}\n", name);
    }
    return text.empty() ? "" : fmt::format("{}:\n{}", title, text);
}

std::ptrdiff_t count_of(const std::vector<Change>& changes, Verdict verdict) {
    return std::count_if(changes.begin(), changes.end(),
                         [&](const Change& change) { return change.verdict == verdict; });
}

} // namespace

std::size_t Comparison::regressions() const {
    return static_cast<std::size_t>(count_of(changes, Verdict::worse));
}

Comparison compare(const Results& a, const Results& b, const CompareOptions& options) {
    check(options.threshold >= 0.0, "a threshold below 0");
    Comparison comparison;
    comparison.same_environment = is_same_environment(a.environment, b.environment);
    comparison.only_a = names_only_in(a, b);
    comparison.only_b = names_only_in(b, a);
    for (const Row& row : a.rows) {
        const std::string name = row_name(row);
        const Row* after = row_named(b.rows, name);
        if (row_named(a.rows, name) == &row && after != nullptr) {
            const auto changes =
                changes_of(row, *after, !comparison.same_environment, options.threshold);
            comparison.changes.insert(comparison.changes.end(), changes.begin(), changes.end());
        }
    }
    return comparison;
}

std::string comparison_report(const Comparison& comparison) {
    const std::string environment =
        comparison.same_environment
            ? ""
            : "The environments differ: times are told as ratios to texture, of each run.\n";
    return environment + changes_text(comparison.changes, Verdict::worse, "worse") +
           changes_text(comparison.changes, Verdict::better, "better") +
           names_text(comparison.only_a, "only in the first") +
           names_text(comparison.only_b, "only in the second") +
           fmt::format("{} worse, {} better, {} the same within the noise\n",
                       count_of(comparison.changes, Verdict::worse),
                       count_of(comparison.changes, Verdict::better),
                       count_of(comparison.changes, Verdict::same));
}

} // namespace reljef::bench
