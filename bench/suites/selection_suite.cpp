#include "bench/suites/selection_suite.h"

#include <array>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/progress_line.h"
#include "engine/core/atomic_file.h"
#include "engine/core/stopwatch.h"
#include "engine/view/select.h"
#include "terrains/generators.h"

namespace reljef::bench {
namespace {

using SelectionJson = nlohmann::ordered_json;

constexpr int samples = 1601;  // 13 tiles a side
constexpr double max_ms = 0.2; // for 10,000 tiles

struct SelectionView {
    const char* name;
    glm::dvec3 eye; // in sides of all copies from the middle of their southern border
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
        row.seen = list.tiles.size();
        row.tiles = row.seen + static_cast<std::size_t>(list.stats.skipped.tiles_outside_frustum);
    }
    row.ms = summarize(ms);
    return row;
}

// 10,000 tiles' share of what a view took.
double ms_of_many(const SelectionRow& row) {
    return row.ms.median * 10'000.0 / static_cast<double>(row.tiles);
}

} // namespace

SelectionResults run_selection(const SelectionOptions& options, const std::stop_token& stop) {
    SelectionResults results;
    cli::ProgressLine line("choosing tiles", options.suite.quiet);
    ManyTiles made;
    if (auto filled = fill(made, options.copies); !filled) {
        results.stopped = filled.error();
        return results;
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (stop.stop_requested()) {
            results.stopped = Error{"interrupted, the table holds what was measured until then"};
            return results;
        }
        results.rows.push_back(measure(made, views[i], options));
        line.update(static_cast<double>(i + 1) / static_cast<double>(views.size()));
    }
    return results;
}

std::string selection_table(const SelectionResults& results) {
    std::string text = fmt::format("{:<12} {:>7} {:>7} {:>8} {:>8} {:>13} {:>14}\n", "view",
                                   "tiles", "seen", "ms", "p99 ms", "ms per 10,000", "mark 0.2 ms");
    for (const SelectionRow& row : results.rows) {
        text += fmt::format("{:<12} {:>7} {:>7} {:>8.3f} {:>8.3f} {:>13.3f} {:>14}\n", row.view,
                            row.tiles, row.seen, row.ms.median, row.ms.p99, ms_of_many(row),
                            ms_of_many(row) <= max_ms ? "met" : "missed");
    }
    return text;
}

std::string selection_json(const SelectionResults& results) {
    SelectionJson json{
        {"schema", "reljef-bench-selection/1"},
        {"complete", !results.stopped.has_value()},
        {"stopped", results.stopped ? SelectionJson(results.stopped->message) : SelectionJson()},
        {"rows", SelectionJson::array()}};
    for (const SelectionRow& row : results.rows) {
        json["rows"].push_back({{"view", row.view},
                                {"tiles", row.tiles},
                                {"seen", row.seen},
                                {"median_ms", row.ms.median},
                                {"p99_ms", row.ms.p99},
                                {"ms_per_10000_tiles", ms_of_many(row)}});
    }
    return json.dump(2) + "\n";
}

Result<void> report(const SelectionResults& results, const std::filesystem::path& json) {
    if (results.rows.empty()) {
        return results.stopped.value_or(Error{"no rows found, some were expected"});
    }
    Result<void> written;
    if (!json.empty()) {
        written = write_text_file(json, selection_json(results));
    }
    fmt::print("{}", selection_table(results));
    if (std::fflush(stdout) != 0 || !written) {
        return written;
    }
    return results.stopped ? Result<void>(*results.stopped) : Result<void>();
}

} // namespace reljef::bench
