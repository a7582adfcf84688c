#include "bench/suites/growth_report.h"

#include <cstdio>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/message.h"
#include "bench/report/environment_json.h"
#include "engine/core/atomic_file.h"

namespace reljef::bench {
namespace {

using GrowthJson = nlohmann::ordered_json;
constexpr double megabyte = 1024.0 * 1024.0;

GrowthJson row_json(const GrowthRow& row) {
    return {{"side", row.side},
            {"pose", scene::to_string(row.pose)},
            {"streamed", row.streamed},
            {"first_picture_s", row.first_picture},
            {"last_picture_s", row.last_picture},
            {"frames", row.frames},
            {"ms", {{"median", row.ms.median}, {"p95", row.ms.p95}, {"p99", row.ms.p99}}},
            {"tiles", row.tiles},
            {"triangles", row.triangles},
            {"memory_bytes", row.memory_bytes},
            {"pixels", row.pixels},
            {"worst_px", row.worst_px},
            {"p99_px", row.p99_px}};
}

GrowthJson marks_json(const GrowthResults& results) {
    const auto marks = marks_of(results);
    if (!marks) {
        return {};
    }
    const MetMarks met = met_marks(*marks, results.options);
    return {{"frame_ratio", marks->frame_ratio},
            {"first_picture_s", marks->first_picture},
            {"memory_bytes", marks->memory_bytes},
            {"met",
             {{"frame_ratio", met.frame_ratio},
              {"first_picture_s", met.first_picture},
              {"memory_bytes", met.memory}}}};
}

const std::vector<std::string>& columns() {
    static const std::vector<std::string> names{"side",      "pose", "ground",   "first s",
                                                "last s",    "ms",   "p99 ms",   "tiles",
                                                "triangles", "MB",   "worst px", "p99 px"};
    return names;
}

std::vector<std::string> cells_of(const GrowthRow& row) {
    return {fmt::format("{}", row.side),
            std::string(scene::to_string(row.pose)),
            row.streamed ? "read" : "whole",
            fmt::format("{:.2f}", row.first_picture),
            fmt::format("{:.2f}", row.last_picture),
            fmt::format("{:.2f}", row.ms.median),
            fmt::format("{:.2f}", row.ms.p99),
            fmt::format("{}", row.tiles),
            fmt::format("{}", row.triangles),
            fmt::format("{:.0f}", static_cast<double>(row.memory_bytes) / megabyte),
            fmt::format("{:.3f}", row.worst_px),
            fmt::format("{:.3f}", row.p99_px)};
}

std::string heading(const GrowthResults& results) {
    const GrowthOptions& options = results.options;
    return fmt::format("--max-error {}, --memory {}, {}x{}, {}, {} threads", options.error,
                       options.memory_megabytes, options.suite.size.x, options.suite.size.y,
                       cli::printable(results.environment.renderer), results.environment.threads);
}

std::string_view verdict(bool is_met) {
    return is_met ? "met" : "missed";
}

// What was asked for, and what came of it.
std::string marks_text(const GrowthResults& results) {
    const auto marks = marks_of(results);
    if (!marks) {
        return "";
    }
    const MetMarks met = met_marks(*marks, results.options);
    return fmt::format(
        "the most samples over the fewest: {:.2f} times the frame (at most {}: {}); "
        "first picture after {:.2f} s (at most {}: {}); {:.0f} MB (at most {}: {})\n",
        marks->frame_ratio, max_frame_ratio, verdict(met.frame_ratio), marks->first_picture,
        max_first_picture, verdict(met.first_picture),
        static_cast<double>(marks->memory_bytes) / megabyte, results.options.memory_megabytes,
        verdict(met.memory));
}

} // namespace

std::string growth_json(const GrowthResults& results) {
    const GrowthOptions& options = results.options;
    GrowthJson report{
        {"schema", "reljef-bench-growth/1"},
        {"complete", !results.stopped.has_value()},
        {"stopped", results.stopped ? GrowthJson(results.stopped->message) : GrowthJson()},
        {"environment", environment_json(results.environment)},
        {"size", fmt::format("{}x{}", options.suite.size.x, options.suite.size.y)},
        {"max_error", options.error},
        {"memory_mb", options.memory_megabytes},
        {"rows", GrowthJson::array()},
        {"marks", marks_json(results)}};
    for (const GrowthRow& row : results.rows) {
        report["rows"].push_back(row_json(row));
    }
    return report.dump(2, ' ', false, GrowthJson::error_handler_t::replace) + "\n";
}

std::string growth_table(const GrowthResults& results) {
    std::string text = heading(results) + "\n";
    const auto add_line = [&](const std::vector<std::string>& cells) {
        for (const std::string& cell : cells) {
            text += fmt::format("{:>10}", cell);
        }
        text += "\n";
    };
    add_line(columns());
    for (const GrowthRow& row : results.rows) {
        add_line(cells_of(row));
    }
    return text + marks_text(results);
}

std::string growth_markdown(const GrowthResults& results) {
    std::string text = fmt::format("# The same ground by more samples\n\n{}\n\n| {} |\n|--:|:--",
                                   heading(results), fmt::join(columns(), " | "));
    for (std::size_t i = 2; i < columns().size(); ++i) {
        text += "|--:";
    }
    text += "|\n";
    for (const GrowthRow& row : results.rows) {
        text += fmt::format("| {} |\n", fmt::join(cells_of(row), " | "));
    }
    return text + "\n" + marks_text(results);
}

Result<void> report(const GrowthResults& results, const std::filesystem::path& json,
                    const std::filesystem::path& markdown) {
    if (results.rows.empty()) {
        return results.stopped.value_or(Error{"no views found, some were expected"});
    }
    Result<void> written;
    if (!results.failed && !json.empty()) {
        written = write_text_file(json, growth_json(results));
    }
    if (written && !results.failed && !markdown.empty()) {
        written = write_text_file(markdown, growth_markdown(results));
    }
    fmt::print("{}", growth_table(results));
    if (std::fflush(stdout) != 0 || !written) {
        return written;
    }
    return results.stopped ? Result<void>(*results.stopped) : Result<void>();
}

} // namespace reljef::bench
