#include <algorithm>

#include "bench/baselines/baseline_suite.h"

namespace reljef::bench {
namespace {

// Of the row that a row is compared with; 0 if absent.
double reference_ms(const BaselineResults& results, const BaselineRow& view) {
    const auto found = std::find_if(results.rows.begin(), results.rows.end(), [&](const auto& row) {
        return row.is_reference && row.work == view.work && row.pose == view.pose &&
               row.moving == view.moving;
    });
    return found == results.rows.end() ? 0.0 : found->ms.median;
}

FigureJson times_reference(const BaselineResults& results, const BaselineRow& row) {
    const double ms = reference_ms(results, row);
    return ms > 0.0 ? FigureJson(row.ms.median / ms) : FigureJson();
}

void add_distribution(FigureJson& values, const std::optional<truth::Distribution>& error) {
    const std::vector<FigureJson> figures =
        error ? std::vector<FigureJson>{error->median, error->p95, error->p99,
                                        error->max,    error->rms, error->count}
              : std::vector<FigureJson>(6);
    for (const FigureJson& figure : figures) {
        values.push_back(figure);
    }
}

FigureJson values_of(const BaselineResults& results, const BaselineRow& row) {
    const bool has_levels = row.work == BaselineWork::levels;
    FigureJson values{to_string(row.work),
                      scene::to_string(row.pose),
                      row.what,
                      has_levels ? FigureJson(row.moving ? "moving" : "still") : FigureJson(),
                      row.frames,
                      row.ms.median,
                      row.ms.p95,
                      row.ms.p99,
                      times_reference(results, row),
                      row.triangles > 0 ? FigureJson(row.triangles) : FigureJson(),
                      has_levels ? FigureJson() : FigureJson(row.wrong_percent)};
    add_distribution(values, row.hit_error);
    add_distribution(values, row.error);
    return values;
}

std::vector<FigureColumn> baseline_columns() {
    using namespace columns;
    return {group("/work", "work"),
            group("/pose", "pose"),
            name("/what", "what"),
            name("/camera", "camera"),
            plain("/frames", "frames"),
            less("/ms/median", "median", "ms"),
            less("/ms/p95", "p95", "ms"),
            detail(less("/ms/p99", "p99", "ms")),
            plain("/times_reljef", "x reljef"),
            less("/triangles", "triangles"),
            less("/wrong_percent", "wrong", "%", 3),
            detail(less("/hit_texels/median", "median", "texels", 3)),
            detail(less("/hit_texels/p95", "p95", "texels", 3)),
            less("/hit_texels/p99", "p99", "texels", 3),
            detail(less("/hit_texels/max", "max", "texels", 3)),
            less("/hit_texels/rms", "rms", "texels", 3),
            detail(plain("/hit_texels/count", "pixels with a hit")),
            detail(less("/reprojection_px/median", "median", "px", 3)),
            detail(less("/reprojection_px/p95", "p95", "px", 3)),
            less("/reprojection_px/p99", "p99", "px", 3),
            less("/reprojection_px/max", "max", "px", 3),
            less("/reprojection_px/rms", "rms", "px", 3),
            detail(plain("/reprojection_px/count", "pixels with an error"))};
}

} // namespace

std::string_view to_string(BaselineWork work) {
    switch (work) {
    case BaselineWork::levels:
        return "triangles with levels or an error bound";
    case BaselineWork::triangles:
        return "a vertex for every sample";
    case BaselineWork::relief:
        return "heights on a flat square";
    case BaselineWork::hits:
        return "hits by rays on the CPU";
    case BaselineWork::picture:
        break;
    }
    return "a picture by rays on the CPU";
}

FigureTable figure_table(const BaselineResults& results) {
    FigureTable table{.suite = "peers",
                      .environment = results.environment,
                      .shard = {},
                      .settings = {{"terrain", results.options.terrain},
                                   {"side", results.side},
                                   {"size", size_text(results.options.suite.size)}},
                      .summary = {},
                      .columns = baseline_columns(),
                      .rows = {},
                      .notes = results.notes,
                      .end = results.end};
    for (const BaselineRow& row : results.rows) {
        table.rows.push_back(values_of(results, row));
    }
    return table;
}

} // namespace reljef::bench
