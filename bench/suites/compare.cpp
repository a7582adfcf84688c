#include "bench/suites/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <fmt/format.h>

#include "app/cli/message.h"

namespace reljef::bench {
namespace {

std::string row_name(const Row& row) {
    return fmt::format("{}, {}{}, {}, {}, {}x{}", row.suite,
                       row.test.empty() ? "" : row.test + ", ", row.scene,
                       scene::to_string(row.pose), row.setting.label, row.size.x, row.size.y);
}

// The first of equal rows.
using RowsByName = std::unordered_map<std::string, const Row*>;

RowsByName rows_by_name(const std::vector<Row>& rows) {
    RowsByName named;
    for (const Row& row : rows) {
        if (!row.null_row) {
            named.emplace(row_name(row), &row);
        }
    }
    return named;
}

std::vector<std::string> names_only_in(const Results& here, const RowsByName& there) {
    std::vector<std::string> names;
    for (const Row& row : here.rows) {
        if (!row.null_row && !there.contains(row_name(row))) {
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

// Median in ms, or its ratio to texture.
struct MedianTime {
    double value = 0.0;
    ConfidenceInterval interval;
    double noise = 0.0;
};

// Absent if there are too few frames or no ratio.
std::optional<MedianTime> median_time(const Timing& timing, bool as_ratio) {
    if (!timing.interval || timing.frames < min_frames) {
        return std::nullopt;
    }
    const double noise = timing.noise_floor.value_or(0.0);
    if (!as_ratio) {
        return MedianTime{timing.ms.median, *timing.interval, noise};
    }
    if (!timing.ratio_to_texture) {
        return std::nullopt;
    }
    const double ratio = *timing.ratio_to_texture;
    const double factor = ratio / timing.ms.median;
    return MedianTime{
        ratio, {factor * timing.interval->low, factor * timing.interval->high}, noise};
}

std::optional<Change> time_change(const Row& a, const Row& b, bool as_ratio, double threshold) {
    const auto before = median_time(a.timing, as_ratio);
    const auto after = median_time(b.timing, as_ratio);
    if (!before || !after) {
        return std::nullopt;
    }
    Change change{row_name(a), as_ratio ? "ratio to texture" : "median ms", before->value,
                  after->value, std::max({threshold, before->noise, after->noise})};
    const bool is_beyond = relative_distance(change.before, change.after) > change.noise &&
                           !overlap(before->interval, after->interval);
    change.verdict = verdict_of(change, is_beyond);
    return change;
}

struct ErrorFigure {
    const char* name = "";
    double value = 0.0;    // infinite: absent
    double rounding = 0.0; // smaller differences do not count; in the error's unit
};

constexpr double hit_rounding = 0x1p-10;    // texels
constexpr double pixel_share = 1e-4;        // of all pixels
constexpr double flip_rounding = 1.0 / 510; // half a step of 8 bits

double rms_of(const std::optional<RowError::Geometric>& error) {
    return error ? error->distribution.rms : std::numeric_limits<double>::infinity();
}

std::array<ErrorFigure, 6> figures_of(const RowError& error, glm::ivec2 size) {
    const double pixels = static_cast<double>(size.x) * size.y;
    const double few_pixels = std::max(1.0, pixel_share * pixels);
    const std::size_t unbounded = error.reprojection_px ? error.reprojection_px->unbounded : 0;
    return {{{"error px", rms_of(error.reprojection_px), hit_rounding},
             {"pixels without bound", static_cast<double>(unbounded), 0.0},
             {"hit texels", rms_of(error.hit_texels), hit_rounding},
             {"wrong %", error.wrong_percent, 100.0 * few_pixels / pixels},
             {"holes", static_cast<double>(error.holes), few_pixels},
             {"FLIP", error.flip, flip_rounding}}};
}

Change error_change(const std::string& row, const ErrorFigure& before, const ErrorFigure& after,
                    double threshold) {
    Change change{row, before.name, before.value, after.value, threshold};
    const double distance = std::abs(after.value - before.value);
    const bool is_beyond =
        before.value != after.value && distance > before.rounding &&
        (std::isinf(distance) || distance > threshold * std::min(before.value, after.value));
    change.verdict = verdict_of(change, is_beyond);
    return change;
}

Change lost_error(const Row& a, const Row& b) {
    const auto value_in = [](const Row& row) {
        return row.error ? rms_of(row.error->reprojection_px)
                         : std::numeric_limits<double>::infinity();
    };
    Change change{row_name(a), "error px", value_in(a), value_in(b)};
    change.verdict = a.error ? Verdict::worse : Verdict::better;
    return change;
}

std::vector<Change> error_changes(const Row& a, const Row& b, double threshold) {
    if (!a.error && !b.error) {
        return {};
    }
    if (!a.error || !b.error) {
        return {lost_error(a, b)};
    }
    const auto before = figures_of(*a.error, a.size);
    const auto after = figures_of(*b.error, b.size);
    std::vector<Change> changes;
    for (std::size_t i = 0; i < before.size(); ++i) {
        changes.push_back(error_change(row_name(a), before[i], after[i], threshold));
    }
    return changes;
}

std::string figure_text(double figure) {
    return std::isfinite(figure) ? fmt::format("{:.4g}", figure) : "none";
}

// " (+50.0 %)"; empty if the change has no finite ratio.
std::string percent_text(const Change& change) {
    const double share = (change.after - change.before) / change.before;
    return std::isfinite(share) ? fmt::format(" ({:+.1f} %)", 100.0 * share) : "";
}

std::string changes_text(const std::vector<Change>& changes, Verdict verdict,
                         std::string_view title) {
    std::string text;
    for (const Change& change : changes) {
        if (change.verdict == verdict) {
            text += fmt::format("  {}: {} {} -> {}{}\n", cli::printable(change.row), change.figure,
                                figure_text(change.before), figure_text(change.after),
                                percent_text(change));
        }
    }
    return text.empty() ? "" : fmt::format("{}:\n{}", title, text);
}

std::string names_text(const std::vector<std::string>& names, std::string_view title) {
    std::string text;
    for (const std::string& name : names) {
        text += fmt::format("  {}\n", cli::printable(name));
    }
    return text.empty() ? "" : fmt::format("{}:\n{}", title, text);
}

void add_incompleteness(std::vector<std::string>& notes, const Results& results,
                        std::string_view run) {
    add_stop(notes, results.stopped, run);
    if (!results.left_out.empty()) {
        notes.push_back(fmt::format("The {} run left settings out, for want of time.", run));
    }
}

std::ptrdiff_t count_of(const std::vector<Change>& changes, Verdict verdict) {
    return std::count_if(changes.begin(), changes.end(),
                         [&](const Change& change) { return change.verdict == verdict; });
}

void add_setting(std::vector<std::string>& notes, const char* name, bool a, bool b) {
    if (a != b) {
        notes.push_back(
            fmt::format("Other settings: {} {} in the first run, {} in the second.", name, a, b));
    }
}

// Rounds differ without another result.
void add_settings(std::vector<std::string>& notes, const Results& a, const Results& b) {
    if (a.settings && b.settings) {
        add_setting(notes, "quick", a.settings->quick, b.settings->quick);
        add_setting(notes, "moving", a.settings->moving, b.settings->moving);
        add_setting(notes, "cold", a.settings->cold, b.settings->cold);
    }
}

struct VerdictWord {
    Verdict verdict;
    const char* word;
};

void add_changes(FigureTable& table, const std::vector<Change>& changes, VerdictWord kind) {
    for (const Change& change : changes) {
        if (change.verdict == kind.verdict) {
            const double percent = 100.0 * (change.after - change.before) /
                                   (change.before == 0.0 ? std::nan("") : change.before);
            table.rows.push_back({kind.word, change.row, change.figure, change.before, change.after,
                                  percent, 100.0 * change.noise});
        }
    }
}

void add_names(FigureTable& table, const std::vector<std::string>& names, const char* word) {
    for (const std::string& name : names) {
        table.rows.push_back({word, name, nullptr, nullptr, nullptr, nullptr, nullptr});
    }
}

} // namespace

bool is_same_environment(const Environment& a, const Environment& b) {
    return a.renderer == b.renderer && a.gl == b.gl && a.context == b.context &&
           a.threads == b.threads && a.cpu == b.cpu;
}

void add_stop(std::vector<std::string>& notes, const std::optional<Error>& stopped,
              std::string_view run) {
    if (stopped) {
        notes.push_back(
            fmt::format("The {} run ended early: {}.", run, in_one_line(stopped->message)));
    }
}

FigureTable figure_table(const Comparison& comparison, const ComparedRuns& runs) {
    using namespace columns;
    FigureTable table{.suite = "compare",
                      .environment = runs.environment,
                      .shard = {},
                      .settings = {{"before", runs.before},
                                   {"after", runs.after},
                                   {"suite", runs.suite},
                                   {"threshold", runs.threshold}},
                      .summary = {{"worse", count_of(comparison.changes, Verdict::worse)},
                                  {"better", count_of(comparison.changes, Verdict::better)},
                                  {"same", count_of(comparison.changes, Verdict::same)},
                                  {"gone", comparison.only_a.size()},
                                  {"new", comparison.only_b.size()},
                                  {"untimed", comparison.untimed.size()}},
                      .columns = {group("/verdict", "verdict"), name("/row", "row"),
                                  name("/figure", "figure"), plain("/before", "before", "", 4),
                                  plain("/after", "after", "", 4),
                                  plain("/change_percent", "change", "%", 1),
                                  plain("/noise_percent", "noise", "%", 1)},
                      .rows = {},
                      .notes = comparison.notes};
    add_changes(table, comparison.changes, {Verdict::worse, "worse"});
    add_names(table, comparison.only_a, "gone");
    add_changes(table, comparison.changes, {Verdict::better, "better"});
    add_names(table, comparison.only_b, "new");
    add_names(table, comparison.untimed, "untimed");
    add_changes(table, comparison.changes, {Verdict::same, "same"});
    return table;
}

std::size_t Comparison::regressions() const {
    return static_cast<std::size_t>(count_of(changes, Verdict::worse)) + only_a.size();
}

Comparison compare(const Results& a, const Results& b, double threshold) {
    check(threshold >= 0.0, "a threshold below 0");
    Comparison comparison;
    comparison.same_environment = is_same_environment(a.environment, b.environment);
    const RowsByName rows_a = rows_by_name(a.rows);
    const RowsByName rows_b = rows_by_name(b.rows);
    comparison.only_a = names_only_in(a, rows_b);
    comparison.only_b = names_only_in(b, rows_a);
    if (!comparison.same_environment) {
        comparison.notes.emplace_back("The environments differ: times are compared as ratios to "
                                      "texture of the same run.");
    }
    add_incompleteness(comparison.notes, a, "first");
    add_incompleteness(comparison.notes, b, "second");
    add_settings(comparison.notes, a, b);
    for (const Row& row : a.rows) {
        const std::string name = row_name(row);
        const auto first = rows_a.find(name);
        const auto after = rows_b.find(name);
        if (after == rows_b.end() || first == rows_a.end() || first->second != &row) {
            continue;
        }
        const bool as_ratio = !comparison.same_environment;
        if (auto time = time_change(row, *after->second, as_ratio, threshold)) {
            comparison.changes.push_back(std::move(*time));
        } else {
            comparison.untimed.push_back(name);
        }
        const auto errors = error_changes(row, *after->second, threshold);
        comparison.changes.insert(comparison.changes.end(), errors.begin(), errors.end());
    }
    return comparison;
}

std::string comparison_report(const Comparison& comparison) {
    std::string notes;
    for (const std::string& note : comparison.notes) {
        notes += cli::printable(note) + "\n";
    }
    return notes + changes_text(comparison.changes, Verdict::worse, "worse") +
           changes_text(comparison.changes, Verdict::better, "better") +
           names_text(comparison.only_a, "gone, only in the first") +
           names_text(comparison.only_b, "only in the second") +
           names_text(
               comparison.untimed,
               fmt::format(
                   "no verdict of time: under {} frames, no noise floor or no ratio to texture",
                   min_frames)) +
           fmt::format("{} worse, {} better, {} the same within the noise, {} gone\n",
                       count_of(comparison.changes, Verdict::worse),
                       count_of(comparison.changes, Verdict::better),
                       count_of(comparison.changes, Verdict::same), comparison.only_a.size());
}

} // namespace reljef::bench
