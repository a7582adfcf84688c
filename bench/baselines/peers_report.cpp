#include "bench/baselines/peers_report.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "app/cli/message.h"
#include "bench/report/environment_json.h"
#include "engine/core/atomic_file.h"

namespace reljef::bench {
namespace {

using PeersJson = nlohmann::ordered_json;

const char* camera_word(const PeerRow& row) {
    return row.moving ? "moving" : "still";
}

PeersJson row_json(const PeerRow& row) {
    PeersJson json{{"pose", scene::to_string(row.pose)},
                   {"what", row.what},
                   {"camera", camera_word(row)},
                   {"frames", row.frames},
                   {"ms", {{"median", row.ms.median}, {"p95", row.ms.p95}, {"p99", row.ms.p99}}},
                   {"fps", 1000.0 / row.ms.median},
                   {"triangles", row.triangles},
                   {"reprojection_px", nullptr}};
    if (row.error) {
        json["reprojection_px"] = {{"median", row.error->median}, {"p95", row.error->p95},
                                   {"p99", row.error->p99},       {"max", row.error->max},
                                   {"rms", row.error->rms},       {"count", row.error->count}};
    }
    return json;
}

// Of the row that keeps an error of one pixel, as the other is seen.
double own_ms(const PeersResults& results, const PeerRow& as) {
    const std::string reference = scene::to_string(reference_technique);
    const auto own = std::find_if(results.rows.begin(), results.rows.end(), [&](const auto& row) {
        return row.pose == as.pose && row.moving == as.moving && row.what == reference;
    });
    return own == results.rows.end() ? 0.0 : own->ms.median;
}

std::string row_line(const PeersResults& results, const PeerRow& row) {
    const std::string error = row.error ? fmt::format("{:>9.3f} {:>9.3f} {:>9.3f}", row.error->max,
                                                      row.error->p99, row.error->rms)
                                        : fmt::format("{:>9} {:>9} {:>9}", "-", "-", "-");
    return fmt::format("{:<9} {:<18} {:<6} {:>6} {:>8.2f} {:>8.2f} {:>9.2f} {:>10} {}\n",
                       scene::to_string(row.pose), row.what, camera_word(row), row.frames,
                       row.ms.median, row.ms.p95, row.ms.median / own_ms(results, row),
                       row.triangles, error);
}

} // namespace

std::string peers_json(const PeersResults& results) {
    const PeersOptions& options = results.options;
    PeersJson report{
        {"schema", "reljef-bench-peers/1"},
        {"complete", !results.stopped.has_value()},
        {"stopped", results.stopped ? PeersJson(results.stopped->message) : PeersJson()},
        {"environment", environment_json(results.environment)},
        {"terrain", options.terrain},
        {"side", results.side},
        {"size", fmt::format("{}x{}", options.suite.size.x, options.suite.size.y)},
        {"rows", PeersJson::array()}};
    for (const PeerRow& row : results.rows) {
        report["rows"].push_back(row_json(row));
    }
    // File names need not be UTF-8.
    return report.dump(2, ' ', false, PeersJson::error_handler_t::replace) + "\n";
}

std::string peers_table(const PeersResults& results) {
    std::string text = fmt::format(
        "{}, {} x {} samples, {}x{}, {}, {} threads\n", cli::printable(results.options.terrain),
        results.side, results.side, results.options.suite.size.x, results.options.suite.size.y,
        cli::printable(results.environment.renderer), results.environment.threads);
    text += fmt::format("{:<9} {:<18} {:<6} {:>6} {:>8} {:>8} {:>9} {:>10} {:>9} {:>9} {:>9}\n",
                        "pose", "what", "camera", "frames", "ms", "p95", "x error=1", "triangles",
                        "max px", "p99 px", "rms px");
    for (const PeerRow& row : results.rows) {
        text += row_line(results, row);
    }
    return text;
}

Result<void> report(const PeersResults& results, const std::filesystem::path& json) {
    if (results.rows.empty()) {
        return results.stopped.value_or(Error{"no rows found, some were expected"});
    }
    Result<void> written;
    if (!results.failed && !json.empty()) {
        written = write_text_file(json, peers_json(results));
    }
    fmt::print("{}", peers_table(results));
    if (std::fflush(stdout) != 0 || !written) {
        return written;
    }
    return results.stopped ? Result<void>(*results.stopped) : Result<void>();
}

} // namespace reljef::bench
