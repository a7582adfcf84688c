// The failures of a stream: bad files, and memory that is missing.
#include "engine/scene/streaming/tile_stream.h"

#include <algorithm>
#include <utility>

namespace reljef::scene {

// All tiles of a bad file wait together: it delays a flight once, not for each new tile.
void TileStream::note_failure(terrain::TreeTile tile, std::span<const FileError> errors) {
    ++stats_.failed;
    const auto now = Clock::now();
    TileFailure failure;
    for (const FileError& error : errors) {
        BackOff& file = file_failures_.try_emplace(error.file, options_.first_pause).first->second;
        file.fail(now);
        if (failure.files.empty() || failure.latest.again() < file.again()) {
            failure.latest = file;
        }
        failure.files.push_back(error.file);
    }
    revision_ += failure.latest.has_failed_for_good() ? 1U : 0U; // has_given_up() changes
    failures_[tile] = std::move(failure);
    record_errors(errors);
}

void TileStream::forget_failure(terrain::TreeTile tile) {
    const auto found = failures_.find(tile);
    if (found != failures_.end()) {
        for (const std::filesystem::path& file : found->second.files) {
            file_failures_.erase(file);
        }
        revision_ += found->second.latest.has_failed_for_good() ? 1U : 0U;
        failures_.erase(found);
    }
}

void TileStream::record_errors(std::span<const FileError> errors) {
    for (const FileError& error : errors) {
        if (!was_reported(error.file) && failed_files_.insert(error.file).second) {
            new_errors_.push_back(error.message);
        }
    }
}

bool TileStream::was_reported(const std::filesystem::path& file) const {
    const std::string start = file.string() + ":";
    return std::any_of(options_.reported.begin(), options_.reported.end(),
                       [&](const std::string& message) { return message.starts_with(start); });
}

bool TileStream::has_given_up(const std::filesystem::path& file) const {
    const std::lock_guard lock(mutex_);
    const auto failures = file_failures_.find(file);
    return was_reported(file) ||
           (failures != file_failures_.end() && failures->second.has_failed_for_good());
}

} // namespace reljef::scene
