// The error bound of polygons: in memory from random eyes, and streamed in too little memory.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <random>

#include <fmt/format.h>

#include "bench/runner/benchmark_scene.h"
#include "bench/stress/stress_run.h"
#include "bench/suites/error_bound.h"
#include "bench/suites/random_views.h"
#include "bench/suites/scaling_terrain.h"
#include "bench/suites/streamed_errors.h"
#include "engine/core/check.h"
#include "engine/core/statistics.h"
#include "engine/io/formats/raster_writer.h"
#include "engine/session/frame_maker.h"
#include "engine/session/scene_setup.h"
#include "engine/session/terrain_index.h"
#include "terrains/generators.h"

namespace reljef::bench {
namespace {

namespace fs = std::filesystem;

constexpr double stressed_bound = 1.0; // pixels
constexpr int streamed_side = 16384;   // samples
constexpr int streamed_megabytes = 64;
constexpr int city_megabytes = 256;
constexpr double max_overstatement = 2.0; // of the largest error
constexpr int block = 12;                 // samples a side that repeat one of the city

scene::Technique bounded(double error) {
    return scene::Technique{scene::Polygons{.error = error}};
}

void add_rows(StressRun& run, const ErrorBoundRow& row, const scene::Technique& technique) {
    const std::string at =
        row.worst ? fmt::format("{} frames, worst from {:.2f},{:.2f},{:.2f}", row.frames,
                                row.worst->eye.x, row.worst->eye.y, row.worst->eye.z)
                  : std::string();
    StressRow figure{
        .stress = fmt::format("error bound, {}, {}", row.views, placement_name(row.placement)),
        .terrain = row.scene,
        .technique = to_string(technique),
        .figure = "pixels farther off than stated",
        .value = static_cast<double>(row.violations),
        .limit = 0.0,
        .at = at};
    run.add(figure);
    figure.figure = "holes";
    figure.value = static_cast<double>(row.holes);
    run.add(figure);
    figure.figure = "largest error, px";
    figure.value = row.worst_px;
    figure.limit = row.stated_px;
    run.add(figure);
}

struct StreamedGround {
    std::string name;
    fs::path path;
    int megabytes = streamed_megabytes;
    bool is_temporary = true;
};

Result<StreamedGround> write_smooth(const StressRun& run, const fs::path& folder) {
    StreamedGround ground{"waves", folder / "waves.tif"};
    auto done = write_scaling_terrain(ground.path, streamed_side, run.options().suite, run.stop());
    return done ? Result<StreamedGround>(std::move(ground)) : done.error();
}

Result<StreamedGround> write_blocky(const StressRun& run, const fs::path& folder) {
    auto city = terrains::generate_urban({.size = streamed_side / block + 1,
                                          .walls = building::CityWalls::stepped,
                                          .stop = run.stop()});
    if (!city) {
        return city.error();
    }
    const auto samples = std::make_shared<const Grid<float>>(std::move(city->heightfield.heights));
    const auto height_at = [samples](glm::ivec2 sample) {
        return (*samples)(sample.x / block, sample.y / block);
    };
    StreamedGround ground{"city in blocks", folder / "city.tif", city_megabytes};
    const io::HeightRaster raster{streamed_side, streamed_side, 0.2, {400'000.0, 5e6}};
    const auto fill = [&](int first_row, GridView<float> heights) {
        for (int row = 0; row < heights.rows(); ++row) {
            for (int col = 0; col < heights.cols(); ++col) {
                heights(col, row) = height_at({col, first_row + row});
            }
        }
    };
    auto done = io::write_heights(ground.path, raster, fill, run.parallel());
    return done ? Result<StreamedGround>(std::move(ground)) : done.error();
}

session::SourceOptions
streamed_source(const StreamedGround& ground,
                terrain::PlacementKind placement = terrain::PlacementKind::plane) {
    session::SourceOptions source;
    source.terrain = ground.path.string();
    source.memory_megabytes = ground.megabytes;
    source.placement = placement;
    source.streamed = true;
    source.index = session::IndexUse::existing;
    return source;
}

Result<session::TerrainScene> open_streamed(const StressRun& run,
                                            const session::SourceOptions& source) {
    session::SceneOptions view;
    view.pose = scene::Pose::overview;
    view.max_error = stressed_bound;
    session::Log silent;
    return session::open_scene(source, view, silent, run.stop());
}

Result<session::DeviceFrames> make_frames(const StressRun& run, session::Log& log) {
    auto device = session::Device::create({.context = run.options().suite.context,
                                           .size = run.size(),
                                           .threads = run.options().suite.threads});
    return device ? Result<session::DeviceFrames>(session::DeviceFrames(std::move(*device), log))
                  : device.error();
}

// Pictures of a terrain that is streamed anew: overview and low.
Result<std::vector<Image>> streamed_pictures(const StressRun& run, const StreamedGround& ground) {
    auto scene = open_streamed(run, streamed_source(ground));
    session::Log silent;
    auto frames = make_frames(run, silent);
    if (!scene || !frames) {
        return scene ? frames.error() : scene.error();
    }
    check(scene->terrain->get<scene::TerrainNode>()->stream != nullptr, "a terrain in memory");
    std::vector<Image> pictures;
    for (const scene::Pose pose : {scene::Pose::overview, scene::Pose::low}) {
        set_pose(*scene, pose);
        frames->wait_for_tiles(scene->scene, run.stop());
        auto picture = frames->draw(scene->scene, run.parallel());
        if (!picture) {
            return picture.error();
        }
        pictures.push_back(std::move(*picture));
    }
    return pictures;
}

// The errors of frames of a streamed terrain, measured and stated.
struct StatedErrors {
    std::size_t frames = 0;
    std::size_t over = 0;       // pixels farther off than the frame states
    std::size_t holes = 0;      // pixels
    std::size_t unproven = 0;   // tiles
    Worst worst;                // pixels
    Worst kept;                 // stated, pixels
    std::vector<double> ratios; // stated over measured, of frames that state more than the bound

    void add(const std::vector<double>& errors, const view::FrameStats& stats,
             const std::string& at) {
        const double stated = stats.kept_error.value_or(0.0);
        double largest = 0.0;
        for (const double error : errors) {
            over += error <= stated ? 0 : 1;
            largest = std::max(largest, error);
        }
        ++frames;
        unproven += static_cast<std::size_t>(stats.tiles_unproven);
        worst.add(largest, at);
        kept.add(stated, at);
        if (stated > stressed_bound && !errors.empty()) {
            ratios.push_back(stated / largest);
        }
    }
};

// Pixels within which a silhouette may have moved.
int reach_of(double error) {
    constexpr double max_reach = 1e6; // larger than any picture
    return static_cast<int>(std::ceil(std::min(error, max_reach))) + 1;
}

Result<StatedErrors> stated_errors(StressRun& run, session::TerrainScene& scene, int poses,
                                   ViewGenerators& generators) {
    session::Log silent;
    auto frames = make_frames(run, silent);
    if (!frames) {
        return frames.error();
    }
    const auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    StatedErrors found;
    for (int i = 0; i < poses && !run.stopped(); ++i) {
        auto random = generators.next();
        if (!random) {
            continue;
        }
        *scene.camera->get<scene::Camera>() = view_near_the_ground(*random, *terrain.surface);
        static_cast<void>(session::stand_above_ground(scene, *frames, run.stop()));
        const auto hits = frames->draw_hits(scene.scene, run.parallel());
        if (!hits) {
            return hits.error();
        }
        const auto errors = streamed_errors(scene.scene, *hits, 1, run.parallel());
        if (!errors) {
            return errors.error();
        }
        const double stated = frames->frame_stats().kept_error.value_or(0.0);
        const auto holes = streamed_holes(scene.scene, *hits, reach_of(stated), run.parallel());
        if (!holes) {
            return holes.error();
        }
        found.holes += *holes;
        const glm::dvec3 eye = scene.scene.camera().eye;
        found.add(*errors, frames->frame_stats(),
                  fmt::format("eye {:.2f},{:.2f},{:.2f}", eye.x, eye.y, eye.z));
    }
    return found;
}

void add_streamed_rows(StressRun& run, const StressRow& of_ground, const StatedErrors& found) {
    StressRow row = of_ground;
    const auto add = [&](const char* figure, double value, std::optional<double> limit,
                         std::string at) {
        row.figure = figure;
        row.value = value;
        row.limit = limit;
        row.at = fmt::format("{} frames, {}", found.frames, at);
        run.add(row);
    };
    add("pixels farther off than stated", static_cast<double>(found.over), 0.0, found.worst.at());
    add("holes", static_cast<double>(found.holes), 0.0, "sky within ground");
    add("unproven tiles", static_cast<double>(found.unproven), 0.0, "all tiles indexed");
    add("largest error, px", found.worst.value(), std::nullopt, found.worst.at());
    add("largest stated error, px", found.kept.value(), std::nullopt, found.kept.at());
    if (!found.ratios.empty()) {
        add("stated over largest error, median", median(found.ratios), max_overstatement,
            fmt::format("{} of them over the bound", found.ratios.size()));
    }
}

// Half of the poses, or all of a terrain without a place on the Earth.
Result<bool> fly_on(StressRun& run, const StreamedGround& ground, terrain::PlacementKind placement,
                    ViewGenerators& generators) {
    auto scene = open_streamed(run, streamed_source(ground, placement));
    if (!scene) {
        return scene.error();
    }
    const auto& surface = *scene->terrain->get<scene::TerrainNode>()->surface;
    const bool on_earth = surface.heightfield().georeference.has_value();
    const int poses = run.options().poses.value_or(run.cases(4, 100));
    const auto found = stated_errors(run, *scene, on_earth ? (poses + 1) / 2 : poses, generators);
    if (!found) {
        return found.error();
    }
    if (found->frames == 0) {
        return on_earth;
    }
    add_streamed_rows(run,
                      {.stress = fmt::format("error bound, streamed at {} MB, {}", ground.megabytes,
                                             placement_name(placement)),
                       .terrain = ground.name,
                       .technique = to_string(bounded(stressed_bound))},
                      *found);
    return on_earth;
}

Result<void> stress_streamed(StressRun& run, const StreamedGround& ground,
                             ViewGenerators& generators) {
    session::Log silent;
    const auto indexed = session::index_terrain(streamed_source(ground), silent, run.stop());
    if (!indexed) {
        return indexed.error();
    }
    auto on_earth = fly_on(run, ground, terrain::PlacementKind::plane, generators);
    if (on_earth && *on_earth && !run.stopped()) {
        on_earth = fly_on(run, ground, terrain::PlacementKind::ellipsoid, generators);
    }
    if (ground.is_temporary) {
        std::error_code ignored;
        fs::remove(indexed->file, ignored);
    }
    return on_earth ? Result<void>() : on_earth.error();
}

// The DEM files of the options that do not fit the memory.
Result<void> stress_streamed_files(StressRun& run, ViewGenerators& generators) {
    for (const std::string& terrain : run.options().terrains) {
        const StreamedGround ground{terrain, terrain, streamed_megabytes, false};
        std::error_code ignored;
        if (run.stopped() || !fs::is_regular_file(ground.path, ignored)) {
            continue;
        }
        const auto scene = open_streamed(run, streamed_source(ground));
        const bool is_streamed =
            scene && scene->terrain->get<scene::TerrainNode>()->stream != nullptr;
        if (auto done = is_streamed ? stress_streamed(run, ground, generators) : Result<void>();
            !done) {
            return run.stopped() ? Result<void>() : done;
        }
    }
    return {};
}

} // namespace

Result<void> stress_error_bound(StressRun& run) {
    ErrorBoundOptions options;
    options.suite = run.options().suite;
    options.suite.quiet = true;
    options.suite.progress = {};
    options.terrains = run.options().terrains;
    options.built_in_size = run.cases(257, 0);
    const int poses = run.options().poses.value_or(run.cases(80, 2'000));
    options.near_poses = poses / 2;
    options.poses = poses - options.near_poses;
    options.error = stressed_bound;
    options.flight_errors = {};
    options.seed = run.options().seed;
    options.skip = run.options().skip;
    for (const bool automatic : {false, true}) {
        options.automatic = automatic;
        const scene::Technique technique =
            automatic ? scene::Technique{scene::Automatic{.error = stressed_bound}}
                      : bounded(stressed_bound);
        const ErrorBoundResults results = run_error_bound(options, run.stop());
        for (const ErrorBoundRow& row : results.rows) {
            add_rows(run, row, technique);
        }
        if (results.end.failed) {
            return *results.end.stopped;
        }
    }
    return {};
}

Result<void> stress_streamed_repeats(StressRun& run) {
    constexpr int side = 1024;    // samples
    constexpr int megabytes = 16; // of 40 for all samples
    const auto folder = make_scaling_folder({}, side);
    if (!folder) {
        return folder.error();
    }
    const fs::path path = folder->path() / "waves.tif";
    if (auto written = write_scaling_terrain(path, side, run.options().suite, run.stop());
        !written) {
        return written;
    }
    const auto first = streamed_pictures(run, {"waves", path, megabytes});
    const auto second = streamed_pictures(run, {"waves", path, megabytes});
    if (!first || !second) {
        return first ? second.error() : first.error();
    }
    run.add({.stress = "repeat",
             .terrain = "waves, streamed",
             .technique = to_string(bounded(stressed_bound)),
             .figure = "pictures with other bits when streamed again",
             .value = static_cast<double>((*first)[0] != (*second)[0]) +
                      static_cast<double>((*first)[1] != (*second)[1]),
             .limit = 0.0});
    return {};
}

Result<void> stress_streamed_bound(StressRun& run) {
    ViewGenerators generators(run.options().seed, run.options().skip);
    const auto folder = make_scaling_folder({}, streamed_side);
    if (!folder) {
        return folder.error();
    }
    for (const auto& write : {write_smooth, write_blocky}) {
        if (run.stopped()) {
            return {};
        }
        const auto ground = write(run, folder->path());
        if (!ground) {
            return run.stopped() ? Result<void>() : ground.error();
        }
        if (auto done = stress_streamed(run, *ground, generators); !done) {
            return run.stopped() ? Result<void>() : done;
        }
        std::error_code ignored;
        fs::remove(ground->path, ignored);
    }
    return stress_streamed_files(run, generators);
}

} // namespace reljef::bench
