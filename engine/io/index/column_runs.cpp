#include "engine/io/index/column_runs.h"

#include <algorithm>

namespace reljef::io {

std::vector<ColumnRun> column_runs(int first, int count, const ColumnRange& range) {
    if (range.around == 0) {
        const int begin = std::clamp(first, 0, range.stored - 1);
        const int last = std::clamp(first + count - 1, 0, range.stored - 1);
        return {{begin - first, begin, last - begin + 1}};
    }
    std::vector<ColumnRun> runs;
    for (int at = 0; at < count;) {
        const int col = first + at;
        const bool is_stored = col >= 0 && col < range.stored;
        const int turned = is_stored ? col : (col % range.around + range.around) % range.around;
        const int end = col < 0 ? range.around : range.stored;
        const int length = std::min(count - at, end - turned);
        runs.push_back({at, turned, length});
        at += length;
    }
    return runs;
}

} // namespace reljef::io
