#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>

namespace reljef {

/// Receives the progress in [0,1]. Called from any worker thread, one call at a time. May be empty.
using Progress = std::function<void(double fraction)>;

/// `requested`, or the machine's number of threads if it is 0; at least 1.
unsigned thread_count(unsigned requested);

/// The items of a job that one process of several does: each item belongs to exactly one of `count`
/// shards. Neighbours go to different shards, because they often cost the same.
struct Shard {
    int index = 0; ///< [0, count)
    int count = 1; ///< at least 1

    [[nodiscard]] bool has(std::size_t item) const {
        return item % static_cast<std::size_t>(count) == static_cast<std::size_t>(index);
    }
    [[nodiscard]] bool is_whole() const { return count == 1; }
    friend bool operator==(const Shard&, const Shard&) = default;
};

struct ParallelOptions {
    unsigned threads = 0; ///< 0: one per hardware thread
    std::stop_token stop; ///< no new item starts after a stop request
    Progress progress;
};

/// Calls `body(index)` for every index in [0, count) from several threads and waits for all.
/// Returns false if it was stopped early. If `body` throws (std::bad_alloc), no new item starts,
/// and the caller gets the first exception.
bool parallel_for(int count, const std::function<void(int index)>& body,
                  const ParallelOptions& options = {});

/// parallel_for() over the rows of a grid: calls `body(col, row)` once for every cell.
template <class Body>
bool for_each_cell(int cols, int rows, const ParallelOptions& options, const Body& body) {
    const auto do_row = [&](int row) {
        for (int col = 0; col < cols; ++col) {
            body(col, row);
        }
    };
    return parallel_for(rows, do_row, options);
}

} // namespace reljef
