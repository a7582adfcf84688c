#include "bench/suites/compare_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reljef::bench {
namespace {

using FigureRows = std::map<std::string, const FigureJson*>;

// Text without quotes, so that names read as in tables.
std::string name_part(const FigureJson& value) {
    return value.is_string() ? value.get<std::string>()
                             : value.dump(-1, ' ', false, FigureJson::error_handler_t::replace);
}

// "overview, polygons"; further rows of that name end in " (2)", " (3)" …
std::vector<std::string> names_of_rows(const FigureTable& table) {
    std::map<std::string, int> counts;
    std::vector<std::string> names;
    for (const FigureJson& row : table.rows) {
        std::vector<std::string> parts;
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            const bool is_name = table.columns[i].role != FigureColumn::Role::measured;
            if (is_name && !row.at(i).is_null()) {
                parts.push_back(name_part(row.at(i)));
            }
        }
        std::string name = fmt::format("{}", fmt::join(parts, ", "));
        const int count = ++counts[name];
        names.push_back(count == 1 ? name : fmt::format("{} ({})", name, count));
    }
    return names;
}

FigureRows figure_rows(const FigureTable& table, const std::vector<std::string>& names) {
    FigureRows rows;
    for (std::size_t i = 0; i < names.size(); ++i) {
        rows.emplace(names[i], &table.rows[i]);
    }
    return rows;
}

std::vector<std::string> names_without(const std::vector<std::string>& names,
                                       const FigureRows& others) {
    std::vector<std::string> left;
    std::copy_if(names.begin(), names.end(), std::back_inserter(left),
                 [&](const std::string& name) { return !others.contains(name); });
    return left;
}

bool is_time(const FigureColumn& column) {
    return column.unit == "ms" || column.unit == "s";
}

// The finite number of a row at a key; absent: there is none.
std::optional<double> number_at(const FigureTable& table, const FigureJson& row,
                                const std::string& key) {
    const auto column = std::find_if(table.columns.begin(), table.columns.end(),
                                     [&](const FigureColumn& each) { return each.key == key; });
    if (column == table.columns.end()) {
        return std::nullopt;
    }
    const FigureJson& value = row.at(static_cast<std::size_t>(column - table.columns.begin()));
    const double number = value.is_number() ? value.get<double>() : std::nan("");
    return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

// A sentence for each setting that only one run has or both have with other values.
std::vector<std::string> notes_on_settings(const FigureJson& a, const FigureJson& b) {
    std::vector<std::string> notes;
    if (!a.is_object() || !b.is_object()) {
        return notes;
    }
    FigureJson all = a;
    all.update(b);
    for (const auto& [name, value] : all.items()) {
        const std::string before = a.contains(name) ? name_part(a.at(name)) : "none";
        const std::string after = b.contains(name) ? name_part(b.at(name)) : "none";
        if (before != after) {
            notes.push_back(fmt::format("Other settings: {} {} in the first run, {} in the second.",
                                        name, before, after));
        }
    }
    return notes;
}

class FigureComparison {
public:
    FigureComparison(const FigureTable& a, const FigureTable& b, double threshold)
        : a_(a), b_(b), threshold_(threshold) {
        comparison_.same_environment = is_same_environment(a.environment, b.environment);
        if (!comparison_.same_environment) {
            comparison_.notes.emplace_back("The environments differ: times are not compared.");
        }
        add_stop(comparison_.notes, a.end.stopped, "first");
        add_stop(comparison_.notes, b.end.stopped, "second");
    }

    Comparison run() {
        const auto names_a = names_of_rows(a_);
        const auto names_b = names_of_rows(b_);
        const FigureRows rows_a = figure_rows(a_, names_a);
        const FigureRows rows_b = figure_rows(b_, names_b);
        comparison_.only_a = names_without(names_a, rows_b);
        comparison_.only_b = names_without(names_b, rows_a);
        for (std::size_t i = 0; i < names_a.size(); ++i) {
            if (const auto after = rows_b.find(names_a[i]); after != rows_b.end()) {
                compare_rows(names_a[i], a_.rows[i], *after->second);
            }
        }
        return std::move(comparison_);
    }

private:
    void compare_rows(const std::string& name, const FigureJson& a, const FigureJson& b) {
        for (const FigureColumn& column : a_.columns) {
            const bool is_skipped = column.better == FigureColumn::Better::none ||
                                    (is_time(column) && !comparison_.same_environment);
            if (is_skipped) {
                continue;
            }
            if (is_time(column) && column.noise.empty()) {
                add_untimed(name);
            } else {
                compare_figures(name, column, a, b);
            }
        }
    }

    void add_untimed(const std::string& name) {
        if (comparison_.untimed.empty() || comparison_.untimed.back() != name) {
            comparison_.untimed.push_back(name);
        }
    }

    void compare_figures(const std::string& name, const FigureColumn& column, const FigureJson& a,
                         const FigureJson& b) {
        const auto before = number_at(a_, a, column.key);
        const auto after = number_at(b_, b, column.key);
        if (!before && !after) {
            return;
        }
        double noise = threshold_;
        if (!column.noise.empty()) {
            const auto noise_a = number_at(a_, a, column.noise);
            const auto noise_b = number_at(b_, b, column.noise);
            if (!noise_a || !noise_b) {
                add_untimed(name);
                return;
            }
            noise = std::max({noise, *noise_a, *noise_b});
        }
        const double none = (column.better == FigureColumn::Better::less ? 1.0 : -1.0) *
                            std::numeric_limits<double>::infinity();
        Change change{name, heading_text(column), before.value_or(none), after.value_or(none),
                      noise};
        const bool is_within = !column.limit.empty() && before && after &&
                               *before <= number_at(a_, a, column.limit).value_or(-INFINITY) &&
                               *after <= number_at(b_, b, column.limit).value_or(-INFINITY);
        change.verdict = is_within ? Verdict::same : verdict_of_change(change, column.better);
        comparison_.changes.push_back(std::move(change));
    }

    static Verdict verdict_of_change(const Change& change, FigureColumn::Better better) {
        const double distance = std::abs(change.after - change.before);
        const double smaller = std::min(std::abs(change.before), std::abs(change.after));
        if (change.before == change.after ||
            (std::isfinite(distance) && distance <= change.noise * smaller)) {
            return Verdict::same;
        }
        const bool is_less = change.after < change.before;
        return is_less == (better == FigureColumn::Better::less) ? Verdict::better : Verdict::worse;
    }

    const FigureTable& a_;
    const FigureTable& b_;
    double threshold_;
    Comparison comparison_;
};

} // namespace

Comparison compare(const FigureTable& a, const FigureTable& b, double threshold) {
    check(threshold >= 0.0, "a threshold below 0");
    Comparison comparison = FigureComparison(a, b, threshold).run();
    for (std::string& note : notes_on_settings(a.settings, b.settings)) {
        comparison.notes.push_back(std::move(note));
    }
    return comparison;
}

} // namespace reljef::bench
