// Which tiles a stream keeps, and until when.
#include "engine/scene/streaming/tile_stream.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace reljef::scene {
namespace {

// The drawn tiles' share of memory. The rest is for their ancestors, a third as many, and for tiles
// that are read ahead.
constexpr double drawn_share = 0.6;

std::size_t drawn_within(std::size_t memory_budget, std::size_t bytes_per_tile) {
    return static_cast<std::size_t>(drawn_share * static_cast<double>(memory_budget) /
                                    static_cast<double>(bytes_per_tile));
}

// Summaries of evicted tiles: a 64th of the budget, or enough for a view of min_drawn tiles.
std::size_t max_remembered(std::size_t memory_budget) {
    constexpr std::size_t bytes_of_node = 48; // of a map, about
    constexpr std::size_t bytes =
        sizeof(TileSummary) + 2 * sizeof(terrain::TreeTile) + bytes_of_node;
    return std::max(64 * TileStream::min_drawn, memory_budget / 64 / bytes);
}

} // namespace

std::size_t TileStream::max_drawn() const {
    return std::max(min_drawn, drawn_within(options_.memory_budget, maker_.bytes_per_tile()));
}

std::size_t TileStream::budget_for(std::size_t drawn_tiles) const {
    return static_cast<std::size_t>(
        std::ceil(static_cast<double>(drawn_tiles * maker_.bytes_per_tile()) / drawn_share));
}

int TileStream::texels_within(std::size_t memory_budget) {
    int texels = max_texels_per_cell;
    while (texels > 1 && drawn_within(memory_budget, bytes_of_tile(texels)) < min_drawn) {
        texels /= 2;
    }
    return texels;
}

bool TileStream::is_outdated(terrain::TreeTile tile) const {
    const auto entry = tiles_.find(tile);
    return entry != tiles_.end() && entry->second.made.changes < changes_;
}

bool TileStream::has_outdated() const {
    const std::lock_guard lock(mutex_);
    return std::any_of(tiles_.begin(), tiles_.end(), [&](const auto& entry) {
        return is_in_use(entry.second) && is_outdated(entry.first) &&
               !failures_.contains(entry.first);
    });
}

void TileStream::drop_proofs() {
    has_proofs_ = false;
    remembered_.clear();
    remembered_order_.clear();
    ++revision_;
    for (auto entry = tiles_.begin(); entry != tiles_.end();) {
        const TerrainTile& tile = *entry->second.made.tile;
        stats_.bytes -= tile.is_proven ? tile.bytes() : 0;
        entry = tile.is_proven ? tiles_.erase(entry) : std::next(entry);
    }
}

std::uint64_t TileStream::changes_of_source() const {
    return options_.source_changes ? options_.source_changes() : 0;
}

// Outdated tiles of this view are shown until they are read again.
void TileStream::note_changes() {
    const std::uint64_t now = changes_of_source();
    if (now == changes_) {
        return;
    }
    changes_ = now;
    remembered_.clear();
    remembered_order_.clear();
    has_arrivals_ = true; // to be requested again
    ++revision_;
    for (auto entry = tiles_.begin(); entry != tiles_.end();) {
        const bool stays = is_in_use(entry->second) || !is_outdated(entry->first);
        stats_.bytes -= stays ? 0 : entry->second.made.tile->bytes();
        entry = stays ? std::next(entry) : tiles_.erase(entry);
    }
}

void TileStream::keep(terrain::TreeTile tile, Made made) {
    Entry& entry = tiles_[tile];
    const TerrainTile* before = entry.made.tile.get();
    stats_.read += before == nullptr || entry.made.changes < made.changes ? 1 : 0;
    stats_.bytes += made.tile->bytes() - (before != nullptr ? before->bytes() : 0);
    entry = {std::move(made), view_};
    has_arrivals_ = true;
    ++revision_;
    evict();
    stats_.max_bytes = std::max(stats_.max_bytes, stats_.bytes);
}

// Keeps the tiles of this view.
void TileStream::evict() {
    while (stats_.bytes > options_.memory_budget) {
        const auto oldest =
            std::min_element(tiles_.begin(), tiles_.end(), [](const auto& a, const auto& b) {
                return a.second.used < b.second.used;
            });
        if (oldest->second.used >= view_) {
            return;
        }
        remember(*oldest->second.made.tile);
        stats_.bytes -= oldest->second.made.tile->bytes();
        ++stats_.evicted;
        ++revision_;
        tiles_.erase(oldest);
    }
}

void TileStream::remember(const TileSummary& tile) const {
    if (remembered_.insert_or_assign(tile.id, tile).second) {
        remembered_order_.push_back(tile.id);
    }
    while (remembered_.size() > max_remembered(options_.memory_budget)) {
        remembered_.erase(remembered_order_.front());
        remembered_order_.pop_front();
    }
}

} // namespace reljef::scene
