#include "bench/suites/promise_report.h"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "app/cli/message.h"
#include "bench/report/environment_json.h"
#include "engine/core/atomic_file.h"

namespace reljef::bench {
namespace {

using PromiseJson = nlohmann::ordered_json;

PromiseJson camera_json(const scene::Camera& camera) {
    return {{"eye", {camera.eye.x, camera.eye.y, camera.eye.z}},
            {"look", {camera.target.x, camera.target.y, camera.target.z}},
            {"fov", camera.vertical_fov}};
}

PromiseJson row_json(const PromiseRow& row) {
    PromiseJson json{
        {"scene", row.scene},
        {"views", row.views},
        {"max_error", row.error},
        {"frames", row.frames},
        {"pixels", row.pixels},
        {"violations", row.violations},
        {"holes", row.holes},
        {"worst_px", std::isfinite(row.worst_px) ? PromiseJson(row.worst_px) : PromiseJson()},
        {"worst_view", row.worst ? camera_json(*row.worst) : PromiseJson()},
        {"triangles", row.triangles ? PromiseJson(*row.triangles) : PromiseJson()},
        {"ms", nullptr}};
    if (row.ms) {
        json["ms"] = {{"median", row.ms->median}, {"p95", row.ms->p95}, {"p99", row.ms->p99}};
    }
    return json;
}

std::string row_line(const PromiseRow& row) {
    std::string line = fmt::format("{:<24} {:<8} {:>5} {:>7} {:>12} {:>10} {:>6} {:>9.4f}",
                                   cli::printable(row.scene), row.views, row.error, row.frames,
                                   row.pixels, row.violations, row.holes, row.worst_px);
    if (row.triangles && row.ms) {
        line += fmt::format(" {:>10.0f} {:>7.2f} {:>7.2f}", *row.triangles, row.ms->median,
                            row.ms->p99);
    }
    return line + "\n";
}

} // namespace

std::string promise_json(const PromiseResults& results) {
    const PromiseOptions& options = results.options;
    PromiseJson report{
        {"schema", "reljef-bench-promise/1"},
        {"complete", !results.stopped.has_value()},
        {"stopped", results.stopped ? PromiseJson(results.stopped->message) : PromiseJson()},
        {"environment", environment_json(results.environment)},
        {"size", fmt::format("{}x{}", options.suite.size.x, options.suite.size.y)},
        {"max_error", options.error},
        {"poses", options.poses},
        {"seed", options.seed},
        {"rows", PromiseJson::array()}};
    for (const PromiseRow& row : results.rows) {
        report["rows"].push_back(row_json(row));
    }
    // File names need not be UTF-8.
    return report.dump(2, ' ', false, PromiseJson::error_handler_t::replace) + "\n";
}

std::string promise_table(const PromiseResults& results) {
    std::string text =
        fmt::format("--max-error {}, {}x{}, {}, {} threads\n", results.options.error,
                    results.options.suite.size.x, results.options.suite.size.y,
                    cli::printable(results.environment.renderer), results.environment.threads);
    text += fmt::format("{:<24} {:<8} {:>5} {:>7} {:>12} {:>10} {:>6} {:>9} {:>10} {:>7} {:>7}\n",
                        "scene", "views", "px", "frames", "pixels", "violations", "holes",
                        "worst px", "triangles", "ms", "p99");
    for (const PromiseRow& row : results.rows) {
        text += row_line(row);
    }
    return text;
}

Result<void> report(const PromiseResults& results, const std::filesystem::path& json) {
    if (results.rows.empty()) {
        return results.stopped.value_or(Error{"no views found, some were expected"});
    }
    Result<void> written;
    if (!results.failed && !json.empty()) {
        written = write_text_file(json, promise_json(results));
    }
    fmt::print("{}", promise_table(results));
    if (std::fflush(stdout) != 0 || !written) {
        return written;
    }
    if (results.stopped) {
        return *results.stopped;
    }
    return results.kept() ? Result<void>()
                          : Error{"pixels farther off than asked for, or holes, found; none were "
                                  "expected"};
}

} // namespace reljef::bench
