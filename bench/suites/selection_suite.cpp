#include "bench/suites/selection_suite.h"

#include <array>
#include <cmath>

#include "app/cli/progress_line.h"
#include "engine/core/stopwatch.h"
#include "engine/view/select.h"
#include "terrains/generators.h"

namespace reljef::bench {
namespace {

constexpr int samples = 1601;  // 13 tiles a side
constexpr double max_ms = 0.2; // for 10,000 tiles

struct SelectionView {
    const char* name;
    glm::dvec3 eye; // relative to the southern border's middle, in sides of all copies
    glm::dvec3 target;
};

constexpr std::array views{
    SelectionView{"all seen", {0.0, -0.7, 0.7}, {0.0, 0.5, 0.0}},
    SelectionView{"half seen", {0.0, 0.5, 0.1}, {0.0, 1.5, 0.0}},
    SelectionView{"none seen", {0.0, -0.7, 0.7}, {0.0, -2.0, 0.0}},
};

struct ManyTiles {
    scene::Scene scene;
    scene::Node* camera = nullptr;
    double side = 0.0; // metres
};

Result<void> fill(ManyTiles& made, int copies) {
    auto terrain = terrains::generate_natural({.size = samples});
    if (!terrain) {
        return terrain.error();
    }
    auto first = made.scene.add_terrain(std::move(*terrain));
    if (!first) {
        return first.error();
    }
    const auto across = static_cast<int>(std::ceil(std::sqrt(copies)));
    const double step = (*first)->local_bounds().size().x;
    made.side = step * across;
    const scene::Node::Content content = (*first)->content();
    for (int i = 0; i < copies; ++i) {
        scene::Node& node = i == 0 ? **first : made.scene.root().add("copy", content);
        const glm::ivec2 place(i % across, i / across);
        node.set_position({(place.x + 0.5) * step - 0.5 * made.side, (place.y + 0.5) * step, 0.0});
    }
    made.camera = &made.scene.add_camera({});
    return {};
}

SelectionRow measure(ManyTiles& made, const SelectionView& view, const SelectionOptions& options) {
    auto& camera = *made.camera->get<scene::Camera>();
    camera.eye = made.side * view.eye;
    camera.target = made.side * view.target;
    const view::SceneView seen(made.scene, options.suite.size);
    SelectionRow row;
    row.view = view.name;
    std::vector<double> ms;
    for (int round = 0; round < options.rounds; ++round) {
        const Stopwatch watch;
        const view::DrawList list = view::select(seen, {.occlusion = false}).list;
        ms.push_back(watch.milliseconds());
        row.selected = list.tiles.size();
        row.tiles =
            row.selected + static_cast<std::size_t>(list.stats.skipped.tiles_outside_frustum);
    }
    row.ms = summarize(ms);
    return row;
}

} // namespace

SelectionResults run_selection(const SelectionOptions& options, const std::stop_token& stop) {
    SelectionResults results;
    results.rounds = options.rounds;
    results.environment =
        environment_of({.renderer = "none", .version = "none", .context = "none"}, 1);
    cli::ProgressLine line("selecting tiles", options.suite.quiet);
    ManyTiles made;
    const auto filled = fill(made, options.copies);
    for (std::size_t i = 0; i < views.size() && filled && !stop.stop_requested(); ++i) {
        results.rows.push_back(measure(made, views[i], options));
        line.update(static_cast<double>(i + 1) / static_cast<double>(views.size()));
    }
    results.end = run_end(filled, stop, !results.rows.empty());
    return results;
}

FigureTable figure_table(const SelectionResults& results) {
    using namespace columns;
    FigureTable table{.suite = "lod-selection",
                      .environment = results.environment,
                      .shard = {},
                      .settings = FigureJson::object({{"rounds", results.rounds}}),
                      .summary = {},
                      .columns = {name("/view", "view"), plain("/tiles", "tiles"),
                                  plain("/seen", "selected"), less("/median_ms", "median", "ms", 3),
                                  plain("/p99_ms", "p99", "ms", 3),
                                  less("/ms_per_10000_tiles", "per 10,000 tiles", "ms", 3),
                                  plain("/target", "target 0.2 ms")},
                      .rows = {},
                      .notes = {"Selects the tiles of a view, without drawing them."},
                      .end = results.end};
    for (const SelectionRow& row : results.rows) {
        const double ms = row.ms.median * 10'000.0 / static_cast<double>(row.tiles);
        table.rows.push_back({row.view, row.tiles, row.selected, row.ms.median, row.ms.p99, ms,
                              ms <= max_ms ? "met" : "missed"});
    }
    return table;
}

} // namespace reljef::bench
