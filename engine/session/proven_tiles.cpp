#include "engine/session/proven_tiles.h"

#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

namespace reljef::session {
namespace {

/// Bilinear. Precondition: the place is not negative.
float height_between(const Grid<float>& samples, glm::dvec2 place) {
    const glm::ivec2 low(place);
    const glm::dvec2 part = place - glm::dvec2(low);
    double sum = 0.0;
    for (const glm::ivec2 corner : {glm::ivec2(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
        const glm::dvec2 along = glm::mix(1.0 - part, part, glm::dvec2(corner));
        const double share = along.x * along.y;
        sum += share > 0.0 ? share * samples.clamped(low.x + corner.x, low.y + corner.y) : 0.0;
    }
    return static_cast<float>(sum);
}

bool is_possible(const terrain::TileProof& proof) {
    const bool is_empty = proof.low > proof.high;
    return std::isfinite(proof.error) && proof.error >= 0.0F &&
           (is_empty ? proof.has_voids : std::isfinite(proof.low) && std::isfinite(proof.high));
}

/// Whether a tile can have the proof if its parent has the other one.
bool agrees(const terrain::TileProof& proof, const terrain::TileProof& parent) {
    const bool is_empty = proof.low > proof.high;
    return (is_empty || (proof.low >= parent.low && proof.high <= parent.high)) &&
           (!proof.has_voids || parent.has_voids);
}

} // namespace

ProvenTiles::ProvenTiles(io::IndexSource source, io::ErrorIndex index, int refinement)
    : source_(std::move(source)), index_(std::move(index)), tiles_(source_, index_),
      level_of_samples_(std::countr_zero(static_cast<unsigned>(refinement))) {}

terrain::TreeTile ProvenTiles::indexed(terrain::TreeTile tile) const {
    const int finer = std::max(0, level_of_samples_ - tile.level);
    return {std::max(0, tile.level - level_of_samples_), tile.col >> finer, tile.row >> finer};
}

bool ProvenTiles::may_be_proven(terrain::TreeTile at) const {
    const auto proof = is_wrong_ ? std::nullopt : index_.find(at);
    if (!proof) {
        return false;
    }
    const auto parent = index_.find({at.level + 1, at.col / 2, at.row / 2});
    if (!is_possible(*proof) || (parent && !agrees(*proof, *parent))) {
        contradict(fmt::format("{}: tile ({},{}) of level {}: found heights beyond those of the "
                               "coarser tile, heights within them were expected",
                               source_.file.string(), at.col, at.row, at.level));
        return false;
    }
    return true;
}

std::optional<terrain::TileProof> ProvenTiles::find(terrain::TreeTile tile) const {
    const terrain::TreeTile at = indexed(tile);
    const auto proof = may_be_proven(at) ? tiles_.proof(at) : std::nullopt;
    return proof && is_possible(*proof) ? proof : std::nullopt;
}

void ProvenTiles::contradict(const std::string& error) const {
    if (!is_wrong_.exchange(true)) {
        const std::lock_guard lock(mutex_);
        error_ = {source_.file, error};
    }
}

std::optional<scene::TileContent> ProvenTiles::read(terrain::TreeTile tile,
                                                    const std::stop_token& stop) const {
    if (!may_be_proven(indexed(tile))) {
        return std::nullopt;
    }
    auto found = tiles_.read(indexed(tile), stop);
    if (!found) {
        return std::nullopt;
    }
    const bool is_contradiction =
        !found->errors.empty() && found->errors.front().file == source_.file;
    if (is_contradiction && !stop.stop_requested()) { // a stopped read has no samples
        contradict(found->errors.front().message);
        return std::nullopt;
    }
    scene::TileContent content;
    content.bytes_read = found->bytes_read;
    content.is_proven = found->errors.empty() && found->proof.has_value();
    if (content.is_proven && tile.level >= level_of_samples_) {
        content.parts = found->parts;
    }
    content.errors = found->errors;
    scene::FilledHeights shown =
        tile.level < level_of_samples_
            ? part(tile, found->heights, found->was_void)
            : scene::FilledHeights{std::move(found->heights), std::move(found->was_void)};
    content.heights = std::move(shown.heights);
    content.was_void = std::move(shown.was_void);
    return content;
}

std::optional<FileError> ProvenTiles::take_error() const {
    const std::lock_guard lock(mutex_);
    return std::exchange(error_, std::nullopt);
}

scene::FilledHeights ProvenTiles::part(terrain::TreeTile tile, const Grid<float>& samples,
                                       const Grid<std::uint8_t>& was_void) const {
    const int cells_of_sample = 1 << (level_of_samples_ - tile.level);
    const glm::ivec2 cells = (glm::ivec2(samples.cols(), samples.rows()) - 3) * cells_of_sample;
    const glm::ivec2 first = glm::ivec2(tile.col % cells_of_sample, tile.row % cells_of_sample) *
                             terrain::tree_tile_cells;
    const glm::ivec2 count =
        glm::min(cells - first, glm::ivec2(terrain::tree_tile_cells)) + 3; // one step around, too
    scene::FilledHeights shown{Grid<float>(count.x, count.y), {}};
    if (!was_void.empty()) {
        shown.was_void = Grid<std::uint8_t>(count.x, count.y);
    }
    for (int row = 0; row < count.y; ++row) {
        for (int col = 0; col < count.x; ++col) {
            const glm::dvec2 vertex = glm::dvec2(first + glm::ivec2(col, row)) - 1.0;
            const glm::dvec2 place = vertex / static_cast<double>(cells_of_sample) + 1.0;
            shown.heights(col, row) = height_between(samples, place);
            if (!was_void.empty()) {
                const glm::ivec2 nearest(glm::round(place));
                shown.was_void(col, row) = was_void.clamped(nearest.x, nearest.y);
            }
        }
    }
    return shown;
}

} // namespace reljef::session
