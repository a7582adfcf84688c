#include "bench/report/report_text.h"

#include <fmt/format.h>

#include "bench/report/report_table.h"

namespace reljef::bench {
namespace {

constexpr std::string_view csv_names =
    "suite,test,scene,pose,technique,null_row,missing,noisy,width,height,frames,median_ms,"
    "interval_low_ms,interval_high_ms,p95_ms,p99_ms,fps,fps_1_percent_low,ratio_to_texture,"
    "noise_floor,triangles,reprojection_rms_px,reprojection_median_px,reprojection_p95_px,"
    "reprojection_p99_px,reprojection_max_px,reprojection_unbounded,hit_rms_texels,"
    "hit_max_texels,wrong_percent,holes,rmse,psnr_db,ssim,flip,source_fps,source_ratio,"
    "unproven_search\n";

std::string or_empty(const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : "";
}

std::string csv_description(const Row& row) {
    return fmt::format("{},{},{},{},{},{},{},{},{},{}", csv_quoted(row.suite), csv_quoted(row.test),
                       csv_quoted(row.scene), scene::to_string(row.pose),
                       csv_quoted(row.setting.label), row.null_row, false, row.noisy(), row.size.x,
                       row.size.y);
}

std::string csv_interval(const std::optional<ConfidenceInterval>& interval) {
    return interval ? fmt::format("{},{}", interval->low, interval->high) : ",";
}

std::string csv_timing(const Timing& timing) {
    return fmt::format("{},{},{},{},{},{},{},{},{},{}", timing.frames, timing.ms.median,
                       csv_interval(timing.interval), timing.ms.p95, timing.ms.p99,
                       1000.0 / timing.ms.median, timing.fps_1_percent_low,
                       or_empty(timing.ratio_to_texture), or_empty(timing.noise_floor),
                       timing.stats.triangles);
}

std::string csv_reprojection(const std::optional<RowError::Geometric>& error) {
    if (!error) {
        return std::string(5, ',');
    }
    const truth::Distribution& distribution = error->distribution;
    return fmt::format("{},{},{},{},{},{}", distribution.rms, distribution.median, distribution.p95,
                       distribution.p99, distribution.max, error->unbounded);
}

std::string csv_hit(const std::optional<RowError::Geometric>& error) {
    return error ? fmt::format("{},{}", error->distribution.rms, error->distribution.max) : ",";
}

std::string csv_error(const std::optional<RowError>& error) {
    if (!error) {
        return std::string(13, ',');
    }
    return fmt::format("{},{},{},{},{},{},{},{}", csv_reprojection(error->reprojection_px),
                       csv_hit(error->hit_texels), error->wrong_percent, error->holes, error->rmse,
                       or_empty(error->psnr), or_empty(error->ssim), error->flip);
}

std::string csv_source(const std::optional<SourceFigure>& source) {
    return source ? fmt::format("{},{}", source->fps, source->ratio) : ",";
}

// What `auto` drew without a proof.
std::string csv_unproven(const std::optional<view::Choice>& choice) {
    return choice && choice->typical ? csv_quoted(choice->typical->technique) : "";
}

} // namespace

std::string csv_quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) {
        return text;
    }
    std::string result = "\"";
    for (const char c : text) {
        result += c == '"' ? std::string(2, c) : std::string(1, c);
    }
    return result + "\"";
}

std::string csv_report(const Results& results) {
    std::string text(csv_names);
    for (const Row& row : results.rows) {
        text += fmt::format("{},{},{},{},{}\n", csv_description(row), csv_timing(row.timing),
                            csv_error(row.error), csv_source(row.source),
                            csv_unproven(row.timing.stats.choice));
    }
    return text;
}

} // namespace reljef::bench
