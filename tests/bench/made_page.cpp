#include "tests/bench/made_page.h"

#include <cmath>
#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

namespace reljef::test {
namespace {

using MadeJson = nlohmann::ordered_json;

struct MadeRow {
    std::string label;
    double ms = 0.0;
    double error_px = 0.0; ///< RMS; negative: there is none
    double source_fps = 0.0;
};

MadeJson distribution(double rms) {
    return {{"median", 0.4 * rms},
            {"p95", 1.9 * rms},
            {"p99", 3.2 * rms},
            {"max", 11.0 * rms},
            {"rms", rms},
            {"count", 600'000},
            {"unbounded", rms > 10.0 ? 12 : 0}};
}

MadeJson error_of(double rms) {
    return {{"reprojection_px", rms < 0.0 ? MadeJson() : distribution(rms)},
            {"hit_texels", rms < 0.0 ? MadeJson() : distribution(1.5 * rms)},
            {"wrong_percent", rms > 0.0 ? 100.0 * rms / (rms + 3.0) : 0.0},
            {"holes", static_cast<int>(40.0 * std::max(rms, 0.0))},
            {"rmse", 0.02 * std::max(rms, 0.0)},
            {"psnr", rms > 0.0 ? MadeJson(38.0 - 9.0 * std::log10(1.0 + rms)) : MadeJson()},
            {"ssim", rms > 0.0 ? 1.0 / (1.0 + 0.05 * rms) : 1.0},
            {"flip", rms > 0.0 ? 0.04 * std::sqrt(rms) : 0.0}};
}

MadeJson named(const std::string& label) {
    const auto colon = label.find(':');
    MadeJson row{{"technique", label.substr(0, colon)}, {"params", MadeJson::object()}};
    if (const auto equals = label.find('='); equals != label.npos) {
        row["params"][label.substr(colon + 1, equals - colon - 1)] =
            std::stod(label.substr(equals + 1));
    }
    row["label"] = label;
    return row;
}

MadeJson measured(const MadeRow& made, double texture_ms) {
    MadeJson row = named(made.label);
    row.update({{"null_row", false},
                {"missing", false},
                {"noisy", false},
                {"size", "1024x768"},
                {"frames", 60},
                {"ms",
                 {{"median", made.ms},
                  {"p95", 1.12 * made.ms},
                  {"p99", 1.31 * made.ms},
                  {"interval", {0.97 * made.ms, 1.04 * made.ms}}}},
                {"fps", 1000.0 / made.ms},
                {"fps_1_percent_low", 740.0 / made.ms},
                {"ratio_to_texture", made.ms / texture_ms},
                {"noise_floor", 0.021},
                {"tiles", 64},
                {"triangles", made.label.starts_with("polygons") ? 2'093'058 : 2},
                {"draws", 64},
                {"uploads", 0},
                {"error", error_of(made.error_px)},
                {"skipped", MadeJson::object()}});
    return row;
}

MadeJson with_source(MadeJson row, const std::string& test, double fps, double texture_fps) {
    if (fps > 0.0) {
        row["source"] = {
            {"fps", fps}, {"ratio", texture_fps / fps}, {"where", test + ", configuration 2"}};
    }
    return row;
}

MadeJson at_place(MadeJson row, const std::string& suite, const std::string& test,
                  const std::string& scene) {
    row["suite"] = suite;
    if (!test.empty()) {
        row["test"] = test;
    }
    row["scene"] = scene;
    row["pose"] = "overview";
    return row;
}

MadeJson again(MadeJson row) {
    row["null_row"] = true;
    row["ms"]["median"] = 1.021 * row["ms"]["median"].get<double>();
    row.erase("source");
    return row;
}

MadeJson missing(const std::string& label) {
    MadeJson row = named(label);
    row.update({{"null_row", false}, {"missing", true}, {"noisy", false}, {"size", "1024x768"}});
    return row;
}

void append(MadeJson& rows, const std::string& test, const std::string& scene,
            const std::vector<MadeRow>& made, double texture_fps) {
    for (const MadeRow& each : made) {
        MadeJson row = each.ms > 0.0 ? measured(each, made.front().ms) : missing(each.label);
        rows.push_back(at_place(with_source(std::move(row), test, each.source_fps, texture_fps),
                                "tables", test, scene));
    }
}

MadeJson report_of(MadeJson rows) {
    return {{"schema", "reljef-bench/1"},
            {"complete", true},
            {"environment",
             {{"renderer", "llvmpipe (LLVM 15.0.6, 256 bits)"},
              {"gl", "4.5 (Core Profile) Mesa 22.3.6"},
              {"context", "osmesa"},
              {"threads", 2},
              {"cpu", "a processor"},
              {"commit", "0123456789ab"}}},
            {"rows", std::move(rows)}};
}

} // namespace

std::string made_report(const std::string& scene) {
    MadeJson rows = MadeJson::array();
    append(rows, "relief-4", "natural",
           {{"texture", 6.31, 7.94, 824.0},
            {"polygons:lods=1", 148.2, 0.0, 5.0},
            {"polygons:lods=3", 31.7, 0.061, 62.0},
            {"polygons:lods=5", 12.4, 0.43, 170.0},
            {"parallax", 8.05, 5.12, 716.0},
            {"relief:steps=64", 61.3, 0.18, 55.0},
            {"cone:steps=32", 0.0, 0.0, 0.0}},
           824.0);
    rows.push_back(again(rows[0]));
    append(rows, "relief-3", scene,
           {{"texture", 5.84, 21.7, 170.0},
            {"parallax", 7.41, 13.9, 0.0},
            {"relief:steps=64", 58.9, 2.31, 60.0}},
           170.0);
    rows.back()["noisy"] = true;
    rows.back()["noise_floor"] = 0.143;
    return report_of(std::move(rows)).dump();
}

std::string made_pareto_report() {
    MadeJson rows = MadeJson::array();
    const auto add = [&](const std::string& label, double ms, double error_px) {
        rows.push_back(at_place(measured({label, ms, error_px}, 6.31), "pareto", "", "natural"));
    };
    add("texture", 6.31, 7.94);
    for (int steps = 8; steps <= 256; steps *= 2) {
        add("relief:steps=" + std::to_string(steps), 7.5 + 0.8 * steps, 22.0 / steps);
        add("cone:steps=" + std::to_string(steps), 9.0 + 0.5 * steps, 9.0 / steps);
    }
    add("polygons:lods=1", 148.2, 0.0);
    MadeJson report = report_of(std::move(rows));
    report["fronts"] = MadeJson::array(
        {{{"scene", "natural"},
          {"pose", "overview"},
          {"area", 1.83},
          {"front",
           {"texture", "cone:steps=8", "cone:steps=16", "cone:steps=32", "cone:steps=64",
            "cone:steps=128", "cone:steps=256", "polygons:lods=1"}},
          {"dominated", {{{"label", "relief:steps=64"}, {"by", "cone:steps=64"}}}}}});
    return report.dump();
}

std::vector<bench::RowPictures> made_pictures(int cols, int rows) {
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
    const auto shown_view = views.make({shown, right, error}).value();
    const auto true_view = views.make({truth, right, error}).value();
    return {{0, shown_view}, {1, true_view}, {2, shown_view}};
}

} // namespace reljef::test
