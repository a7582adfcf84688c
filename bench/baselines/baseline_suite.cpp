#include "bench/baselines/baseline_suite.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <unistd.h>

#include "app/cli/message.h"
#include "app/cli/progress_line.h"
#include "bench/baselines/baseline_process.h"
#include "bench/baselines/baseline_scene.h"
#include "bench/baselines/irrlicht/protocol.h"
#include "bench/runner/benchmark_scene.h"
#include "engine/core/memory_file.h"
#include "engine/scene/graph/scene.h"
#include "engine/session/scene_renderer.h"
#include "engine/view/terrain_maps.h"

namespace reljef::bench {
namespace {

constexpr int default_rounds = 30;
constexpr int warm_up = 2;              // rounds
constexpr double frames_across = 500.0; // of a moving camera; 20 s at 25 frames per second

struct BaselineFiles {
    MemoryFile heights;
    MemoryFile colors;
};

Result<MemoryFile> file_of(std::span<const std::byte> bytes) {
    auto file = MemoryFile::create();
    if (!file) {
        return file.error();
    }
    std::ofstream out(fmt::format("/proc/self/fd/{}", file->descriptor()), std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    return out.flush() ? std::move(file) : Error{"no memory for what Irrlicht is to read"};
}

Result<BaselineFiles> files_of(const scene::TerrainSurface& surface) {
    const Grid<float>& heights = surface.heightfield().heights;
    const int side = heights.cols();
    std::vector<float> columns;
    for (int col = 0; col < side; ++col) {
        for (int row = side - 1; row >= 0; --row) {
            columns.push_back(heights(col, row));
        }
    }
    const Image lit = view::lit_map(surface, std::nullopt, side);
    std::vector<std::uint8_t> colors;
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            const Rgba8& color = lit.clamped(col, row);
            colors.insert(colors.end(), {color.r, color.g, color.b});
        }
    }
    auto heights_file = file_of(std::as_bytes(std::span(columns)));
    auto colors_file = file_of(std::as_bytes(std::span(colors)));
    if (!heights_file || !colors_file) {
        return (heights_file ? colors_file : heights_file).error();
    }
    return BaselineFiles{std::move(*heights_file), std::move(*colors_file)};
}

std::string path_of(const MemoryFile& file) {
    return fmt::format("/proc/{}/fd/{}", ::getpid(), file.descriptor());
}

Result<BaselineProcess> start_irrlicht(const scene::TerrainSurface& surface,
                                       const BaselineFiles& files, glm::ivec2 size, double fov) {
    std::error_code ignored;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() /
                         baseline::program_name;
    if (!std::filesystem::exists(program, ignored)) {
        return Error{fmt::format("{} was not built, as Irrlicht was not found: install it (apt-get "
                                 "install libirrlicht-dev), configure and build again",
                                 baseline::program_name)};
    }
    const terrain::Heightfield& heightfield = surface.heightfield();
    return BaselineProcess::start(
        program,
        {fmt::format("{}", size.x), fmt::format("{}", size.y), fmt::format("{}", fov),
         fmt::format("{}", heightfield.heights.cols()), fmt::format("{}", heightfield.spacing.x),
         fmt::format("{}", heightfield.spacing.y), path_of(files.heights), path_of(files.colors)});
}

// Contains the visible depths with a margin of a factor of 2.
struct DepthRange {
    double near = 1.0;
    double far = 2.0;
};

DepthRange depth_range_of(const HitBuffer& hits) {
    DepthRange range{std::numeric_limits<double>::infinity(), 0.0};
    for (const Hit& hit : hits.samples()) {
        if (truth::shows_terrain(hit)) {
            range.near = std::min<double>(range.near, hit.depth);
            range.far = std::max<double>(range.far, hit.depth);
        }
    }
    return {0.5 * range.near, 2.0 * range.far};
}

truth::SurfaceView surface_view(const BaselineScene& scene) {
    return {scene.surface().heightfield().heights.view(), scene.surface().placement(),
            scene.terrain->world_from_local(), scene.view()};
}

// Hits from a depth buffer, see protocol.h.
HitBuffer hits_of(const BaselineScene& scene, std::span<const float> depths, glm::ivec2 size,
                  const DepthRange& range) {
    HitBuffer hits(size.x, size.y);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const double stored =
                depths[static_cast<std::size_t>(size.y - 1 - y) * static_cast<std::size_t>(size.x) +
                       static_cast<std::size_t>(x)];
            if (stored >= 1.0) {
                continue;
            }
            const double depth =
                range.near * range.far / (range.far - stored * (range.far - range.near));
            const Ray ray = scene::view_ray(scene.view(), size, glm::dvec2(x, y) + 0.5);
            if (const auto sample = scene.surface().placement().sample_from_world(ray.at(depth))) {
                hits(x, y) = {static_cast<float>(sample->x), static_cast<float>(sample->y),
                              static_cast<float>(sample->z), static_cast<float>(depth)};
            }
        }
    }
    return hits;
}

struct BaselineEntry {
    BaselineRow row;
    std::function<Result<void>()> set_camera;
    std::function<Result<double>(BaselineRow&)> draw; // returns ms; sets the row's triangles
    std::function<Result<HitBuffer>()> hits;
    std::vector<double> ms{};
};

class BaselineRun {
public:
    BaselineRun(BaselineResults& results, std::stop_token stop)
        : results_(results), options_(results.options), stop_(std::move(stop)) {}

    Result<void> run() {
        auto scene = open_baseline_scene(options_.terrain, options_.suite, stop_);
        if (!scene) {
            return scene.error();
        }
        scene_.emplace(std::move(*scene));
        results_.side = scene_->surface().heightfield().heights.cols();
        if (auto started = start_baselines(); !started) {
            return started;
        }
        if (auto opened = open_device(); !opened) {
            return opened;
        }
        for (const scene::Pose pose : {scene::Pose::overview, scene::Pose::low}) {
            if (auto done = run_pose(pose); !done || stop_.stop_requested()) {
                return done;
            }
        }
        return {};
    }

private:
    Result<void> start_baselines() {
        auto files = files_of(scene_->surface());
        if (!files) {
            return files.error();
        }
        for (const int levels : {1, 3, 5}) {
            auto baseline = start_irrlicht(scene_->surface(), *files, options_.suite.size,
                                           scene_->view().vertical_fov);
            if (!baseline) {
                return baseline.error();
            }
            if (auto built = baseline->ask(fmt::format("lods {}", levels)); !built) {
                return built.error();
            }
            baselines_.emplace_back(levels, std::move(*baseline));
        }
        return {};
    }

    Result<void> open_device() {
        auto opened = session::Device::create(
            {.context = options_.suite.context.value_or(session::BackendKind::glfw),
             .size = options_.suite.size,
             .shader_dir = options_.suite.shader_dir,
             .threads = options_.suite.threads});
        if (!opened) {
            return opened.error();
        }
        device_.emplace(std::move(*opened));
        results_.environment = environment_of(*device_, options_.suite.threads);
        return {};
    }

    Result<void> run_pose(scene::Pose pose) {
        scene::Camera& camera = *scene_->camera->get<scene::Camera>();
        camera = scene::pose_camera(pose, scene_->terrain->world_bounds(), [&](double x, double y) {
            return scene_->scene.height_at(x, y).value_or(0.0);
        });
        set_technique(reference_technique);
        const auto shown = device_->renderer().draw_hits(scene_->scene);
        if (!shown) {
            return shown.error();
        }
        range_ = depth_range_of(*shown);
        if (range_.far == 0.0) {
            return Error{fmt::format("{}, {}: no pixel of terrain found, some were expected",
                                     options_.terrain, scene::to_string(pose))};
        }
        camera.near = range_.near;
        still_ = camera;
        auto entries = entries_for(pose);
        for (BaselineEntry& entry : entries) {
            if (auto measured = measure_error(entry); !measured) {
                return measured;
            }
        }
        for (const bool moving : {false, true}) {
            if (auto timed = time_all(entries, moving); !timed) {
                return timed;
            }
        }
        for (BaselineEntry& entry : entries) {
            if (!entry.ms.empty()) {
                entry.row.frames = entry.ms.size();
                entry.row.ms = summarize(entry.ms);
                results_.rows.push_back(std::move(entry.row));
            }
        }
        return {};
    }

    void set_technique(const scene::Technique& technique) {
        scene_->terrain->get<scene::TerrainNode>()->material.technique = technique;
    }

    std::vector<BaselineEntry> entries_for(scene::Pose pose) {
        std::vector<BaselineEntry> entries;
        for (auto& [levels, baseline] : baselines_) {
            entries.push_back(irrlicht_entry(pose, levels, baseline));
        }
        const scene::Technique coarse{scene::Polygons{.error = 4.0}};
        const scene::Technique every_sample{scene::Polygons{}};
        for (const scene::Technique& technique : {reference_technique, coarse, every_sample}) {
            entries.push_back(own_entry(pose, technique));
        }
        const std::size_t still = entries.size();
        entries.push_back(irrlicht_entry(pose, baselines_.back().first, baselines_.back().second));
        entries.push_back(own_entry(pose, reference_technique));
        entries.push_back(own_entry(pose, coarse));
        for (std::size_t i = still; i < entries.size(); ++i) {
            entries[i].row.moving = true;
        }
        return entries;
    }

    BaselineEntry own_entry(scene::Pose pose, const scene::Technique& technique) {
        BaselineEntry entry;
        entry.row.pose = pose;
        entry.row.what = scene::to_string(technique);
        entry.set_camera = [] { return Result<void>(); };
        entry.draw = [this, technique](BaselineRow& row) -> Result<double> {
            set_technique(technique);
            const auto stats = device_->renderer().draw(scene_->scene, true);
            if (!stats) {
                return stats.error();
            }
            row.triangles = stats->triangles;
            return stats->cpu_ms + stats->gpu_ms;
        };
        entry.hits = [this, technique] {
            set_technique(technique);
            return device_->renderer().draw_hits(scene_->scene);
        };
        return entry;
    }

    BaselineEntry irrlicht_entry(scene::Pose pose, int levels, BaselineProcess& baseline) {
        BaselineEntry entry;
        entry.row.pose = pose;
        entry.row.what = fmt::format("irrlicht:lods={}", levels);
        entry.set_camera = [this, &baseline]() -> Result<void> {
            const glm::dvec3 eye = scene_->view().eye;
            const glm::dvec3 look = scene_->view().target;
            const auto placed =
                baseline.ask(fmt::format("view {} {} {} {} {} {} {} {}", eye.x, eye.y, eye.z,
                                         look.x, look.y, look.z, range_.near, range_.far));
            return placed ? Result<void>() : placed.error();
        };
        entry.draw = [&baseline](BaselineRow& row) -> Result<double> {
            const auto answer = baseline.ask("draw");
            if (!answer) {
                return answer.error();
            }
            std::size_t end = 0;
            const double ms = std::stod(*answer, &end);
            row.triangles = std::stoul(answer->substr(end));
            return ms;
        };
        entry.hits = [this, &baseline] { return irrlicht_hits(baseline); };
        return entry;
    }

    // The camera of the pose, moved to its right by `frame` steps if `moving`.
    void place_camera(bool moving, int frame) {
        const double step =
            moving ? frame * scene_->terrain->world_bounds().size().x / frames_across : 0.0;
        const glm::dvec3 offset = step * scene::view_axes(still_).right;
        scene::Camera& camera = *scene_->camera->get<scene::Camera>();
        camera = still_;
        camera.eye += offset;
        camera.target += offset;
    }

    Result<HitBuffer> irrlicht_hits(BaselineProcess& baseline) {
        const glm::ivec2 size = options_.suite.size;
        std::vector<float> depths(static_cast<std::size_t>(size.x) *
                                  static_cast<std::size_t>(size.y));
        auto file = MemoryFile::create();
        if (!file) {
            return file.error();
        }
        if (const auto written = baseline.ask("depth " + path_of(*file)); !written) {
            return written.error();
        }
        std::ifstream in(path_of(*file), std::ios::binary);
        in.read(reinterpret_cast<char*>(depths.data()),
                static_cast<std::streamsize>(depths.size() * sizeof(float)));
        if (!in) {
            return Error{"irrlicht: fewer depths found than pixels, one each was expected"};
        }
        return hits_of(*scene_, depths, size, range_);
    }

    Result<void> measure_error(BaselineEntry& entry) {
        if (entry.row.moving) {
            return {};
        }
        if (auto ready = entry.set_camera(); !ready) {
            return ready;
        }
        const auto hits = entry.hits();
        if (!hits) {
            return hits.error();
        }
        // The truth does not affect the reprojection error.
        const auto errors = truth::geometric_errors(surface_view(*scene_), *hits, *hits);
        entry.row.error = errors ? errors->reprojection.distribution : std::nullopt;
        return {};
    }

    Result<void> time_all(std::vector<BaselineEntry>& entries, bool moving) {
        const int rounds = options_.suite.rounds > 0 ? options_.suite.rounds
                           : options_.suite.quick    ? 5
                                                     : default_rounds;
        cli::ProgressLine line("measuring peers", options_.suite.quiet);
        for (int round = -warm_up; round < rounds && !stop_.stop_requested(); ++round) {
            place_camera(moving, round);
            for (BaselineEntry& entry : entries) {
                auto timed =
                    entry.row.moving == moving ? time_one(entry, round >= 0) : Result<void>();
                if (!timed) {
                    return timed;
                }
            }
            line.update(static_cast<double>(round + warm_up) / (rounds + warm_up));
        }
        return {};
    }

    static Result<void> time_one(BaselineEntry& entry, bool counts) {
        if (auto ready = entry.set_camera(); !ready) {
            return ready;
        }
        const auto ms = entry.draw(entry.row);
        if (!ms) {
            return ms.error();
        }
        if (counts) {
            entry.ms.push_back(*ms);
        }
        return {};
    }

    BaselineResults& results_;
    const BaselineOptions& options_;
    std::stop_token stop_;
    std::optional<BaselineScene> scene_;
    std::vector<std::pair<int, BaselineProcess>> baselines_; // with their levels
    std::optional<session::Device> device_;
    DepthRange range_;
    scene::Camera still_; // of the pose
};

// Of the reference row with the same pose and camera; 0 if absent.
double reference_ms(const BaselineResults& results, const BaselineRow& view) {
    const std::string reference = scene::to_string(reference_technique);
    const auto found = std::find_if(results.rows.begin(), results.rows.end(), [&](const auto& row) {
        return row.pose == view.pose && row.moving == view.moving && row.what == reference;
    });
    return found == results.rows.end() ? 0.0 : found->ms.median;
}

std::vector<FigureJson> error_values(const std::optional<truth::Distribution>& error) {
    return error ? std::vector<FigureJson>{error->median, error->p95, error->p99,
                                           error->max,    error->rms, error->count}
                 : std::vector<FigureJson>(6);
}

} // namespace

BaselineResults run_baselines(const BaselineOptions& options, const std::stop_token& stop) {
    BaselineResults results{.options = options};
    const auto done = BaselineRun(results, stop).run();
    results.end = run_end(done, stop, !results.rows.empty());
    return results;
}

FigureTable figure_table(const BaselineResults& results) {
    const glm::ivec2 size = results.options.suite.size;
    FigureTable table{.schema = "reljef-bench-peers/1",
                      .heading = fmt::format("{}, {} x {} samples, {}, {}, {} threads",
                                             cli::printable(results.options.terrain), results.side,
                                             results.side, size_text(size),
                                             cli::printable(results.environment.renderer),
                                             results.environment.threads),
                      .settings = {{"environment", json_of(results.environment)},
                                   {"terrain", results.options.terrain},
                                   {"side", results.side},
                                   {"size", size_text(size)}},
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
                      .end = results.end};
    for (const BaselineRow& row : results.rows) {
        FigureJson values{scene::to_string(row.pose),
                          row.what,
                          row.moving ? "moving" : "still",
                          row.frames,
                          row.ms.median,
                          row.ms.p95,
                          row.ms.p99,
                          1000.0 / row.ms.median,
                          row.ms.median / reference_ms(results, row),
                          row.triangles};
        for (FigureJson& figure : error_values(row.error)) {
            values.push_back(std::move(figure));
        }
        table.rows.push_back(std::move(values));
    }
    return table;
}

} // namespace reljef::bench
