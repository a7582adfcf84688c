#include "tests/bench/report/made_results.h"

namespace reljef::test {

bench::Timing made_timing(double median_ms, double ratio) {
    bench::Timing timing;
    timing.frames = 20;
    timing.ms = {median_ms, 1.25 * median_ms, 1.5 * median_ms};
    timing.interval = {0.9 * median_ms, 1.1 * median_ms};
    timing.fps_1_percent_low = 500.0 / median_ms;
    timing.ratio_to_texture = ratio;
    timing.noise_floor = 0.05;
    timing.stats.tiles = 16;
    timing.stats.triangles = 2;
    timing.stats.draws = 2;
    timing.stats.uploads = 1;
    return timing;
}

bench::RowError made_error(double rms_px) {
    bench::RowError error;
    error.reprojection_px = {{.count = 700'000,
                              .median = 0.5 * rms_px,
                              .p95 = 2.0 * rms_px,
                              .p99 = 3.0 * rms_px,
                              .max = 4.0 * rms_px,
                              .rms = rms_px},
                             0};
    error.hit_texels = error.reprojection_px;
    error.wrong_percent = 1.25;
    error.holes = 3;
    error.rmse = 0.01;
    error.psnr = 40.0;
    error.ssim = 0.975;
    error.flip = 0.02;
    return error;
}

bench::Results made_results(const std::string& scene) {
    bench::Row row;
    row.suite = "tables";
    row.scene = scene;
    row.setting = {"texture", {}, "texture"};
    row.size = {1024, 768};
    row.timing = made_timing(2.0, 1.0);
    row.error = made_error(30.0);
    bench::Row polygons = row;
    polygons.setting = {"polygons", {{"lods", 1.0}}, "polygons:lods=1"};
    polygons.timing = made_timing(8.0, 4.0);
    polygons.timing.stats.triangles = 2'097'152;
    polygons.timing.stats.skipped.tiles_outside_frustum = 17;
    polygons.error = made_error(0.25);
    bench::Row again = row;
    again.null_row = true;
    again.timing = made_timing(2.1, 1.05);
    bench::Results results;
    results.environment = {"a renderer",  "4.5 of it",    "osmesa",  2,
                           "a processor", "0123456789ab", "built-in"};
    results.rows = {row, polygons, again};
    return results;
}

bench::Results made_source_results() {
    bench::Results results = made_results("natural 1025");
    for (bench::Row& row : results.rows) {
        row.test = "relief-4";
    }
    results.rows[0].source = {824.0, 1.0, "relief-4, configuration 2"};
    results.rows[1].source = {5.0, 164.8, "relief-4, configuration 2"};
    bench::Row relief = results.rows[1];
    relief.setting = {"relief", {}, "relief"};
    relief.source = {55.0, 824.0 / 55.0, "relief-4, configuration 2"};
    results.rows.insert(results.rows.begin() + 2, relief);
    return results;
}

} // namespace reljef::test
