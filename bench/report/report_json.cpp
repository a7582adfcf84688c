#include "bench/report/report_json.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/report/figure_table.h"
#include "engine/core/atomic_file.h"

namespace reljef::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double max_exact_whole = 9e15; // of the whole numbers a double tells apart

Json to_json(const view::FrameStats::Skipped& skipped) {
    return {{"invisible_nodes", skipped.invisible_nodes},
            {"nodes_outside_frustum", skipped.nodes_outside_frustum},
            {"tiles_outside_frustum", skipped.tiles_outside_frustum},
            {"tiles_occluded", skipped.tiles_occluded},
            {"triangles_outside_frustum", skipped.triangles_outside_frustum},
            {"triangles_under_error", skipped.triangles_under_error},
            {"selections_unchanged", skipped.selections_unchanged},
            {"cuts_unchanged", skipped.cuts_unchanged},
            {"uploads_unchanged", skipped.uploads_unchanged},
            {"sky", skipped.sky}};
}

Json parameters_of(const Setting& setting) {
    Json parameters = Json::object();
    for (const Setting::Parameter& parameter : setting.parameters) {
        const bool is_whole = parameter.value == std::trunc(parameter.value) &&
                              std::abs(parameter.value) < max_exact_whole;
        parameters[parameter.name] =
            is_whole ? Json(static_cast<long long>(parameter.value)) : Json(parameter.value);
    }
    return parameters;
}

Json or_null(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

Json to_json(const std::optional<RowError::Geometric>& error) {
    if (!error) {
        return {};
    }
    const truth::Distribution& distribution = error->distribution;
    return {{"median", distribution.median}, {"p95", distribution.p95},
            {"p99", distribution.p99},       {"max", distribution.max},
            {"rms", distribution.rms},       {"count", distribution.count},
            {"unbounded", error->unbounded}};
}

Json to_json(const RowError& error) {
    return {{"reprojection_px", to_json(error.reprojection_px)},
            {"hit_texels", to_json(error.hit_texels)},
            {"wrong_percent", error.wrong_percent},
            {"holes", error.holes},
            {"rmse", error.rmse},
            {"psnr", or_null(error.psnr)},
            {"ssim", or_null(error.ssim)},
            {"flip", error.flip}};
}

Json to_json(const std::optional<ConfidenceInterval>& interval) {
    return interval ? Json{interval->low, interval->high} : Json();
}

Json to_json(const SourceFigure& source) {
    return {{"fps", source.fps}, {"ratio", source.ratio}, {"where", source.where}};
}

Json to_json(const Timing& timing) {
    return {{"frames", timing.frames},
            {"ms",
             {{"median", timing.ms.median},
              {"p95", timing.ms.p95},
              {"p99", timing.ms.p99},
              {"interval", to_json(timing.interval)}}},
            {"fps", 1000.0 / timing.ms.median},
            {"fps_1_percent_low", timing.fps_1_percent_low},
            {"ratio_to_texture", or_null(timing.ratio_to_texture)},
            {"noise_floor", or_null(timing.noise_floor)},
            {"gpu_ms", or_null(timing.gpu_ms)},
            {"tiles", timing.stats.tiles},
            {"triangles", timing.stats.triangles},
            {"draws", timing.stats.draws},
            {"uploads", timing.stats.uploads}};
}

// The same keys, for a row that is missing.
Json without_figures(Json timing) {
    for (Json& figure : timing) {
        figure = nullptr;
    }
    return timing;
}

Json description_of(const Row& row) {
    return {{"suite", row.suite},
            {"test", row.test.empty() ? Json() : Json(row.test)},
            {"scene", row.scene},
            {"pose", scene::to_string(row.pose)},
            {"technique", row.setting.technique},
            {"params", parameters_of(row.setting)},
            {"label", row.setting.label},
            {"null_row", row.null_row},
            {"missing", row.missing()},
            {"noisy", row.noisy()},
            {"size", fmt::format("{}x{}", row.size.x, row.size.y)}};
}

Json to_json(const Row& row) {
    Json json = description_of(row);
    json.update(row.timing ? to_json(*row.timing) : without_figures(to_json(Timing{})));
    json["taps"] = nullptr; // not counted yet
    json["error"] = row.error ? to_json(*row.error) : Json();
    json["source"] = row.source ? to_json(*row.source) : Json();
    json["skipped"] = row.timing ? to_json(row.timing->stats.skipped) : Json();
    return json;
}

Json to_json(const Front& front) {
    Json dominated = Json::array();
    for (const Front::Dominated& setting : front.dominated) {
        dominated.push_back({{"label", setting.label}, {"by", setting.by}});
    }
    return {{"scene", front.scene},
            {"pose", scene::to_string(front.pose)},
            {"area", or_null(front.area)},
            {"front", front.front},
            {"dominated", std::move(dominated)},
            {"holed", front.holed}};
}

Json to_json(const LeftOut& left_out) {
    return {{"scene", left_out.scene},
            {"pose", scene::to_string(left_out.pose)},
            {"settings", left_out.settings},
            {"techniques", left_out.techniques}};
}

template <class Part> Json array_of(const std::vector<Part>& parts) {
    Json array = Json::array();
    for (const Part& part : parts) {
        array.push_back(to_json(part));
    }
    return array;
}

} // namespace

std::string json_report(const Results& results) {
    Json report{{"schema", schema_name},
                {"complete", results.complete()},
                {"stopped", results.stopped ? Json(results.stopped->message) : Json()},
                {"notes", results.notes},
                {"left_out", array_of(results.left_out)},
                {"environment", json_of(results.environment)},
                {"rows", array_of(results.rows)}};
    if (!results.fronts.empty()) {
        report["fronts"] = array_of(results.fronts);
    }
    // File names need not be UTF-8.
    return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<void> write_json_report(const std::filesystem::path& file, const Results& results) {
    return write_text_file(file, json_report(results));
}

} // namespace reljef::bench
