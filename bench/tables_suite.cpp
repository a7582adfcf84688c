#include "bench/tables_suite.h"

#include <algorithm>

#include <fmt/format.h>

#include "bench/source_tests.h"
#include "bench/suite.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 sources_size{1024, 768};

std::vector<Candidate> candidates_of(const std::vector<scene::Technique>& chosen) {
    const scene::Technique texture = scene::make_technique(scene::TechniqueId::texture);
    std::vector<scene::Technique> others = chosen;
    if (others.empty()) {
        for (const scene::TechniqueInfo& info : scene::terrain_techniques()) {
            others.push_back(scene::make_technique(info.id));
        }
    }
    std::vector<Candidate> candidates{candidate_of(texture)};
    for (const scene::Technique& technique : others) {
        if (technique.id != texture.id) {
            candidates.push_back(candidate_of(technique));
        }
    }
    return candidates;
}

std::vector<Group> terrain_groups(const TablesOptions& options) {
    const std::vector<std::string> built_in{"natural", "urban"};
    std::vector<Group> groups;
    for (const std::string& terrain : options.terrains.empty() ? built_in : options.terrains) {
        groups.push_back({"",
                          {terrain},
                          options.pose.value_or(scene::Pose::overview),
                          candidates_of(options.techniques)});
    }
    return groups;
}

} // namespace

Results run_tables(const TablesOptions& options, const std::stop_token& stop) {
    const bool as_sources = options.terrains.empty() && options.techniques.empty() && !options.pose;
    Suite suite{.name = "tables",
                .groups =
                    as_sources ? source_groups(options.suite.quick) : terrain_groups(options)};
    suite.keep_stages = !as_sources;
    suite.may_leave_out = !as_sources;
    Results results = run_suite(suite, options.suite, stop);
    if (as_sources && options.suite.size != sources_size) {
        results.notes.push_back(fmt::format("sources: their pictures are of {}x{}, these of {}x{}",
                                            sources_size.x, sources_size.y, options.suite.size.x,
                                            options.suite.size.y));
    }
    std::stable_sort(results.rows.begin(), results.rows.end(),
                     [](const Row& a, const Row& b) { return a.test < b.test; });
    return results;
}

} // namespace reljef::bench
