#include "bench/report_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/atomic_file.h"

namespace reljef::bench {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Environment& environment) {
    return {{"renderer", environment.renderer}, {"gl", environment.gl},
            {"context", environment.context},   {"threads", environment.threads},
            {"cpu", environment.cpu},           {"commit", environment.commit}};
}

Json to_json(const Summary& summary) {
    return {{"median", summary.median}, {"p95", summary.p95}, {"p99", summary.p99}};
}

Json to_json(const render::FrameStats::Skipped& skipped) {
    return {{"invisible_nodes", skipped.invisible_nodes},
            {"nodes_outside_frustum", skipped.nodes_outside_frustum},
            {"tiles_outside_frustum", skipped.tiles_outside_frustum},
            {"triangles_outside_frustum", skipped.triangles_outside_frustum},
            {"uploads_unchanged", skipped.uploads_unchanged},
            {"sky", skipped.sky}};
}

Json parameters_of(const scene::Technique& technique) {
    Json parameters = Json::object();
    const auto infos = scene::technique_info(technique.id).parameters;
    for (std::size_t i = 0; i < infos.size(); ++i) {
        if (infos[i].whole) {
            parameters[std::string(infos[i].name)] = static_cast<long long>(technique.values[i]);
        } else {
            parameters[std::string(infos[i].name)] = technique.values[i];
        }
    }
    return parameters;
}

Json to_json(const Row& row) {
    return {{"suite", row.suite},
            {"scene", row.scene},
            {"pose", scene::to_string(row.pose)},
            {"technique", scene::technique_info(row.technique.id).name},
            {"params", parameters_of(row.technique)},
            {"null_row", row.null_row},
            {"size", fmt::format("{}x{}", row.size.x, row.size.y)},
            {"frames", row.frames},
            {"ms", to_json(row.ms)},
            {"fps", 1000.0 / row.ms.median},
            {"ratio_to_texture", row.ratio_to_texture},
            {"noise_floor", row.noise_floor ? Json(*row.noise_floor) : Json()},
            {"tiles", row.stats.tiles},
            {"triangles", row.stats.triangles},
            {"draws", row.stats.draws},
            {"uploads", row.stats.uploads},
            {"skipped", to_json(row.stats.skipped)}};
}

} // namespace

std::string json_report(const Results& results) {
    Json rows = Json::array();
    for (const Row& row : results.rows) {
        rows.push_back(to_json(row));
    }
    const Json report{{"schema", "reljef-bench/1"},
                      {"complete", !results.stopped.has_value()},
                      {"environment", to_json(results.environment)},
                      {"rows", rows}};
    // File names need not be UTF-8.
    return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<void> write_json_report(const std::filesystem::path& file, const Results& results) {
    return write_text_file(file, json_report(results));
}

} // namespace reljef::bench
