#include "tests/bench/page/made_page.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tests/bench/report/made_results.h"

namespace reljef::test {
namespace {

struct MadeRow {
    std::string label;
    double ms = 0.0;
    double error_px = 0.0;
    double source_fps = 0.0;
};

bench::Setting setting_named(const std::string& label) {
    const auto colon = std::min(label.find(':'), label.size());
    bench::Setting setting{label.substr(0, colon), {}, label};
    if (const auto equals = label.find('='); equals != label.npos) {
        setting.parameters.push_back(
            {label.substr(colon + 1, equals - colon - 1), std::stod(label.substr(equals + 1))});
    }
    return setting;
}

bench::RowError error_of(double rms_px) {
    bench::RowError error = made_error(rms_px);
    error.reprojection_px->unbounded = rms_px > 10.0 ? 12 : 0;
    error.wrong_percent = 100.0 * rms_px / (rms_px + 3.0);
    error.holes = static_cast<std::size_t>(40.0 * rms_px);
    error.rmse = std::min(0.02 * rms_px, 1.0);
    error.psnr = rms_px > 0.0 ? std::optional(38.0 - 9.0 * std::log10(1.0 + rms_px)) : std::nullopt;
    error.ssim = 1.0 / (1.0 + 0.05 * rms_px);
    error.flip = std::min(0.04 * std::sqrt(rms_px), 1.0);
    return error;
}

bench::Row row_of(const MadeRow& made, double texture_ms) {
    bench::Row row = made_results().rows[0];
    row.setting = setting_named(made.label);
    row.timing = made_timing(made.ms, made.ms / texture_ms);
    row.timing.stats.triangles = made.label.starts_with("polygons") ? 2'093'058 : 2;
    row.error = error_of(made.error_px);
    return row;
}

std::vector<bench::Row> rows_of(const std::string& test, const std::string& scene,
                                const std::vector<MadeRow>& made) {
    std::vector<bench::Row> rows;
    for (const MadeRow& each : made) {
        bench::Row row = row_of(each, made.front().ms);
        row.test = test;
        row.scene = scene;
        if (each.source_fps > 0.0) {
            row.source = {each.source_fps, made.front().source_fps / each.source_fps,
                          test + ", configuration 2"};
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

} // namespace

bench::Results made_report(const std::string& scene) {
    bench::Results results = made_results();
    results.rows = rows_of("relief-4", "natural",
                           {{"texture", 6.31, 7.94, 824.0},
                            {"steep:n=9", 24.6, 0.0, 0.0},
                            {"polygons:lods=1", 148.2, 0.0, 5.0},
                            {"polygons:lods=3", 31.7, 0.061, 62.0},
                            {"polygons:lods=5", 12.4, 0.43, 170.0},
                            {"parallax", 8.05, 5.12, 716.0},
                            {"relief:steps=64", 61.3, 0.18, 55.0},
                            {"exact", 93.7, 0.0004, 0.0}});
    results.rows[1].error->reprojection_px->unbounded = 3;
    results.rows.push_back(results.rows[0]);
    results.rows.back().null_row = true;
    results.rows.back().source.reset();
    std::vector<bench::Row> others = rows_of("relief-3", scene,
                                             {{"texture", 5.84, 21.7, 170.0},
                                              {"nothing", 1.03, 13.9, 0.0},
                                              {"relief:steps=64", 58.9, 2.31, 60.0},
                                              {"relief:steps=8", 17.2, 9.31, 0.0}});
    others[1].error->reprojection_px.reset();
    others[1].error->hit_texels.reset();
    others[2].timing.noise_floor = 0.143;
    others[3].timing.frames = 3;
    others[3].timing.interval.reset();
    others[3].timing.noise_floor.reset();
    results.rows.insert(results.rows.end(), others.begin(), others.end());
    results.notes = {"a note on " + scene};
    return results;
}

bench::Results made_pareto_report() {
    std::vector<MadeRow> made{{"texture", 6.31, 7.94}};
    for (int steps = 8; steps <= 256; steps *= 2) {
        made.push_back({"relief:steps=" + std::to_string(steps), 7.5 + 0.8 * steps, 22.0 / steps});
        made.push_back({"cone:steps=" + std::to_string(steps), 9.0 + 0.5 * steps, 9.0 / steps});
    }
    made.push_back({"polygons:lods=1", 148.2, 0.0});
    bench::Results results = made_results();
    results.rows = rows_of("", "natural", made);
    for (bench::Row& row : results.rows) {
        row.suite = "pareto";
    }
    bench::Front front;
    front.scene = "natural";
    front.front = {"texture",       "cone:steps=8",   "cone:steps=16",  "cone:steps=32",
                   "cone:steps=64", "cone:steps=128", "cone:steps=256", "polygons:lods=1"};
    front.dominated = {{"relief:steps=64", "cone:steps=64"}};
    front.holed = {"relief:steps=8"};
    results.fronts = {front};
    results.left_out = {{"natural", scene::Pose::overview, 7, {"exact"}}};
    return results;
}

bench::Results with_pictures(bench::Results results, int cols, int rows) {
    Image shown(cols, rows);
    Image truth(cols, rows);
    Grid<float> error(cols, rows);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            const auto byte = [](int value, int count) {
                return static_cast<std::uint8_t>(255 * value / count);
            };
            shown(col, row) = {byte(col, cols), byte(row, rows), 200, 255};
            truth(col, row) = {byte(col, cols), byte(row, rows), 40, 255};
            error(col, row) = row < rows / 4 ? std::numeric_limits<float>::quiet_NaN()
                              : col == cols - 1
                                  ? std::numeric_limits<float>::infinity()
                                  : 0.01F * std::pow(10.0F, 4.0F * static_cast<float>(col) /
                                                                static_cast<float>(cols));
        }
    }
    const auto right = std::make_shared<const Image>(truth);
    bench::RowViews views;
    results.rows[0].view = views.make({shown, right, error}).value();
    results.rows[1].view = views.make({truth, right, error}).value();
    results.rows[2].view = results.rows[0].view;
    return results;
}

} // namespace reljef::test
