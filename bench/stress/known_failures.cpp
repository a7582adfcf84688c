#include <algorithm>
#include <array>

#include "bench/stress/stress_results.h"

namespace reljef::bench {
namespace {

using scene::TechniqueId;

// Rows over their limits today, and the work that will fix them. Empty words match any row.
struct KnownFailure {
    std::string_view stress;
    std::string_view figure;
    std::optional<TechniqueId> technique; // absent: any
    std::string_view terrain;
    std::string_view fixed_by;
};

constexpr std::string_view one_terrain_1 = "one terrain, part 1";
constexpr std::string_view one_terrain_2 = "one terrain, part 2: every technique on every tile";

constexpr std::array known_failures{
    KnownFailure{"", "stated over largest error, median", {}, "", one_terrain_1},
    KnownFailure{"detail texture", "pixels of sky over ground", TechniqueId::displacement, "",
                 one_terrain_2},
    KnownFailure{"eye near the ground", "pixels of sky over ground", TechniqueId::polygons, "",
                 one_terrain_2},
    KnownFailure{"", "pixels of sky over ground", TechniqueId::cone, "", one_terrain_2},
    KnownFailure{"scale", "pixels of sky over ground", TechniqueId::exact, "", one_terrain_2},
    KnownFailure{"scale", "% of pixels wrong", TechniqueId::exact, "", one_terrain_2},
};

bool matches(std::string_view word, std::string_view of_row) {
    return word.empty() || word == of_row;
}

bool is_technique(std::optional<TechniqueId> id, std::string_view text) {
    return !id || text.substr(0, text.find(':')) == scene::technique_info(*id).name;
}

} // namespace

std::string_view known_failure(const StressRow& row) {
    const auto known = std::find_if(
        known_failures.begin(), known_failures.end(), [&](const KnownFailure& failure) {
            return matches(failure.stress, row.stress) && matches(failure.figure, row.figure) &&
                   is_technique(failure.technique, row.technique) &&
                   matches(failure.terrain, row.terrain);
        });
    return known == known_failures.end() ? std::string_view() : known->fixed_by;
}

} // namespace reljef::bench
