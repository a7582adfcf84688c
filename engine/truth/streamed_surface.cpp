#include "engine/truth/streamed_surface.h"

#include <algorithm>
#include <condition_variable>
#include <limits>
#include <map>
#include <mutex>
#include <optional>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "engine/core/back_off.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/surface_caster.h"

namespace reljef::truth {
namespace {

constexpr std::size_t min_tiles = 12;
constexpr std::size_t max_tiles_of_load = 64;

// Samples, and a third more bounds than cells.
constexpr std::size_t bytes_of_surface_tile =
    (terrain::tree_tile_cells + 1) * (terrain::tree_tile_cells + 1) *
    (sizeof(float) + sizeof(terrain::MinMax) + sizeof(terrain::MinMax) / 2);

std::uint64_t key_of(glm::ivec2 at) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(at.y)) << 32U) |
           static_cast<std::uint32_t>(at.x);
}

glm::ivec2 tile_of(std::uint64_t key) {
    return {static_cast<int>(key & 0xffffffffU), static_cast<int>(key >> 32U)};
}

Error stopped() {
    return Error{"the exact picture: drawing was stopped"};
}

bool wait_until(BackOff::Clock::time_point time, const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    never.wait_until(lock, stop, time, [] { return false; });
    return !stop.stop_requested();
}

// Whether the heights are what the stream shows of files that it cannot read.
bool is_replaced_for_good(const scene::TileStream& stream, const scene::TileContent& content) {
    return content.errors.empty() &&
           std::all_of(content.picture_errors.begin(), content.picture_errors.end(),
                       [&](const FileError& error) { return stream.has_given_up(error.file); });
}

} // namespace

Result<scene::TileContent> read_surely(const scene::TileStream& stream,
                                       const scene::TileContentReader& read, terrain::TreeTile tile,
                                       const std::stop_token& stop) {
    BackOff back_off(stream.options().first_pause);
    while (!stop.stop_requested()) {
        scene::TileContent content = read(tile, stop);
        const auto& errors = content.errors.empty() ? content.picture_errors : content.errors;
        if (stop.stop_requested()) {
            break;
        }
        if (errors.empty() || is_replaced_for_good(stream, content)) {
            return content;
        }
        back_off.fail(BackOff::Clock::now());
        if (back_off.has_failed_for_good()) {
            return Error{errors.front().message};
        }
        if (!wait_until(back_off.again(), stop)) {
            break;
        }
    }
    return stopped();
}

StreamedSurface::StreamedSurface(std::shared_ptr<scene::TileStream> stream,
                                 std::size_t memory_budget)
    : stream_(std::move(stream)) {
    const scene::TileBuilder& builder = stream_->maker();
    const glm::ivec2 of_tree(builder.tree().cols() - 1, builder.tree().rows() - 1);
    last_ = of_tree >> builder.level_of_samples();
    constexpr std::size_t bytes_of_range = 48; // in a map, about
    max_ranges_ = std::max<std::size_t>(1024, memory_budget / 8 / bytes_of_range);
    max_tiles_ = std::max(min_tiles, memory_budget / 8 * 7 / bytes_of_surface_tile);
    max_load_ = std::min(max_tiles_ / 3, max_tiles_of_load);
}

const terrain::SurfaceTile* StreamedSurface::tile(glm::ivec2 at) const {
    const auto found = tiles_.find(key_of(at));
    return found != tiles_.end() ? &found->second->tile : nullptr;
}

std::optional<terrain::MinMax> StreamedSurface::range(glm::ivec2 at) const {
    const auto found = ranges_.find(key_of(at));
    return found != ranges_.end() ? std::optional(found->second) : std::nullopt;
}

// With poles between its rows, a terrain is no affine image of its overview, even on a plane.
std::optional<Ray> StreamedSurface::sample_ray(const Ray& world_ray) const {
    const scene::TileBuilder& builder = stream_->maker();
    const auto ray = terrain::sample_ray_on_plane(builder.overview().placement(), world_ray);
    if (!ray || builder.rows().wrap().rows() > 0) {
        return std::nullopt;
    }
    const double samples_per_step = builder.reduction();
    return Ray{{builder.from_overview(glm::dvec2(ray->origin)), ray->origin.z},
               {samples_per_step * glm::dvec2(ray->direction), ray->direction.z}};
}

glm::dvec3 StreamedSurface::world_from_sample(glm::dvec3 sample) const {
    const scene::TileBuilder& builder = stream_->maker();
    return builder.overview().placement().world_from_sample(
        {builder.on_overview(glm::dvec2(sample)), sample.z});
}

std::optional<double> StreamedSurface::columns_all_around() const {
    return stream_->maker().tree().wraps_longitude() ? std::optional<double>(last_.x)
                                                     : std::nullopt;
}

std::optional<glm::dvec3> StreamedSurface::sample_from_world(glm::dvec3 world) const {
    const scene::TileBuilder& builder = stream_->maker();
    const auto on_overview = builder.overview().placement().sample_from_world(world);
    if (!on_overview) {
        return std::nullopt;
    }
    glm::dvec2 sample = builder.from_overview(glm::dvec2(*on_overview));
    if (builder.tree().wraps_longitude() && (sample.x < 0.0 || sample.x > last_.x)) {
        sample.x -= last_.x * std::floor(sample.x / last_.x);
    }
    return glm::dvec3(sample, on_overview->z);
}

Result<StreamedSurface::Read> StreamedSurface::read(glm::ivec2 at,
                                                    const std::stop_token& stop) const {
    const scene::TileBuilder& builder = stream_->maker();
    const terrain::TreeTile tile{builder.level_of_samples(), at.x, at.y};
    auto content = read_surely(*stream_, stream_->height_reader(), tile, stop);
    if (!content) {
        return content.error();
    }
    const glm::ivec2 cells = builder.tree().cells(tile);
    Read read{std::make_shared<Loaded>(), std::move(content->notes)};
    Grid<float>& heights = read.loaded->heights;
    heights = Grid<float>(cells.x + 1, cells.y + 1);
    const scene::FilledHeights filled =
        builder.filled(tile, std::move(content->heights), std::move(content->was_void));
    for (int row = 0; row <= cells.y; ++row) {
        for (int col = 0; col <= cells.x; ++col) {
            heights(col, row) = filled.heights(col + 1, row + 1);
        }
    }
    read.loaded->pyramid = terrain::MinMaxPyramid(heights.view());
    const terrain::MinMax range = read.loaded->pyramid.total();
    if (builder.overview().placement().kind() == terrain::PlacementKind::ellipsoid &&
        std::max(range.high, -range.low) > terrain::max_height_on_ellipsoid) {
        return Error{fmt::format("the exact picture: a height of {} m found, at most {} m was "
                                 "expected on the ellipsoid; --placement plane draws it",
                                 range.high > -range.low ? range.high : range.low,
                                 terrain::max_height_on_ellipsoid)};
    }
    read.loaded->tile = {heights.view(), &read.loaded->pyramid, at * terrain::tree_tile_cells};
    return read;
}

Result<void> StreamedSurface::load(std::span<const glm::ivec2> tiles,
                                   const ParallelOptions& parallel) {
    check(tiles.size() <= max_load_, "at most max_load() tiles were expected");
    while (!order_.empty() && order_.size() + tiles.size() > max_tiles_) {
        tiles_.erase(order_.front());
        order_.pop_front();
    }
    std::vector<std::optional<Result<Read>>> found(tiles.size());
    const auto read_one = [&](int i) {
        const auto index = static_cast<std::size_t>(i);
        found[index].emplace(read(tiles[index], parallel.stop));
    };
    const unsigned threads =
        std::min(thread_count(parallel.threads), thread_count(stream_->options().threads));
    if (!parallel_for(static_cast<int>(tiles.size()), read_one, {threads, parallel.stop, {}})) {
        return stopped();
    }
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        Result<Read>& read = *found[i];
        if (!read) {
            return read.error();
        }
        notes_.insert(notes_.end(), read->notes.begin(), read->notes.end());
        keep(tiles[i], std::move(read->loaded));
    }
    return {};
}

void StreamedSurface::keep(glm::ivec2 at, std::shared_ptr<const Loaded> loaded) {
    const std::uint64_t key = key_of(at);
    if (ranges_.size() >= max_ranges_) {
        ranges_.clear();
    }
    stats_.reloaded += ranges_.insert_or_assign(key, loaded->pyramid.total()).second ? 0U : 1U;
    ++stats_.loaded;
    if (!tiles_.insert_or_assign(key, std::move(loaded)).second) {
        std::erase(order_, key); // it was in memory: now it is the newest
    }
    order_.push_back(key);
    stats_.max_bytes = std::max(stats_.max_bytes, tiles_.size() * bytes_of_surface_tile);
}

namespace {

using TracedRay = std::optional<terrain::SurfaceRay>; // empty: it cannot hit

// Rays that wait for tiles.
class WaitingRays {
public:
    explicit WaitingRays(std::vector<TracedRay>& rays) : rays_(rays) {}

    // Continues rays from several threads; then each is done or waits. False if stopped.
    bool advance(const StreamedSurface& surface, std::span<const std::uint32_t> indices,
                 const ParallelOptions& parallel) {
        constexpr std::size_t chunk = 64;
        const auto chunks = static_cast<int>((indices.size() + chunk - 1) / chunk);
        const auto advance_chunk = [&](int i) {
            const std::size_t first = static_cast<std::size_t>(i) * chunk;
            for (const std::uint32_t index :
                 indices.subspan(first, std::min(chunk, indices.size() - first))) {
                rays_[index]->advance(surface);
            }
        };
        if (!parallel_for(chunks, advance_chunk, {parallel.threads, parallel.stop, {}})) {
            return false;
        }
        for (const std::uint32_t index : indices) {
            const terrain::SurfaceRay& ray = *rays_[index];
            if (ray.needed()) {
                Queue& queue = queues_[key_of(*ray.needed())];
                queue.nearest = std::min(queue.nearest, ray.t());
                queue.rays.push_back(index);
                ++count_;
            }
        }
        return true;
    }

    [[nodiscard]] std::size_t count() const { return count_; }

    struct Next {
        std::vector<glm::ivec2> tiles;
        std::vector<std::uint32_t> rays;
    };
    // Takes the tiles that the nearest rays wait for, row by row as files store them.
    Next take(std::size_t max_tiles) {
        std::vector<std::pair<double, std::uint64_t>> order;
        order.reserve(queues_.size());
        for (const auto& [key, queue] : queues_) {
            order.emplace_back(queue.nearest, key);
        }
        const std::size_t count = std::min(max_tiles, order.size());
        std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count),
                          order.end());
        order.resize(count);
        std::sort(order.begin(), order.end(),
                  [](const auto& a, const auto& b) { return a.second < b.second; });
        Next next;
        for (const auto& [nearest, key] : order) {
            const auto queue = queues_.find(key);
            next.tiles.push_back(tile_of(key));
            next.rays.insert(next.rays.end(), queue->second.rays.begin(), queue->second.rays.end());
            queues_.erase(queue);
        }
        count_ -= next.rays.size();
        return next;
    }

private:
    struct Queue {
        double nearest = std::numeric_limits<double>::infinity();
        std::vector<std::uint32_t> rays;
    };
    std::vector<TracedRay>& rays_;
    std::map<std::uint64_t, Queue> queues_;
    std::size_t count_ = 0;
};

std::vector<TracedRay> traced_rays(const StreamedSurface& surface, std::span<const Ray> rays,
                                   Interval range) {
    const Box shell = terrain::shell_around(surface);
    std::vector<TracedRay> traced(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!is_finite(rays[i])) {
            continue;
        }
        if (surface.sample_ray(rays[i])) {
            traced[i].emplace(rays[i], terrain::RayLimits{.range = range});
        } else if (const auto limits = intersect(rays[i], shell, range);
                   limits && std::isfinite(limits->end)) {
            traced[i].emplace(rays[i], terrain::RayLimits{.range = *limits});
        }
    }
    return traced;
}

} // namespace

// With its place in a queue, and the ray that it was made from.
const std::size_t bytes_per_ray = sizeof(TracedRay) + sizeof(Ray) + 2 * sizeof(std::uint32_t);

Result<std::vector<std::optional<terrain::SurfaceHit>>>
first_hits(StreamedSurface& surface, std::span<const Ray> local_rays, Interval range,
           const ParallelOptions& parallel) {
    std::vector<TracedRay> rays = traced_rays(surface, local_rays, range);
    std::vector<std::uint32_t> ready;
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
        if (rays[i]) {
            ready.push_back(i);
        }
    }
    WaitingRays waiting(rays);
    while (true) {
        if (!waiting.advance(surface, ready, parallel)) {
            return stopped();
        }
        if (parallel.progress) {
            parallel.progress(1.0 - static_cast<double>(waiting.count()) /
                                        static_cast<double>(std::max<std::size_t>(1, rays.size())));
        }
        if (waiting.count() == 0) {
            break;
        }
        WaitingRays::Next next = waiting.take(surface.max_load());
        if (auto loaded = surface.load(next.tiles, parallel); !loaded) {
            return loaded.error();
        }
        ready = std::move(next.rays);
    }
    std::vector<std::optional<terrain::SurfaceHit>> hits(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        hits[i] = rays[i] ? rays[i]->hit() : std::nullopt;
    }
    return hits;
}

Result<std::vector<double>> heights_at(StreamedSurface& surface,
                                       std::span<const glm::dvec2> samples,
                                       const ParallelOptions& parallel) {
    std::map<std::uint64_t, std::vector<std::size_t>> places;
    const auto inside = [&](glm::dvec2 sample) {
        return glm::clamp(sample, glm::dvec2(0.0), glm::dvec2(surface.last_sample()));
    };
    for (std::size_t i = 0; i < samples.size(); ++i) {
        places[key_of(surface.tile_at(inside(samples[i])))].push_back(i);
    }
    std::vector<double> heights(samples.size());
    auto next = places.begin();
    while (next != places.end()) {
        const auto first = next;
        std::vector<glm::ivec2> tiles;
        for (; next != places.end() && tiles.size() < surface.max_load(); ++next) {
            tiles.push_back(tile_of(next->first));
        }
        if (auto loaded = surface.load(tiles, parallel); !loaded) {
            return loaded.error();
        }
        for (auto place = first; place != next; ++place) {
            const terrain::SurfaceTile& tile = *surface.tile(tile_of(place->first));
            for (const std::size_t i : place->second) {
                heights[i] = terrain::bilinear_height(tile.heights,
                                                      inside(samples[i]) - glm::dvec2(tile.first));
            }
        }
    }
    return heights;
}

} // namespace reljef::truth
