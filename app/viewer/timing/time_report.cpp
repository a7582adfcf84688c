#include "app/viewer/timing/time_report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/statistics.h"

namespace reljef::app {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string moment_text(std::string_view name, const std::optional<double>& seconds) {
    return fmt::format("{:<28}{}\n", name,
                       seconds ? fmt::format("{:.3f} s after the program began", *seconds)
                               : std::string("not shown"));
}

OrderedJson json_of_moment(const std::optional<double>& seconds) {
    return seconds ? OrderedJson(*seconds) : OrderedJson();
}

OrderedJson json_of_row(const TimeRow& row) {
    OrderedJson json{{"count", row.ms.size()}};
    if (!row.ms.empty()) {
        json["median_ms"] = median(row.ms);
        json["p99_ms"] = quantile(row.ms, 0.99);
        json["max_ms"] = *std::max_element(row.ms.begin(), row.ms.end());
    }
    if (row.max_frames) {
        json["max_frames"] = *row.max_frames;
    }
    return json;
}

} // namespace

std::string text_of(const TimeReport& report) {
    std::string text = moment_text("first picture", report.first_picture) +
                       moment_text("complete picture", report.complete_picture) +
                       fmt::format("{:<28}{:>8}{:>12}{:>12}{:>12}{:>13}\n", "times, ms", "count",
                                   "median", "p99", "largest", "most frames");
    for (const TimeRow& row : report.rows) {
        if (!row.ms.empty()) {
            text += fmt::format("{:<28}{:>8}{:>12.3f}{:>12.3f}{:>12.3f}{:>13}\n", row.name,
                                row.ms.size(), median(row.ms), quantile(row.ms, 0.99),
                                *std::max_element(row.ms.begin(), row.ms.end()),
                                row.max_frames ? fmt::format("{}", *row.max_frames) : "");
        }
    }
    return text;
}

std::string json_of(const TimeReport& report) {
    OrderedJson json{{"first_picture_s", json_of_moment(report.first_picture)},
                     {"complete_picture_s", json_of_moment(report.complete_picture)}};
    for (const TimeRow& row : report.rows) {
        json[std::string(row.key)] = json_of_row(row);
    }
    return json.dump(2);
}

} // namespace reljef::app
