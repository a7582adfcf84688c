#include "bench/baselines/peers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <unistd.h>

#include "app/cli/progress_line.h"
#include "bench/baselines/irrlicht/protocol.h"
#include "bench/baselines/peer_process.h"
#include "bench/baselines/peer_scene.h"
#include "engine/core/memory_file.h"
#include "engine/render/residency/terrain_maps.h"
#include "engine/scene/graph/scene.h"
#include "engine/session/device.h"
#include "engine/session/terrain_source.h"

namespace reljef::bench {
namespace {

constexpr int default_rounds = 30;
constexpr int warm_up = 2; // rounds
// Of a camera that moves: as fast as one that flies over the terrain in 20 s at 25 frames a second.
constexpr double frames_across = 500.0;

// What Irrlicht reads, in files that have no name.
struct PeerFiles {
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

Result<PeerFiles> files_of(const scene::TerrainSurface& surface) {
    const Grid<float>& heights = surface.heightfield().heights;
    const int side = heights.cols();
    std::vector<float> columns;
    for (int col = 0; col < side; ++col) {
        for (int row = side - 1; row >= 0; --row) {
            columns.push_back(heights(col, row));
        }
    }
    const Image lit = render::lit_map(surface, std::nullopt, side);
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
    return PeerFiles{std::move(*heights_file), std::move(*colors_file)};
}

std::string path_of(const MemoryFile& file) {
    return fmt::format("/proc/{}/fd/{}", ::getpid(), file.descriptor());
}

Result<PeerProcess> start_irrlicht(const scene::TerrainSurface& surface, const PeerFiles& files,
                                   glm::ivec2 size, double fov) {
    std::error_code ignored;
    const auto program =
        std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / peer::program_name;
    if (!std::filesystem::exists(program, ignored)) {
        return Error{fmt::format("{} was not built, as Irrlicht was not found: install it (apt-get "
                                 "install libirrlicht-dev), configure and build again",
                                 peer::program_name)};
    }
    const terrain::Heightfield& heightfield = surface.heightfield();
    return PeerProcess::start(
        program,
        {fmt::format("{}", size.x), fmt::format("{}", size.y), fmt::format("{}", fov),
         fmt::format("{}", heightfield.heights.cols()), fmt::format("{}", heightfield.spacing.x),
         fmt::format("{}", heightfield.spacing.y), path_of(files.heights), path_of(files.colors)});
}

// Depths that hold all that is seen with room to spare.
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

truth::SurfaceView surface_view(const PeerScene& scene) {
    return {scene.surface().heightfield().heights.view(), scene.surface().placement(),
            scene.terrain->world_from_local(), scene.view()};
}

std::optional<truth::Distribution> error_of(const PeerScene& scene, const HitBuffer& hits) {
    // Held against itself: what is right elsewhere does not matter for this measure.
    const auto errors = truth::geometric_errors(surface_view(scene), hits, hits);
    return errors ? errors->reprojection.distribution : std::nullopt;
}

// What a depth buffer shows: see protocol.h.
HitBuffer hits_of(const PeerScene& scene, std::span<const float> depths, glm::ivec2 size,
                  const DepthRange& range) {
    HitBuffer hits(size.x, size.y);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const double kept =
                depths[static_cast<std::size_t>(size.y - 1 - y) * static_cast<std::size_t>(size.x) +
                       static_cast<std::size_t>(x)];
            if (kept >= 1.0) {
                continue;
            }
            const double depth =
                range.near * range.far / (range.far - kept * (range.far - range.near));
            const Ray ray = scene::view_ray(scene.view(), size, glm::dvec2(x, y) + 0.5);
            if (const auto sample = scene.surface().placement().sample_from_world(ray.at(depth))) {
                hits(x, y) = {static_cast<float>(sample->x), static_cast<float>(sample->y),
                              static_cast<float>(sample->z), static_cast<float>(depth)};
            }
        }
    }
    return hits;
}

// One way to draw.
struct PeerEntry {
    PeerRow row;
    std::function<Result<void>()> set_up; // for where the camera is
    /// Milliseconds of a frame; fills in the row's triangles.
    std::function<Result<double>(PeerRow&)> draw;
    std::function<Result<HitBuffer>()> hits;
    std::vector<double> ms{};
};

class PeersRun {
public:
    PeersRun(const PeersOptions& options, std::stop_token stop)
        : options_(options), stop_(std::move(stop)) {
        results_.options = options;
    }

    Result<void> run() {
        auto scene = open_peer_scene(
            {options_.terrain, options_.suite.threads, options_.suite.quiet}, stop_);
        if (!scene) {
            return scene.error();
        }
        scene_.emplace(std::move(*scene));
        results_.side = scene_->surface().heightfield().heights.cols();
        if (auto started = start_peers(); !started) {
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

    PeersResults take() { return std::move(results_); }

private:
    Result<void> start_peers() {
        auto files = files_of(scene_->surface());
        if (!files) {
            return files.error();
        }
        for (const int levels : {1, 3, 5}) {
            auto peer = start_irrlicht(scene_->surface(), *files, options_.suite.size,
                                       scene_->view().vertical_fov);
            if (!peer) {
                return peer.error();
            }
            if (auto built = peer->ask(fmt::format("lods {}", levels)); !built) {
                return built.error();
            }
            peers_.emplace_back(levels, std::move(*peer));
        }
        return {};
    }

    Result<void> open_device() {
        auto opened = session::Device::create(
            {.context = options_.suite.context.value_or(platform::ContextKind::glfw),
             .size = options_.suite.size,
             .shader_dir = options_.suite.shader_dir,
             .threads = options_.suite.threads});
        if (!opened) {
            return opened.error();
        }
        device_.emplace(std::move(*opened));
        results_.environment = environment_of(device_->context(), options_.suite.threads);
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
        for (PeerEntry& entry : entries) {
            if (auto judged = judge(entry); !judged) {
                return judged;
            }
        }
        for (const bool moving : {false, true}) { // apart: a camera that comes back has moved, too
            if (auto timed = time_all(entries, moving); !timed) {
                return timed;
            }
        }
        for (PeerEntry& entry : entries) {
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

    std::vector<PeerEntry> entries_for(scene::Pose pose) {
        std::vector<PeerEntry> entries;
        for (auto& [levels, peer] : peers_) {
            entries.push_back(irrlicht_entry(pose, levels, peer));
        }
        const scene::Technique coarse{scene::Polygons{.error = 4.0}};
        const scene::Technique every_sample{scene::Polygons{}};
        for (const scene::Technique& technique : {reference_technique, coarse, every_sample}) {
            entries.push_back(own_entry(pose, technique));
        }
        entries.push_back(moving(irrlicht_entry(pose, peers_.back().first, peers_.back().second)));
        for (const scene::Technique& technique : {reference_technique, coarse}) {
            entries.push_back(moving(own_entry(pose, technique)));
        }
        return entries;
    }

    PeerEntry own_entry(scene::Pose pose, const scene::Technique& technique) {
        PeerEntry entry;
        entry.row.pose = pose;
        entry.row.what = scene::to_string(technique);
        entry.set_up = [] { return Result<void>(); };
        entry.draw = [this, technique](PeerRow& row) -> Result<double> {
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

    PeerEntry irrlicht_entry(scene::Pose pose, int levels, PeerProcess& peer) {
        PeerEntry entry;
        entry.row.pose = pose;
        entry.row.what = fmt::format("irrlicht:lods={}", levels);
        entry.set_up = [this, &peer]() -> Result<void> {
            const glm::dvec3 eye = scene_->view().eye;
            const glm::dvec3 look = scene_->view().target;
            const auto placed =
                peer.ask(fmt::format("view {} {} {} {} {} {} {} {}", eye.x, eye.y, eye.z, look.x,
                                     look.y, look.z, range_.near, range_.far));
            return placed ? Result<void>() : placed.error();
        };
        entry.draw = [&peer](PeerRow& row) -> Result<double> {
            const auto answer = peer.ask("draw");
            if (!answer) {
                return answer.error();
            }
            std::size_t end = 0;
            const double ms = std::stod(*answer, &end);
            row.triangles = std::stoul(answer->substr(end));
            return ms;
        };
        entry.hits = [this, &peer] { return irrlicht_hits(peer); };
        return entry;
    }

    static PeerEntry moving(PeerEntry entry) {
        entry.row.moving = true;
        return entry;
    }

    // `frame` of a camera that flies to its right, or the pose's own camera.
    void place_camera(bool moving, int frame) {
        const double step =
            moving ? frame * scene_->terrain->world_bounds().size().x / frames_across : 0.0;
        const glm::dvec3 offset = step * scene::view_axes(still_).right;
        scene::Camera& camera = *scene_->camera->get<scene::Camera>();
        camera = still_;
        camera.eye += offset;
        camera.target += offset;
    }

    Result<HitBuffer> irrlicht_hits(PeerProcess& peer) {
        const glm::ivec2 size = options_.suite.size;
        std::vector<float> depths(static_cast<std::size_t>(size.x) *
                                  static_cast<std::size_t>(size.y));
        auto file = MemoryFile::create();
        if (!file) {
            return file.error();
        }
        if (const auto written = peer.ask("depth " + path_of(*file)); !written) {
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

    Result<void> judge(PeerEntry& entry) {
        if (entry.row.moving) {
            return {};
        }
        if (auto ready = entry.set_up(); !ready) {
            return ready;
        }
        const auto hits = entry.hits();
        if (!hits) {
            return hits.error();
        }
        entry.row.error = error_of(*scene_, *hits);
        return {};
    }

    Result<void> time_all(std::vector<PeerEntry>& entries, bool moving) {
        const int rounds = options_.suite.rounds > 0 ? options_.suite.rounds
                           : options_.suite.quick    ? 5
                                                     : default_rounds;
        cli::ProgressLine line("measuring peers", options_.suite.quiet);
        for (int round = -warm_up; round < rounds && !stop_.stop_requested(); ++round) {
            place_camera(moving, round);
            for (PeerEntry& entry : entries) {
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

    static Result<void> time_one(PeerEntry& entry, bool counts) {
        if (auto ready = entry.set_up(); !ready) {
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

    const PeersOptions& options_;
    std::stop_token stop_;
    std::optional<PeerScene> scene_;
    std::vector<std::pair<int, PeerProcess>> peers_; // by their levels
    std::optional<session::Device> device_;
    DepthRange range_;
    scene::Camera still_; // of the pose
    PeersResults results_;
};

} // namespace

PeersResults run_peers(const PeersOptions& options, const std::stop_token& stop) {
    PeersRun run(options, stop);
    const auto done = run.run();
    PeersResults results = run.take();
    if (stop.stop_requested()) {
        results.stopped = Error{results.rows.empty()
                                    ? "interrupted before the first frame was timed"
                                    : "interrupted, the table holds the frames drawn until then"};
    } else if (!done) {
        results.stopped = done.error();
        results.failed = true;
    }
    return results;
}

} // namespace reljef::bench
