#include "bench/baselines/baseline_scene.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <fmt/format.h>

#include "app/cli/console_log.h"
#include "bench/runner/benchmark_scene.h"
#include "engine/session/terrain_source.h"

namespace reljef::bench {

Result<BaselineScene> open_baseline_scene(const std::string& terrain, const SuiteOptions& options,
                                          const std::stop_token& stop) {
    session::SourceOptions choice;
    choice.terrain = terrain;
    choice.threads = options.threads;
    cli::ConsoleLog log(options.quiet);
    const auto source = open_measured(choice, log, stop);
    if (!source) {
        return source.error();
    }
    const terrain::Heightfield& whole = source->terrain.heightfield;
    const int max_cells = std::min(whole.heights.cols(), whole.heights.rows()) - 1;
    if (max_cells < 16) {
        return Error{fmt::format("{}: {}x{} samples found, 17x17 or more were expected", terrain,
                                 whole.heights.cols(), whole.heights.rows())};
    }
    const int side = static_cast<int>(std::bit_floor(static_cast<unsigned>(max_cells))) + 1;
    const glm::ivec2 first((whole.heights.cols() - side) / 2, (whole.heights.rows() - side) / 2);
    terrain::Terrain middle;
    middle.name = source->terrain.name;
    middle.heightfield.spacing = whole.spacing;
    middle.heightfield.heights = Grid<float>(side, side);
    for (int row = 0; row < side; ++row) {
        const auto from =
            whole.heights.row(first.y + row)
                .subspan(static_cast<std::size_t>(first.x), static_cast<std::size_t>(side));
        std::copy(from.begin(), from.end(), middle.heightfield.heights.row(row).begin());
    }
    middle.heightfield.range = terrain::height_range(middle.heightfield.heights, {});
    BaselineScene made;
    auto node =
        made.scene.add_terrain(std::move(middle), {.placement = terrain::PlacementKind::plane});
    if (!node) {
        return node.error();
    }
    made.terrain = *node;
    made.camera = &made.scene.add_camera();
    return made;
}

} // namespace reljef::bench
