#include "engine/session/frame_maker.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/core/process_memory.h"
#include "engine/core/statistics.h"
#include "engine/core/stopwatch.h"
#include "engine/session/flight_keys.h"
#include "engine/view/choice/choice_picture.h"
#include "engine/view/choice/triangle_counts.h"
#include "engine/view/error_view.h"

namespace reljef::session {
namespace {

constexpr double megabyte = 1e6;
constexpr int max_rises_of_frame = 4;

// As many triangles as a view of a terrain, of few vertices: software renderers allocate tens of
// megabytes for triangles.
scene::Scene busy_scene() {
    scene::Mesh mesh = scene::plane_mesh(glm::vec2(0.01F));
    const std::vector<std::uint32_t> once = mesh.indices;
    constexpr int times = 200'000;
    mesh.indices.reserve(times * once.size());
    for (int i = 1; i < times; ++i) {
        mesh.indices.insert(mesh.indices.end(), once.begin(), once.end());
    }
    scene::Scene scene;
    scene.add_mesh(std::move(mesh));
    scene.add_camera({.eye = {0.0, 0.0, 1.0}});
    return scene;
}

std::string streams_text(std::span<const scene::TileStreamStats> streams) {
    std::string text;
    for (const scene::TileStreamStats& stats : streams) {
        text +=
            fmt::format("streamed: {} tiles read ({:.1f} MB of files), {} failed, {} cancelled, "
                        "{} evicted; {} kept ({:.1f} MB, at most {:.1f} MB)\n",
                        stats.read, static_cast<double>(stats.bytes_read) / megabyte, stats.failed,
                        stats.cancelled, stats.evicted, stats.tiles,
                        static_cast<double>(stats.bytes) / megabyte,
                        static_cast<double>(stats.max_bytes) / megabyte);
    }
    return text;
}

// Repeated, because a lifted camera may see higher ground.
void raise(TerrainScene& scene, FrameMaker& maker, const std::stop_token& stop, int max_rises) {
    for (int i = 0; i < max_rises; ++i) {
        maker.wait_for_tiles(scene.scene, stop);
        if (keep_above_ground(scene) == 0.0) {
            return;
        }
    }
}

std::string times_text(const FrameTimes& times) {
    const Summary drawing = summarize(times.drawing_ms);
    const Summary waiting = summarize(times.waiting_ms);
    return fmt::format("frames: {}, half drawn within {:.2f} ms, 99 % within {:.2f} ms; waited for "
                       "tiles: half {:.2f} ms, 99 % at most {:.2f} ms\n",
                       times.drawing_ms.size(), drawing.median, drawing.p99, waiting.median,
                       waiting.p99);
}

std::string memory_text(std::size_t before) {
    return fmt::format("memory: {:.1f} MB of the process at most, {:.1f} MB before the terrain was "
                       "read\n",
                       static_cast<double>(process_memory().peak) / megabyte,
                       static_cast<double>(before) / megabyte);
}

// Of `auto`; empty for other techniques.
std::string choice_text(const std::optional<view::Choice>& choice) {
    if (!choice) {
        return {};
    }
    std::string text =
        fmt::format("choice: {} tiles as triangles, {} by rays, {:.0f} % of the "
                    "pixels by rays",
                    choice->tiles_as_triangles, choice->tiles_by_rays, 100.0 * choice->ray_pixels);
    if (choice->typical) {
        text += fmt::format(" with {}, which shows {:.0f} % of the probed pixels within the bound, "
                            "without a proof",
                            choice->typical->technique, 100.0 * choice->typical->share);
    }
    if (choice->rays_ms) {
        text += fmt::format("; estimated {:.1f} ms, {:.1f} ms as triangles alone, {:.1f} ms by "
                            "rays alone",
                            choice->estimated_ms, choice->triangles_ms, *choice->rays_ms);
    }
    return text + "\n";
}

// Of tiles whose errors are estimates nothing is kept.
std::string kept_error_text(const view::FrameStats& stats) {
    const char* const part = stats.tiles_unproven > 0 ? " where tiles are proven" : "";
    return stats.kept_error ? fmt::format("{:.2f} px{}", *stats.kept_error, part) : "not proven";
}

// Triangles may be off by far more for other reasons, also in views that are too narrow.
bool is_over_by_rounding(const view::FrameStats& stats, const scene::Camera& camera,
                         glm::ivec2 size, const ExpectedError& bound) {
    const bool by_triangles = bound.is_named && stats.rays == 0 &&
                              (!stats.choice || stats.choice->tiles_by_rays == 0) &&
                              stats.triangles > 0;
    const double rounding =
        view::left_of_bound(camera, size, std::max(bound.pixels, view::min_error)).vertex_rounding;
    return stats.exceeded_by_rounding &&
           (!by_triangles || *stats.kept_error < 4.0 * std::max(rounding, bound.pixels));
}

} // namespace

DeviceFrames::DeviceFrames(Device device, Log& log, const DeviceFramesOptions& options)
    : device_(std::move(device)), log_(log), options_(options) {
    if (options_.timed) {
        const bool has_triangles = !device_.renderer().shows_rays();
        static_cast<void>(
            device_.renderer().draw(has_triangles ? busy_scene() : scene::Scene(), true));
        static_cast<void>(device_.renderer().draw(scene::Scene(), true)); // frees the other's mesh
        times_.memory_before = process_memory().peak;
    }
}

void DeviceFrames::wait_for_tiles(const scene::Scene& scene, const std::stop_token& stop) {
    if (ready_for_ == scene.camera()) {
        return;
    }
    SceneRenderer& renderer = device_.renderer();
    if (!options_.waits_for_tiles) {
        request_tiles(renderer.select(scene).requests);
        ready_for_ = scene.camera();
        return;
    }
    const Stopwatch waiting;
    session::wait_for_tiles(scene, renderer.size(), renderer.selector(), log_, stop);
    // The last selection counts as drawing.
    waited_ms_ += waiting.milliseconds() - renderer.selector().milliseconds();
    ready_for_ = scene.camera();
}

Result<Image> DeviceFrames::draw(const scene::Scene& scene, const ParallelOptions& parallel) {
    wait_for_tiles(scene, parallel.stop);
    times_.waiting_ms.push_back(std::exchange(waited_ms_, 0.0));
    ready_for_.reset();
    stream_stats_ = stream_stats(scene);
    const auto stats = device_.renderer().draw_selected(options_.timed);
    if (!stats) {
        return stats.error();
    }
    times_.drawing_ms.push_back(stats->cpu_ms + stats->gpu_ms);
    take_stats(*stats, scene);
    Image picture = device_.renderer().read_color();
    if (auto good = device_.renderer().check_drawn(); !good) {
        return good.error();
    }
    return options_.shows_choice ? tinted(std::move(picture)) : Result<Image>(std::move(picture));
}

Result<Image> DeviceFrames::tinted(Image picture) {
    SceneRenderer& renderer = device_.renderer();
    const auto drawn = renderer.draw_selected_hits();
    if (!drawn) {
        return drawn.error();
    }
    view::tint_choice(picture, drawn->hits, renderer.selector().selected().list);
    return picture;
}

Result<HitBuffer> DeviceFrames::draw_hits(const scene::Scene& scene,
                                          const ParallelOptions& parallel) {
    SceneRenderer& renderer = device_.renderer();
    session::wait_for_tiles(scene, renderer.size(), renderer.selector(), log_, parallel.stop);
    auto drawn = renderer.draw_selected_hits();
    if (!drawn) {
        return drawn.error();
    }
    take_stats(drawn->stats, scene);
    return std::move(drawn->hits);
}

void DeviceFrames::begin_parts(const scene::Scene& scene, glm::ivec2 picture) {
    device_.renderer().choose_for_parts(scene, picture);
    parts_ = 0;
}

void DeviceFrames::take_stats(const view::FrameStats& stats, const scene::Scene& scene) {
    stats_ = stats;
    frames_as_triangles_ += stats.reliefs_as_triangles > 0 && stats.rays == 0 ? 1 : 0;
    note_kept_error(scene);
    note_fewer_vertices(scene);
    if (scene.camera().whole == glm::ivec2(0)) {
        return;
    }
    all_parts_ = parts_ == 0 ? stats : view::together(all_parts_, stats);
    ++parts_;
    stats_ = all_parts_;
}

void DeviceFrames::note_kept_error(const scene::Scene& scene) {
    const auto expected = expected_error(scene);
    if (!expected || !options_.waits_for_tiles) {
        return;
    }
    names_bound_ = expected->is_named;
    megabytes_for_all_samples_ = megabytes_for_all_samples(scene);
    if (stats_.choice && stats_.choice->typical) {
        min_share_ = std::min(min_share_.value_or(1.0), stats_.choice->typical->share);
    } else {
        max_unproven_ = std::max(max_unproven_, stats_.tiles_unproven);
    }
    if (stats_.kept_error.value_or(0.0) <= expected->pixels) {
        return;
    }
    const glm::ivec2 size = device_.renderer().size();
    FramesOver over = over_.value_or(FramesOver());
    if (*stats_.kept_error > over.kept_error) {
        over.kept_error = *stats_.kept_error;
        over.expected = *expected;
        over.by_rounding = is_over_by_rounding(stats_, scene.camera(), size, *expected);
    }
    const MemoryForBound needed = memory_for_bound(scene, size);
    const std::size_t triangles = over.counts_triangles ? triangles_needed() : 0;
    over.triangles = std::max(over.triangles, triangles);
    over.counts_triangles =
        triangles > 0 || (over.counts_triangles && !stats_.lacks_triangles && needed.growth > 1.0);
    if (needed.growth >= over.memory.growth) {
        over.memory = needed;
    }
    over.misses_tiles = over.misses_tiles || stats_.tiles_missing > 0;
    over.lacks_triangles = over.lacks_triangles || stats_.lacks_triangles;
    over_ = over;
}

// By the last frame; 0: it has all that it needs, or the number is not known.
std::size_t DeviceFrames::triangles_needed() {
    constexpr std::size_t counted = 4; // times as many as there may be
    const view::DrawList& list = device_.renderer().selector().selected().list;
    return stats_.lacks_triangles && !list.tiles.empty()
               ? view::triangles_for_bound(list,
                                           counted * list.tiles.front().terrain->max_triangles)
               : 0;
}

void DeviceFrames::note_fewer_vertices(const scene::Scene& scene) {
    const int megabytes = megabytes_for_every_sample(scene);
    if (megabytes > 0 && stats_.kept_error) {
        megabytes_for_vertices_ = std::max(megabytes_for_vertices_, megabytes);
        max_of_fewer_vertices_ = std::max(max_of_fewer_vertices_, *stats_.kept_error);
    }
}

std::string DeviceFrames::remedy() const {
    if (over_->by_rounding) {
        return "the view is too narrow or too far away, or the ground too steep, for floats";
    }
    const MemoryForBound& memory = over_->memory;
    const int now = options_.memory_megabytes;
    double megabytes = std::ceil(memory.growth * now);
    const bool is_less_whole =
        memory.whole_megabytes && (!memory.is_enough || *memory.whole_megabytes < megabytes);
    megabytes = is_less_whole ? *memory.whole_megabytes : megabytes;
    if (over_->lacks_triangles && over_->counts_triangles && (memory.is_enough || is_less_whole)) {
        const double for_triangles = megabytes_for_triangles(over_->triangles);
        return fmt::format("--memory {:.0f} keeps it", std::max(megabytes, for_triangles));
    }
    if (over_->lacks_triangles) {
        return megabytes > now
                   ? fmt::format(
                         "more than --memory {} is needed, about {:.0f} for its tiles alone", now,
                         megabytes)
                   : fmt::format("more than --memory {} is needed", now);
    }
    if (megabytes > now) {
        return memory.is_enough || is_less_whole
                   ? fmt::format("--memory {:.0f} keeps it", megabytes)
                   : fmt::format("more than --memory {:.0f} is needed", megabytes);
    }
    return over_->misses_tiles ? "tiles cannot be read" : "the eye is too near to the ground";
}

std::string DeviceFrames::unproven_note() const {
    const std::string farther = fmt::format("pixels may be farther off than {}",
                                            names_bound_ ? "the error bound" : "a pixel");
    return megabytes_for_all_samples_
               ? fmt::format(
                     "averages of the samples are drawn, and {}: --memory {} reads all samples",
                     farther, *megabytes_for_all_samples_)
               : fmt::format("the errors of {} tiles are estimates, and {}: {}", max_unproven_,
                             farther, why_unproven(stream_stats_));
}

std::vector<std::string> DeviceFrames::error_notes() const {
    std::vector<std::string> notes;
    if (over_) {
        const double diagonal = glm::length(glm::dvec2(device_.renderer().size()));
        const std::string found =
            std::isinf(over_->kept_error)
                ? std::string("pixels are off by any distance, because the errors reach the eye")
            : over_->kept_error > diagonal
                ? std::string("pixels are off by more than the picture's size")
                : fmt::format("pixels are off by up to {:.3g}", over_->kept_error);
        const std::string_view kind =
            over_->expected.is_named ? "was the error bound" : "was expected of exact rays";
        notes.push_back(
            fmt::format("{}, and {:g} {}: {}", found, over_->expected.pixels, kind, remedy()));
    }
    if (megabytes_for_vertices_ > 0) {
        notes.push_back(
            fmt::format("not every sample is drawn, and pixels are off by up to {:.3g}: "
                        "--memory {} holds all triangles",
                        max_of_fewer_vertices_, megabytes_for_vertices_));
    }
    if (max_unproven_ > 0 || megabytes_for_all_samples_) {
        notes.push_back(unproven_note());
    }
    if (min_share_) {
        notes.push_back(fmt::format(
            "pixels may be farther off than the error bound: with typical=1, searches are drawn "
            "that showed at least {:.0f} % of the probed pixels within it",
            std::floor(100.0 * *min_share_)));
    }
    if (frames_as_triangles_ > 0) {
        notes.push_back(fmt::format(
            "{} of the pictures show triangles instead of the technique: rays over this map of the "
            "Earth are not precise there; --placement plane shows it",
            frames_as_triangles_));
    }
    return notes;
}

std::string DeviceFrames::stats() const {
    return streams_text(stream_stats_) + times_text(times_) + memory_text(times_.memory_before) +
           choice_text(stats_.choice) +
           fmt::format(
               "renderer: {}\n"
               "nodes: {}, tiles: {}, triangles: {} ({} slivers), rays: {}, draws: {}, state "
               "changes: {}\n"
               "uploads: {} ({:.1f} MB)\n"
               "tiles cut: {}, unproven: {}, kept error: {}\n"
               "skipped: {} hidden nodes, {} nodes, {} tiles and {} triangles outside the "
               "frustum, {} tiles behind nearer ground, {} "
               "triangles under the error, {} details too small, {} selections, {} cuts and {} "
               "uploads that were there\n"
               "cpu: {:.2f} ms, gpu: {:.2f} ms\n",
               device_.info().renderer, stats_.nodes, stats_.tiles, stats_.triangles,
               stats_.slivers, stats_.rays, stats_.draws, stats_.state_changes, stats_.uploads,
               static_cast<double>(stats_.upload_bytes) * 1e-6, stats_.tiles_cut,
               stats_.tiles_unproven, kept_error_text(stats_), stats_.skipped.invisible_nodes,
               stats_.skipped.nodes_outside_frustum, stats_.skipped.tiles_outside_frustum,
               stats_.skipped.triangles_outside_frustum, stats_.skipped.tiles_occluded,
               stats_.skipped.triangles_under_error, stats_.skipped.details_too_small,
               stats_.skipped.selections_unchanged, stats_.skipped.cuts_unchanged,
               stats_.skipped.uploads_unchanged, stats_.cpu_ms, stats_.gpu_ms);
}

void TruthFrames::wait_for_tiles(const scene::Scene& scene, const std::stop_token& stop) {
    wait_for_ground_below_eye(scene, stop);
}

Result<void> TruthFrames::prepare(const scene::Scene& scene) {
    if (caster_ || streamed_) {
        return {};
    }
    if (!stream_stats(scene).empty()) {
        auto streamed = truth::StreamedTruth::create(scene);
        if (!streamed) {
            return streamed.error();
        }
        streamed_.emplace(std::move(*streamed));
        return {};
    }
    auto caster = truth::SceneCaster::create(scene);
    if (!caster) {
        return caster.error();
    }
    caster_ = std::move(*caster);
    return {};
}

void TruthFrames::log_notes() {
    for (const std::string& note :
         streamed_ ? streamed_->take_notes() : std::vector<std::string>()) {
        log_.note(note);
    }
}

Result<Image> TruthFrames::draw(const scene::Scene& scene, const ParallelOptions& parallel) {
    const Stopwatch preparing;
    if (auto prepared = prepare(scene); !prepared) {
        return prepared.error();
    }
    if (!shading_ && !streamed_) {
        shading_.emplace(scene, *caster_, truth::sun_shadow_of(scene));
    }
    prepare_ms_ = std::max(prepare_ms_, preparing.milliseconds());
    const Stopwatch drawing;
    const truth::DrawOptions options{.rays_per_side = rays_per_side_,
                                     .shadow = truth::sun_shadow_of(scene),
                                     .parallel = parallel};
    auto picture = streamed_ ? streamed_->draw(scene.camera(), size_, options)
                             : truth::draw(*caster_, *shading_, scene.camera(), size_, options);
    draw_ms_ = drawing.milliseconds();
    log_notes();
    return picture ? Result<Image>(std::move(picture->image)) : picture.error();
}

Result<HitBuffer> TruthFrames::draw_hits(const scene::Scene& scene,
                                         const ParallelOptions& parallel) {
    if (auto prepared = prepare(scene); !prepared) {
        return prepared.error();
    }
    auto hits = streamed_ ? streamed_->draw_hits(scene.camera(), size_, parallel)
                          : truth::draw_hits(*caster_, scene.camera(), size_, parallel);
    log_notes();
    return hits;
}

std::string TruthFrames::stats() const {
    std::string tiles;
    if (streamed_) {
        const truth::StreamedSurfaceStats& stats = streamed_->stats();
        tiles = fmt::format("streamed: {} tiles read, {} of them again; at most {:.1f} MB kept\n",
                            stats.loaded, stats.reloaded,
                            static_cast<double>(stats.max_bytes) / megabyte);
    }
    return fmt::format("renderer: exact rays on the CPU\n"
                       "rays: {} a frame\n"
                       "{}once: {:.2f} ms, frame: {:.2f} ms\n"
                       "memory: {:.1f} MB of the process at most\n",
                       static_cast<long long>(size_.x) * size_.y * rays_per_side_ * rays_per_side_,
                       tiles, prepare_ms_, draw_ms_,
                       static_cast<double>(process_memory().peak) / megabyte);
}

HitBuffer in_source_rows(HitBuffer hits, const TerrainScene& scene, bool by_rays) {
    const auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    const auto& georeference = terrain.surface->heightfield().georeference;
    if (!georeference) {
        return hits;
    }
    const bool of_tiles =
        terrain.stream != nullptr && (by_rays || scene::draws_tiles(terrain.material.technique));
    const geo::WrappedRows& rows =
        of_tiles ? terrain.stream->maker().rows() : georeference->geodetic.rows();
    for (Hit& hit : hits.samples()) {
        if (truth::shows_terrain(hit)) {
            const glm::dvec2 place = hit.place();
            hit = hit_at({place.x, rows.source_row(place.y)}, hit.height, hit.depth);
        }
    }
    return hits;
}

Lift fly_above_ground(TerrainScene& scene, const scene::CameraPath& path, int index, int frames,
                      FrameMaker& maker, const std::stop_token& stop, Underground underground) {
    fly_to(scene, path, index, frames);
    if (underground == Underground::allowed) {
        return {};
    }
    maker.wait_for_tiles(scene.scene, stop);
    const glm::dvec3 eye = scene.scene.camera().eye;
    Lift lift;
    lift.depth = lift_of(*scene.terrain->get<scene::TerrainNode>(), eye, 0.0).depth;
    raise(scene, maker, stop, max_rises_of_frame);
    lift.way = scene.scene.camera().eye - eye;
    lift.metres = glm::length(lift.way);
    return lift;
}

Lift stand_above_ground(TerrainScene& scene, FrameMaker& maker, const std::stop_token& stop,
                        Underground underground) {
    if (underground == Underground::allowed) {
        return {};
    }
    maker.wait_for_tiles(scene.scene, stop);
    const glm::dvec3 eye = scene.scene.camera().eye;
    Lift lift = lift_camera(scene);
    if (lift) {
        raise(scene, maker, stop, max_rises_of_frame - 1);
        lift.way = scene.scene.camera().eye - eye;
        lift.metres = glm::length(lift.way);
        const Lift from_finer_ground = lift_of(*scene.terrain->get<scene::TerrainNode>(), eye, 0.0);
        lift.depth = from_finer_ground ? from_finer_ground.depth : lift.depth;
    }
    return lift;
}

} // namespace reljef::session
