#include "app/cli/suggestion.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include <fmt/format.h>

namespace reljef::cli {

int edit_distance(std::string_view a, std::string_view b) {
    // The last three rows of the table of distances between prefixes of a and b.
    std::vector<int> before_last(b.size() + 1);
    std::vector<int> last(b.size() + 1);
    std::vector<int> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::swap(before_last, last);
        std::swap(last, row);
        row[0] = static_cast<int>(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const int replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({replaced, last[j] + 1, row[j - 1] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = std::min(row[j], before_last[j - 2] + 1);
            }
        }
    }
    return row[b.size()];
}

std::string suggestion(std::string_view unknown, std::span<const std::string> known) {
    constexpr std::size_t max_length = 64; // a longer word is no misspelling
    if (unknown.size() > max_length) {
        return "";
    }
    std::string nearest;
    int min_distance = std::max(1, static_cast<int>(unknown.size()) / 3) + 1;
    for (const std::string& word : known) {
        const int distance = edit_distance(unknown, word);
        if (distance < min_distance) {
            min_distance = distance;
            nearest = word;
        }
    }
    return nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest);
}

} // namespace reljef::cli
