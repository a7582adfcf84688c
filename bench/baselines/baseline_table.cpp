#include <algorithm>

#include <fmt/format.h>

#include "app/cli/message.h"
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

FigureJson level_values(const BaselineResults& results, const BaselineRow& row) {
    FigureJson values{scene::to_string(row.pose),
                      row.what,
                      row.moving ? "moving" : "still",
                      row.frames,
                      row.ms.median,
                      row.ms.p95,
                      row.ms.p99,
                      1000.0 / row.ms.median,
                      times_reference(results, row),
                      row.triangles};
    add_distribution(values, row.error);
    return values;
}

FigureJson other_values(const BaselineResults& results, const BaselineRow& row) {
    FigureJson values{to_string(row.work),
                      scene::to_string(row.pose),
                      row.what,
                      row.frames,
                      row.ms.median,
                      row.ms.p95,
                      row.ms.p99,
                      times_reference(results, row),
                      row.wrong_percent};
    add_distribution(values, row.hit_error);
    add_distribution(values, row.error);
    return values;
}

// The rows of a work; absent: of all but the levels.
FigureTable other_table(const BaselineResults& results, std::optional<BaselineWork> work) {
    FigureTable table{.heading = work ? fmt::format("\n{}", to_string(*work)) : "",
                      .settings = FigureJson::object(),
                      .columns = {{"/work", ""},
                                  {"/pose", "pose"},
                                  {"/what", "what"},
                                  {"/frames", "frames"},
                                  {"/ms/median", "ms"},
                                  {"/ms/p95", "p95"},
                                  {"/ms/p99", ""},
                                  {"/times_reljef", "x reljef"},
                                  {"/wrong_percent", "wrong %", 3},
                                  {"/hit_texels/median", ""},
                                  {"/hit_texels/p95", ""},
                                  {"/hit_texels/p99", "p99 texels", 3},
                                  {"/hit_texels/max", ""},
                                  {"/hit_texels/rms", "rms texels", 3},
                                  {"/hit_texels/count", ""},
                                  {"/reprojection_px/median", ""},
                                  {"/reprojection_px/p95", ""},
                                  {"/reprojection_px/p99", "p99 px", 3},
                                  {"/reprojection_px/max", "max px", 3},
                                  {"/reprojection_px/rms", "rms px", 3},
                                  {"/reprojection_px/count", ""}}};
    for (const BaselineRow& row : results.rows) {
        if (work ? row.work == *work : row.work != BaselineWork::levels) {
            table.rows.push_back(other_values(results, row));
        }
    }
    return table;
}

std::string other_text(const BaselineResults& results) {
    std::string text;
    for (const BaselineWork work : {BaselineWork::triangles, BaselineWork::relief,
                                    BaselineWork::hits, BaselineWork::picture}) {
        const FigureTable table = other_table(results, work);
        text += table.rows.empty() ? "" : figure_text(table);
    }
    for (const std::string& note : results.notes) {
        text += "note: " + cli::printable(note) + "\n";
    }
    return text;
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
    const glm::ivec2 size = results.options.suite.size;
    FigureTable table{
        .schema = "reljef-bench-peers/1",
        .heading = fmt::format("{}, {} x {} samples, {}, {}, {} threads",
                               cli::printable(results.options.terrain), results.side, results.side,
                               size_text(size), cli::printable(results.environment.renderer),
                               results.environment.threads),
        .settings = {{"environment", json_of(results.environment)},
                     {"terrain", results.options.terrain},
                     {"side", results.side},
                     {"size", size_text(size)},
                     {"notes", results.notes},
                     {"other_work",
                      FigureJson::parse(figure_json(other_table(results, {}))).at("rows")}},
        .columns = {{"/pose", "pose"},
                    {"/what", "what"},
                    {"/camera", "camera"},
                    {"/frames", "frames"},
                    {"/ms/median", "ms"},
                    {"/ms/p95", "p95"},
                    {"/ms/p99", ""},
                    {"/fps", ""},
                    {"", "x error=1"},
                    {"/triangles", "triangles"},
                    {"/reprojection_px/median", ""},
                    {"/reprojection_px/p95", ""},
                    {"/reprojection_px/p99", "p99 px", 3},
                    {"/reprojection_px/max", "max px", 3},
                    {"/reprojection_px/rms", "rms px", 3},
                    {"/reprojection_px/count", ""}},
        .summary = other_text(results),
        .end = results.end};
    for (const BaselineRow& row : results.rows) {
        if (row.work == BaselineWork::levels) {
            table.rows.push_back(level_values(results, row));
        }
    }
    return table;
}

} // namespace reljef::bench
