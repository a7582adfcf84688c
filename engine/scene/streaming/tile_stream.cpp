#include "engine/scene/streaming/tile_stream.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <system_error>
#include <utility>

#include <glm/common.hpp>

#include "engine/core/parallel_for.h"

namespace reljef::scene {
namespace {

std::size_t texels_shown(const Image& texels) {
    const auto samples = texels.samples();
    return static_cast<std::size_t>(
        std::count_if(samples.begin(), samples.end(), [](Rgba8 texel) { return texel.a != 0; }));
}

constexpr const char* no_memory = "tiles cannot be made: there is not enough memory";

// A thread that does not catch std::bad_alloc ends the process.
template <class Call> bool has_memory_for(const Call& call) {
    try {
        call();
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

} // namespace

TileStream::TileStream(TileBuilder maker, TileContentReader read, const TileStreamOptions& options)
    : maker_(std::move(maker)), read_(std::move(read)), options_(options),
      has_proofs_(options.find_proof != nullptr) {
    const unsigned count = thread_count(options.threads);
    for (unsigned i = 0; i < count; ++i) {
        try {
            threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
        } catch (const std::system_error&) {
            check(i > 0, "a thread to read tiles was expected");
            return; // the running threads do all the work
        }
    }
}

TileStream::~TileStream() {
    {
        const std::lock_guard lock(mutex_);
        requested_.clear();
        for (auto& [tile, source] : in_flight_) {
            source.request_stop();
        }
    }
    for (std::jthread& thread : threads_) {
        thread.request_stop();
    }
}

std::shared_ptr<const TerrainTile> TileStream::find(terrain::TreeTile tile) const {
    const std::lock_guard lock(mutex_);
    const auto found = tiles_.find(tile);
    return found != tiles_.end() ? found->second.made.tile : nullptr;
}

std::optional<TileSummary> TileStream::recall(terrain::TreeTile tile) const {
    const std::lock_guard lock(mutex_);
    if (const auto found = tiles_.find(tile); found != tiles_.end()) {
        return *found->second.made.tile;
    }
    if (const auto found = remembered_.find(tile); found != remembered_.end()) {
        return found->second;
    }
    const auto proof = has_proofs_ ? options_.find_proof(tile) : std::nullopt;
    if (!proof) {
        return std::nullopt;
    }
    const TileSummary summary = maker_.summary(tile, *proof);
    remember(summary);
    return summary;
}

std::optional<TileStream::Found> TileStream::finest_at(glm::dvec2 overview_sample) const {
    const glm::dvec2 last(tree().cols() - 1, tree().rows() - 1);
    glm::dvec2 sample = maker_.tree_sample(maker_.from_overview(overview_sample));
    if (tree().wraps_longitude() && (sample.x < 0.0 || sample.x > last.x)) {
        sample.x -= last.x * std::floor(sample.x / last.x);
    }
    sample = glm::clamp(sample, glm::dvec2(0.0), last);
    // At a border only one of the tiles may be there, and rounding decides on which side a place
    // is.
    constexpr double border = 0x1p-20; // samples
    const std::lock_guard lock(mutex_);
    for (int level = 0; level <= tree().root().level; ++level) {
        const int side = terrain::tree_tile_cells << level;
        for (const glm::dvec2 aside : {glm::dvec2(1.0), {-1.0, 1.0}, {1.0, -1.0}, {-1.0, -1.0}}) {
            const glm::dvec2 place =
                glm::clamp(sample + border * aside, glm::dvec2(0.0), last - 0.5);
            const glm::ivec2 at = glm::ivec2(place) / side;
            const auto found = tiles_.find({level, at.x, at.y});
            if (found != tiles_.end()) {
                const glm::dvec2 from_first =
                    sample - glm::dvec2(terrain::TileTree::first(found->first));
                return Found{found->second.made.tile,
                             from_first /
                                 static_cast<double>(terrain::TileTree::step(found->first))};
            }
        }
    }
    return std::nullopt;
}

std::vector<std::shared_ptr<const TerrainTile>> TileStream::loaded() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::shared_ptr<const TerrainTile>> tiles;
    for (const auto& [id, entry] : tiles_) {
        tiles.push_back(entry.made.tile);
    }
    return tiles;
}

void TileStream::request(std::span<const terrain::TreeTile> missing,
                         std::span<const terrain::TreeTile> used, bool with_cones) {
    {
        const std::lock_guard lock(mutex_);
        ++view_;
        with_cones_ = with_cones;
        for (const terrain::TreeTile tile : used) {
            if (const auto found = tiles_.find(tile); found != tiles_.end()) {
                found->second.used = view_;
            }
        }
        std::vector<terrain::TreeTile> requests = requests_for(missing);
        const std::set<terrain::TreeTile> now(requests.begin(), requests.end());
        for (const terrain::TreeTile& tile : requested_) {
            stats_.cancelled += now.contains(tile) || in_flight_.contains(tile) ? 0 : 1;
        }
        for (auto& [tile, source] : in_flight_) {
            if (!now.contains(tile)) {
                source.request_stop();
            }
        }
        requested_ = std::move(requests);
        evict();
    }
    changed_.notify_all();
}

// The tiles that are not loaded, and the loaded tiles in use whose picture is incomplete or that
// are outdated.
std::vector<terrain::TreeTile>
TileStream::requests_for(std::span<const terrain::TreeTile> tiles) const {
    std::vector<terrain::TreeTile> requests(tiles.begin(), tiles.end());
    std::erase_if(requests, [&](terrain::TreeTile tile) {
        return tiles_.contains(tile) && !failures_.contains(tile) && !lacks_cones(tile) &&
               !is_outdated(tile);
    });
    const std::set<terrain::TreeTile> known(requests.begin(), requests.end());
    for (const auto& [tile, entry] : tiles_) {
        const bool is_to_read = failures_.contains(tile) || is_outdated(tile);
        if (is_in_use(entry) && is_to_read && !known.contains(tile)) {
            requests.push_back(tile);
        }
    }
    return requests;
}

// Whether a loaded tile lacks what the view needs.
bool TileStream::lacks_cones(terrain::TreeTile tile) const {
    const auto entry = tiles_.find(tile);
    return with_cones_ && entry != tiles_.end() && entry->second.made.tile->cones == nullptr;
}

bool TileStream::is_settled() const {
    return std::all_of(requested_.begin(), requested_.end(),
                       [&](terrain::TreeTile tile) { return has_failed_for_good(tile); });
}

bool TileStream::has_failed_for_good(terrain::TreeTile tile) const {
    const auto failure = failures_.find(tile);
    return failure != failures_.end() && failure->second.latest.has_failed_for_good();
}

bool TileStream::wait(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, stop, [&] { return is_settled(); });
    return !stop.stop_requested();
}

bool TileStream::wait_for(const std::stop_token& stop, std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, stop, longest, [&] { return is_settled(); });
}

bool TileStream::has_given_up(terrain::TreeTile tile) const {
    const std::lock_guard lock(mutex_);
    return has_failed_for_good(tile) && !tiles_.contains(tile);
}

std::uint64_t TileStream::revision() const {
    const std::lock_guard lock(mutex_);
    return revision_;
}

bool TileStream::take_arrivals() {
    const std::lock_guard lock(mutex_);
    return std::exchange(has_arrivals_, false);
}

bool TileStream::is_busy() const {
    const std::lock_guard lock(mutex_);
    return !is_settled();
}

std::vector<std::string> TileStream::take_errors() {
    const std::lock_guard lock(mutex_);
    return std::exchange(new_errors_, {});
}

std::vector<std::string> TileStream::take_notes() {
    const std::lock_guard lock(mutex_);
    return std::exchange(new_notes_, {});
}

std::size_t TileStream::failed_files() const {
    const std::lock_guard lock(mutex_);
    return failed_files_.size();
}

TileStreamStats TileStream::stats() const {
    const std::lock_guard lock(mutex_);
    TileStreamStats stats = stats_;
    stats.tiles = tiles_.size();
    stats.is_all_proven = has_proofs_ && options_.is_all_proven;
    return stats;
}

// The most urgent tile that no thread reads and that does not pause.
std::optional<terrain::TreeTile> TileStream::next_tile(Clock::time_point now) {
    for (const terrain::TreeTile tile : requested_) {
        const auto failure = failures_.find(tile);
        const bool pauses = failure != failures_.end() && now < failure->second.latest.again();
        if (!pauses && !in_flight_.contains(tile)) {
            return tile;
        }
    }
    return std::nullopt;
}

std::optional<TileStream::Clock::time_point> TileStream::next_attempt() const {
    std::optional<Clock::time_point> first;
    for (const terrain::TreeTile tile : requested_) {
        const auto failure = failures_.find(tile);
        if (failure != failures_.end() && !in_flight_.contains(tile)) {
            const Clock::time_point again = failure->second.latest.again();
            first = std::min(again, first.value_or(again));
        }
    }
    return first;
}

void TileStream::work(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        const auto tile = next_tile(Clock::now());
        if (!tile) {
            const auto again = next_attempt();
            const auto ready = [&] { return next_tile(Clock::now()) || next_attempt() != again; };
            if (again) {
                changed_.wait_until(lock, stop, *again, ready);
            } else {
                changed_.wait(lock, stop, ready);
            }
            continue;
        }
        if (!has_memory_for([&] { load(*tile, lock); })) { // as a file that cannot be read
            if (!lock.owns_lock()) {
                lock.lock();
            }
            in_flight_.erase(*tile);
            has_memory_for([&] { note_failure(*tile, std::array{FileError{"tiles", no_memory}}); });
        }
        changed_.notify_all();
    }
}

// Precondition: locked; unlocks while it reads.
void TileStream::load(terrain::TreeTile tile, std::unique_lock<std::mutex>& lock) {
    const std::stop_token cancelled = in_flight_[tile].get_token();
    const auto entry = tiles_.find(tile);
    const Made before = entry != tiles_.end() && !is_outdated(tile) ? entry->second.made : Made{};
    const std::uint64_t changes = changes_of_source();
    const bool is_read = before.tile != nullptr && !failures_.contains(tile);
    const bool with_cones = with_cones_;
    lock.unlock();
    TileContent content = is_read ? TileContent{} : read_(tile, cancelled);
    const bool stopped = cancelled.stop_requested();
    Made made = is_read ? before : Made{};
    if (!is_read && !stopped && content.errors.empty()) {
        made = make(tile, content, before);
        made.changes = changes;
    }
    if (with_cones && !stopped) {
        made = with_cones_over(made.tile != nullptr ? made : before);
    }
    lock.lock();
    note_changes();
    note_cones(made);
    finish(tile, content, std::move(made), stopped);
}

TileStream::Made TileStream::make(terrain::TreeTile tile, TileContent& content,
                                  const Made& before) const {
    TerrainTile made =
        maker_.make(tile, std::move(content.heights), content.picture, std::move(content.was_void));
    made.of_overview = content.of_overview;
    made.is_finest = content.is_finest;
    if (content.of_overview) {
        made.error = std::max(made.error, maker_.overview_error(tile));
    }
    const auto proof =
        content.is_proven && options_.find_proof ? options_.find_proof(tile) : std::nullopt;
    if (proof) {
        const double coarse_texel = made.coarse_texel;
        static_cast<TileSummary&>(made) = maker_.summary(tile, *proof);
        made.coarse_texel = coarse_texel;
        made.parts = content.parts;
    }
    Made now{std::make_shared<const TerrainTile>(std::move(made)),
             texels_shown(content.picture.texels)};
    return before.tile == nullptr
               ? now
               : better_of(before, std::move(now), content.picture_errors.empty());
}

TileStream::Made TileStream::with_cones_over(Made made) {
    if (made.tile == nullptr || made.tile->cones != nullptr) {
        return made;
    }
    TerrainTile tile = *made.tile;
    ParallelOptions alone; // other threads make other tiles
    alone.threads = 1;
    const Grid<float> unit = terrain::unit_heights(tile.heightfield.heights.view());
    tile.cones =
        std::make_shared<const material::ConeMaps>(*material::cone_maps(unit.view(), alone));
    made.tile = std::make_shared<const TerrainTile>(std::move(tile));
    return made;
}

void TileStream::note_cones(const Made& made) {
    if (made.tile != nullptr && made.tile->cones != nullptr && !has_noted_cones_) {
        has_noted_cones_ = true;
        new_notes_.emplace_back("the cones of a tile are made when it is first seen; a moving view "
                                "shows coarser tiles until then");
    }
}

// Keeps the old heights, because its neighbours' borders lie on them, unless they are the
// overview's. Of two incomplete pictures the one with more texels wins.
TileStream::Made TileStream::better_of(const Made& before, Made now, bool has_whole_picture) {
    const bool heights_recovered = before.tile->of_overview && !now.tile->of_overview;
    const bool shows_more = has_whole_picture || now.shown > before.shown;
    if (heights_recovered == shows_more) {
        return shows_more ? now : before;
    }
    const Made& with_picture = shows_more ? now : before;
    TerrainTile tile = heights_recovered ? *now.tile : *before.tile;
    tile.albedo = with_picture.tile->albedo;
    tile.coarse_texel = with_picture.tile->coarse_texel;
    return {std::make_shared<const TerrainTile>(std::move(tile)), with_picture.shown};
}

void TileStream::finish(terrain::TreeTile tile, const TileContent& content, Made made,
                        bool stopped) {
    in_flight_.erase(tile);
    if (content.ends_proofs && has_proofs_) {
        drop_proofs();
    }
    stats_.bytes_read += content.bytes_read;
    new_notes_.insert(new_notes_.end(), content.notes.begin(), content.notes.end());
    if (stopped) {
        ++stats_.cancelled;
        record_errors(content.picture_errors);
        return;
    }
    if (made.tile == nullptr) {
        note_failure(tile, content.errors);
        return;
    }
    if (made.tile->is_proven && !has_proofs_) {
        return; // made before the proofs ended: is read again
    }
    const auto before = tiles_.find(tile);
    if (before == tiles_.end() || before->second.made.tile != made.tile) {
        keep(tile, std::move(made)); // before the request ends, which needs no memory
    }
    const auto& errors = content.errors.empty() ? content.picture_errors : content.errors;
    if (errors.empty()) {
        forget_failure(tile);
        std::erase(requested_, tile);
    } else {
        note_failure(tile, errors);
    }
}

} // namespace reljef::scene
