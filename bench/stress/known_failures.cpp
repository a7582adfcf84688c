#include <algorithm>
#include <array>

#include "bench/stress/stress_results.h"

namespace reljef::bench {
namespace {

// Rows over their limits today, and the work that will fix them. Empty words match any row; the
// technique begins with its word.
struct KnownFailure {
    std::string_view stress;
    std::string_view figure;
    std::string_view technique;
    std::string_view terrain;
    std::string_view fixed_by;
};

constexpr std::string_view one_terrain = "one terrain, part 2: every technique on every tile";

constexpr std::array known_failures{
    KnownFailure{"detail texture", "pixels of sky over ground", "displacement", "", one_terrain},
    KnownFailure{"eye near the ground", "pixels of sky over ground", "polygons:lods", "",
                 one_terrain},
    KnownFailure{"", "pixels of sky over ground", "cone", "", one_terrain},
    KnownFailure{"scale", "pixels of sky over ground", "exact", "", one_terrain},
    KnownFailure{"scale", "% of pixels wrong", "exact", "", one_terrain},
};

bool matches(std::string_view word, std::string_view of_row) {
    return word.empty() || word == of_row;
}

} // namespace

std::string_view known_failure(const StressRow& row) {
    const auto known = std::find_if(
        known_failures.begin(), known_failures.end(), [&](const KnownFailure& failure) {
            return matches(failure.stress, row.stress) && matches(failure.figure, row.figure) &&
                   row.technique.starts_with(failure.technique) &&
                   matches(failure.terrain, row.terrain);
        });
    return known == known_failures.end() ? std::string_view() : known->fixed_by;
}

} // namespace reljef::bench
