#pragma once

#include <vector>

namespace reljef::io {

/// Columns of a raster, or of a level of its tiles.
struct ColumnRange {
    int stored = 0;
    int around = 0; ///< columns of a whole turn; 0: the raster does not close
};

/// Stored columns that are neighbours in a window.
struct ColumnRun {
    int at = 0; ///< in the window
    int first = 0;
    int count = 0;
};

/// The stored columns of a window of `count` columns from `first` on, which may lie beyond the
/// raster. Without a turn, columns beyond it have no run: they repeat the border. Preconditions:
/// count > 0; around is 0, or at least 1 and at most `stored`.
std::vector<ColumnRun> column_runs(int first, int count, const ColumnRange& range);

} // namespace reljef::io
