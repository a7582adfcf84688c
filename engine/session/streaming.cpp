#include "engine/session/streaming.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <glm/matrix.hpp>

#include "engine/core/check.h"
#include "engine/io/imagery/imagery_set.h"
#include "engine/io/raster/raster.h"
#include "engine/io/tree_tile.h"
#include "engine/view/tile_selection.h"

namespace reljef::session {
namespace {

constexpr std::size_t part_for_triangles = 4; // of the memory

// With little memory: a quarter of those of the tiles that are enough for any view.
constexpr std::size_t min_triangles =
    scene::TileStream::min_drawn * terrain::tree_tile_cells * terrain::tree_tile_cells / 2;

std::size_t triangles_within(int megabytes) {
    const std::size_t bytes = static_cast<std::size_t>(megabytes) << 20U;
    return std::max(min_triangles, bytes / part_for_triangles / scene::bytes_per_triangle);
}

// Of a terrain that is read whole, and of a vertex at each sample.
constexpr std::size_t bytes_per_whole_sample = 24 + 40;

std::size_t vertices_within(int megabytes) {
    return (static_cast<std::size_t>(megabytes) << 20U) / bytes_per_whole_sample;
}

template <class Visit> void for_each_stream(const scene::Scene& scene, const Visit& visit) {
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4&) {
        const auto* terrain = node.get<scene::TerrainNode>();
        if (terrain != nullptr && terrain->stream != nullptr) {
            visit(*terrain->stream);
        }
    });
}

// glibc raises its threshold for mapped blocks when they are freed, up to 32 MB, and then keeps
// what large arrays leave behind. Tiles are smaller: the next ones take the place of those that are
// evicted. Each as a mapping of its own would save no memory and take a third of a flight's time.
void return_freed_arrays() {
#ifdef __GLIBC__
    constexpr int mapped_from = 1 << 22; // bytes, as in programs (app/large_pages.cpp)
    ::mallopt(M_MMAP_THRESHOLD, mapped_from);
    ::mallopt(M_TRIM_THRESHOLD, 2 * mapped_from); // glibc's proportion
#endif
}

scene::TileContent content_of(const io::TileWindow& window) {
    scene::TileContent content;
    content.bytes_read = window.bytes_read;
    content.heights = Grid<float>(window.heights.cols(), window.heights.rows());
    const auto heights = window.heights.samples();
    std::transform(heights.begin(), heights.end(), content.heights.samples().begin(),
                   [](double height) { return static_cast<float>(height); });
    content.errors = window.errors;
    return content;
}

scene::TileContent overview_content(const scene::TileBuilder& maker, terrain::TreeTile tile) {
    scene::TileContent content;
    content.heights = maker.overview_heights(tile);
    content.of_overview = true;
    return content;
}

// Replaces unreadable heights by the overview's, so that the tile's neighbours can be drawn. The
// errors become errors of the picture, which do not prevent drawing.
scene::TileContent content_or_overview(const scene::TileBuilder& maker, int reduction,
                                       terrain::TreeTile tile, scene::TileContent content) {
    if (content.errors.empty()) {
        return content;
    }
    scene::TileContent coarse = overview_content(maker, tile);
    const auto heights = coarse.heights.samples();
    coarse.is_finest = maker.step(tile) < reduction &&
                       std::none_of(heights.begin(), heights.end(),
                                    [](float height) { return std::isfinite(height); });
    coarse.bytes_read = content.bytes_read;
    coarse.notes = std::move(content.notes);
    coarse.picture_errors = std::move(content.errors);
    return coarse;
}

/// Reads the tiles of a stream.
class TileReader {
public:
    /// `proofs`: null without any. Precondition: the source is streamed.
    TileReader(const TerrainSource& source, std::shared_ptr<const ProvenTiles> proofs,
               const io::WrappedGrid& ground, scene::TileBuilder maker)
        : tiles_(*source.tiles), stream_(*source.stream), images_(source.imagery),
          proofs_(std::move(proofs)), ground_(ground), maker_(std::move(maker)) {}

    [[nodiscard]] scene::TileContent heights(terrain::TreeTile tile,
                                             const std::stop_token& stop) const {
        auto proven = proofs_ != nullptr ? proofs_->read(tile, stop) : std::nullopt;
        scene::TileContent content = proven ? std::move(*proven) : unproven(tile, stop);
        content.notes = tiles_.take_new_notes();
        if (!stop.stop_requested()) {
            content = content_or_overview(maker_, stream_.plan.reduction, tile, std::move(content));
        }
        content.ends_proofs = proofs_ != nullptr && proofs_->is_wrong();
        if (auto error = content.ends_proofs ? proofs_->take_error() : std::nullopt) {
            (content.errors.empty() ? content.picture_errors : content.errors)
                .push_back(std::move(*error));
        }
        return content;
    }

    [[nodiscard]] scene::TileContent with_picture(terrain::TreeTile tile,
                                                  const std::stop_token& stop) const {
        scene::TileContent content = heights(tile, stop);
        if (images_ && content.errors.empty() && !stop.stop_requested()) {
            add_picture(tile, stop, content);
        }
        return content;
    }

    /// How often files were found changed.
    [[nodiscard]] std::uint64_t changes() const {
        return tiles_.changes() + (images_ ? images_->changes() : 0);
    }

private:
    [[nodiscard]] scene::TileContent unproven(terrain::TreeTile tile,
                                              const std::stop_token& stop) const {
        return stream_.step_of_overview > 0 && maker_.step(tile) >= stream_.step_of_overview
                   ? overview_content(maker_, tile)
                   : content_of(io::read_tree_tile(tiles_, ground_, maker_.tree(), tile,
                                                   stream_.gaps, stop));
    }

    void add_picture(terrain::TreeTile tile, const std::stop_token& stop,
                     scene::TileContent& content) const {
        const glm::ivec2 cells = maker_.tree().cells(tile);
        const io::TileGrid grid =
            io::picture_grid(ground_.grid, tile, cells, maker_.picture_size(tile));
        io::ImageryWindow window = images_->read(io::texels_at(grid), {.stop = stop});
        io::wrap_picture(window.texels, maker_.rows(), maker_.first(tile).y,
                         cells.y * maker_.step(tile));
        content.picture = {std::move(window.texels), window.whole, window.has_more};
        content.picture_errors.insert(content.picture_errors.end(), window.errors.begin(),
                                      window.errors.end());
        const std::vector<std::string> notes = images_->take_new_notes();
        content.notes.insert(content.notes.end(), notes.begin(), notes.end());
    }

    io::TileSet tiles_;
    StreamSource stream_;
    std::shared_ptr<const io::ImagerySet> images_;
    std::shared_ptr<const ProvenTiles> proofs_;
    io::WrappedGrid ground_;
    scene::TileBuilder maker_;
};

void log_errors(scene::TileStream& stream, Log& log) {
    for (const std::string& error : stream.take_errors()) {
        log.message(MessageKind::shown_coarser, error);
    }
    for (const std::string& note : stream.take_notes()) {
        log.note(note);
    }
}

void wait_and_log(scene::TileStream& stream, Log& log, const std::stop_token& stop) {
    constexpr std::chrono::milliseconds between_logs{500};
    bool is_there = false;
    while (!is_there && !stop.stop_requested()) {
        is_there = stream.wait_for(stop, between_logs);
        log_errors(stream, log);
    }
}

int readings_of(const scene::Scene& scene) {
    int readings = 0;
    for (const scene::TileStreamStats& stats : stream_stats(scene)) {
        readings += stats.read + stats.failed;
    }
    return readings;
}

std::optional<ExpectedError> expected_of(const scene::Technique& technique) {
    if (technique.id() == scene::TechniqueId::exact) {
        return ExpectedError{scene::max_expected_error_of_rays, false};
    }
    const double bound = scene::error_bound(technique);
    return bound > 0.0 ? std::optional(ExpectedError{bound, true}) : std::nullopt;
}

// From the file; for voids and after errors the mean of the overview's row.
double pole_height(const io::HeightSample& answer, const Grid<float>& overview, int row) {
    const auto values = overview.row(row);
    return answer.kind == io::HeightSample::Kind::height
               ? answer.height
               : std::accumulate(values.begin(), values.end(), 0.0) /
                     static_cast<double>(values.size());
}

io::WrappedGrid ground_of(const io::TileSet& tiles, const StreamSource& stream,
                          const Grid<float>& overview) {
    io::WrappedGrid ground =
        io::wrapped_grid(stream.plan.grid, tiles.wrap(stream.plan.grid), stream.imagery.refinement);
    if (ground.wrap.rows() > 0) {
        const auto poles = tiles.heights(std::array{glm::dvec2(90.0, 0.0), glm::dvec2(-90.0, 0.0)});
        ground.north_height = pole_height(poles.answers[0], overview, 0);
        ground.south_height = pole_height(poles.answers[1], overview, overview.rows() - 1);
    }
    return ground;
}

} // namespace

std::shared_ptr<scene::TileStream>
make_stream(const TerrainSource& source, std::shared_ptr<const scene::TerrainSurface> overview) {
    if (!source.stream || !source.tiles) {
        return nullptr;
    }
    return_freed_arrays();
    std::vector<std::string> reported = overview->terrain().errors;
    const scene::ImageryDetail imagery = source.stream->imagery;
    const io::WrappedGrid ground =
        ground_of(*source.tiles, *source.stream, overview->heightfield().heights);
    const bool is_curved = overview->placement().kind() == terrain::PlacementKind::ellipsoid;
    const terrain::TileTree tree(ground.grid.cols, ground.grid.rows,
                                 {.around = ground.wrap.around && is_curved});
    scene::TileBuilder maker(std::move(overview), tree, source.stream->plan.reduction, imagery,
                             ground.wrap);
    const auto proofs = source.proofs;
    const TileReader reader(source, proofs, ground, maker);
    scene::TileStreamOptions options;
    options.memory_budget = source.stream->memory_budget;
    options.threads = source.stream->threads;
    options.read_heights = [reader](terrain::TreeTile tile, const std::stop_token& stop) {
        return reader.heights(tile, stop);
    };
    options.reported = std::move(reported);
    options.source_changes = [reader] { return reader.changes(); };
    if (proofs != nullptr) {
        options.is_all_proven = proofs->is_complete();
        options.find_proof = [proofs](terrain::TreeTile tile) { return proofs->find(tile); };
    }
    const auto read = [reader](terrain::TreeTile tile, const std::stop_token& stop) {
        return reader.with_picture(tile, stop);
    };
    return std::make_shared<scene::TileStream>(std::move(maker), read, options);
}

void set_stream_and_limits(scene::TerrainNode& shown, const TerrainSource& source, int megabytes) {
    shown.stream = make_stream(source, shown.surface);
    shown.max_triangles = triangles_within(megabytes);
    shown.max_vertices = vertices_within(megabytes);
}

void request_tiles(std::span<const view::TileRequests> requests) {
    struct Merged {
        std::vector<terrain::TreeTile> missing;
        std::set<terrain::TreeTile> known; // of the missing
        std::vector<terrain::TreeTile> used;
        bool with_cones = false;
    };
    std::map<scene::TileStream*, Merged> merged;
    for (const view::TileRequests& request : requests) {
        Merged& all = merged[request.stream.get()];
        std::copy_if(request.missing.begin(), request.missing.end(),
                     std::back_inserter(all.missing),
                     [&](terrain::TreeTile tile) { return all.known.insert(tile).second; });
        all.used.insert(all.used.end(), request.used.begin(), request.used.end());
        all.with_cones = all.with_cones || request.with_cones;
    }
    for (const auto& [stream, all] : merged) {
        stream->request(all.missing, all.used, all.with_cones);
    }
}

void wait_for_tiles(const scene::Scene& scene, glm::ivec2 size, view::FrameSelector& selector,
                    Log& log, const std::stop_token& stop) {
    std::optional<int> before;
    while (true) {
        const int readings = readings_of(scene); // before the requests, which may finish at once
        const view::FrameView& frame = selector.select(scene, size);
        request_tiles(frame.requests);
        const bool is_whole = std::all_of(
            frame.requests.begin(), frame.requests.end(), [](const view::TileRequests& request) {
                return request.missing.empty() && !request.stream->has_outdated();
            });
        if (is_whole || readings == before || stop.stop_requested()) {
            return;
        }
        before = readings;
        for (const view::TileRequests& request : frame.requests) {
            wait_and_log(*request.stream, log, stop);
        }
    }
}

void wait_for_ground_below_eye(const scene::Scene& scene, const std::stop_token& stop) {
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4& matrix) {
        const auto* terrain = node.get<scene::TerrainNode>();
        if (terrain == nullptr || terrain->stream == nullptr) {
            return;
        }
        const glm::dvec3 eye(glm::inverse(matrix) * glm::dvec4(scene.camera().eye, 1.0));
        const auto sample = terrain->surface->placement().sample_from_world(eye);
        if (sample) {
            scene::TileStream& stream = *terrain->stream;
            const scene::TileBuilder& builder = stream.maker();
            const std::array below{builder.tile_at(builder.level_of_samples(),
                                                   builder.from_overview(glm::dvec2(*sample)))};
            stream.request(below);
            stream.wait(stop);
        }
    });
}

std::optional<ExpectedError> expected_error(const scene::Scene& scene) {
    std::optional<ExpectedError> smallest;
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4& /*matrix*/) {
        const auto* terrain = node.get<scene::TerrainNode>();
        const auto expected =
            terrain != nullptr ? expected_of(terrain->material.technique) : std::nullopt;
        if (expected && (!smallest || expected->pixels < smallest->pixels)) {
            smallest = expected;
        }
    });
    return smallest;
}

MemoryForBound memory_for_bound(const scene::Scene& scene, glm::ivec2 size) {
    MemoryForBound needed;
    std::size_t whole = 0; // bytes
    bool has_images = false;
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4& matrix) {
        const auto* terrain = node.get<scene::TerrainNode>();
        if (terrain == nullptr || terrain->stream == nullptr ||
            !expected_of(terrain->material.technique)) {
            return;
        }
        const scene::TileStream& stream = *terrain->stream;
        const std::size_t tiles = view::tiles_for_bound(*terrain, scene.camera(), size, matrix);
        needed.growth =
            std::max(needed.growth, static_cast<double>(stream.budget_for(tiles)) /
                                        static_cast<double>(stream.options().memory_budget));
        needed.is_enough = needed.is_enough && tiles < view::max_tiles_counted;
        has_images = has_images || stream.maker().has_images();
        whole =
            std::max(whole, io::bytes_per_sample * static_cast<std::size_t>(stream.tree().cols()) *
                                static_cast<std::size_t>(stream.tree().rows()));
    });
    if (whole > 0 && !has_images) {
        constexpr int largest = 1 << 30;
        needed.whole_megabytes =
            clamped_int(std::ceil(static_cast<double>(whole) / (1U << 20U)), 1, largest);
    }
    return needed;
}

int megabytes_for_every_sample(const scene::Scene& scene) {
    std::size_t bytes = 0;
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4& /*matrix*/) {
        const auto* terrain = node.get<scene::TerrainNode>();
        const bool draws_fewer = terrain != nullptr &&
                                 scene::error_bound(terrain->material.technique) == 0.0 &&
                                 scene::triangle_bound(*terrain, terrain->material.technique) > 0.0;
        bytes += draws_fewer
                     ? bytes_per_whole_sample * terrain->surface->heightfield().heights.size()
                     : 0;
    });
    return static_cast<int>(bytes >> 20U) + (bytes > 0 ? 1 : 0);
}

int megabytes_for_triangles(std::size_t triangles) {
    return static_cast<int>((triangles * scene::bytes_per_triangle * part_for_triangles) >> 20U) +
           1;
}

std::optional<int> megabytes_for_all_samples(const scene::Scene& scene) {
    double largest = 0.0; // bytes
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4& /*matrix*/) {
        const auto* terrain = node.get<scene::TerrainNode>();
        if (terrain == nullptr || terrain->stream != nullptr ||
            terrain->surface->has_all_samples()) {
            return;
        }
        const terrain::Heightfield& read = terrain->surface->heightfield();
        // Rows and columns that fill no average are left out.
        const double samples = (read.heights.cols() + 1.0) * (read.heights.rows() + 1.0) *
                               read.reduction * read.reduction;
        largest = std::max(largest, static_cast<double>(io::bytes_per_sample) * samples);
    });
    return largest > 0.0 ? std::optional(clamped_int(std::ceil(largest / (1U << 20U)), 1, 1 << 30))
                         : std::nullopt;
}

scene::Camera camera_ahead(const scene::Camera& before, const scene::Camera& now, double seconds,
                           double ahead) {
    scene::Camera later = now;
    if (seconds > 0.0) {
        const glm::dvec3 way = (now.eye - before.eye) * (ahead / seconds);
        later.eye += way;
        later.target += way;
    }
    return later;
}

bool load_view(const scene::Scene& scene, scene::TerrainNode& terrain, const StreamedSurface& next,
               glm::ivec2 size) {
    const StreamedSurface shown{std::exchange(terrain.surface, next.surface),
                                std::exchange(terrain.stream, next.stream)};
    const std::vector<view::TileRequests> requests =
        view::tile_requests(scene, scene.camera(), size);
    terrain.surface = shown.surface;
    terrain.stream = shown.stream;
    request_tiles(requests);
    return std::all_of(requests.begin(), requests.end(), [](const view::TileRequests& request) {
        return std::all_of(
            request.missing.begin(), request.missing.end(),
            [&](terrain::TreeTile tile) { return request.stream->has_given_up(tile); });
    });
}

bool take_arrivals(const scene::Scene& scene) {
    bool has_arrivals = false;
    for_each_stream(scene, [&](scene::TileStream& stream) {
        has_arrivals = stream.take_arrivals() || has_arrivals;
    });
    return has_arrivals;
}

bool awaits_tiles(const scene::Scene& scene) {
    bool busy = false;
    for_each_stream(scene, [&](scene::TileStream& stream) { busy = stream.is_busy() || busy; });
    return busy;
}

void log_stream_errors(const scene::Scene& scene, Log& log) {
    for_each_stream(scene, [&](scene::TileStream& stream) { log_errors(stream, log); });
}

std::size_t failed_files(const scene::Scene& scene) {
    std::size_t count = 0;
    for_each_stream(scene, [&](scene::TileStream& stream) { count += stream.failed_files(); });
    return count;
}

const char* why_unproven(const std::vector<scene::TileStreamStats>& streams) {
    const bool is_indexed =
        !streams.empty() &&
        std::ranges::all_of(streams, [](const auto& stream) { return stream.is_all_proven; });
    return is_indexed ? "files or their index cannot be read" : "'reljef index' proves them";
}

std::vector<scene::TileStreamStats> stream_stats(const scene::Scene& scene) {
    std::vector<scene::TileStreamStats> stats;
    for_each_stream(scene, [&](scene::TileStream& stream) { stats.push_back(stream.stats()); });
    return stats;
}

} // namespace reljef::session
