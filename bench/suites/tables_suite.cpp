#include "bench/suites/tables_suite.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "bench/runner/gallery_tiles.h"
#include "bench/runner/suite.h"
#include "bench/suites/source_tests.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 sources_size{1024, 768};

std::vector<scene::Technique> techniques_on(const SceneChoice& scene,
                                            const std::vector<scene::Technique>& chosen) {
    std::vector<scene::Technique> techniques;
    if (chosen.empty()) {
        for (const scene::TechniqueInfo& info : techniques_of(scene)) {
            techniques.push_back(scene::make_technique(info.id));
        }
        return techniques;
    }
    std::copy_if(chosen.begin(), chosen.end(), std::back_inserter(techniques),
                 [&](const scene::Technique& technique) {
                     return scene.detail.empty() || suits(technique.id(), scene);
                 });
    return techniques;
}

void add_group(std::vector<Group>& groups, const SceneChoice& scene, scene::Pose default_pose,
               const TablesOptions& options) {
    const auto techniques = techniques_on(scene, options.techniques);
    if (!techniques.empty()) {
        groups.push_back(
            {"", scene, options.pose.value_or(default_pose), candidates_of(techniques)});
    }
}

std::vector<Group> terrain_groups(const TablesOptions& options) {
    const std::vector<std::string> built_in{"natural", "urban"};
    std::vector<Group> groups;
    for (const std::string& terrain : options.terrains.empty() ? built_in : options.terrains) {
        if (terrain != "gallery") {
            add_group(groups, {terrain}, scene::Pose::overview, options);
            continue;
        }
        for (const SceneChoice& detail : gallery_scenes()) {
            add_group(groups, detail, scene::Pose::oblique, options);
        }
    }
    return groups;
}

} // namespace

Results run_tables(const TablesOptions& options, const std::stop_token& stop) {
    const bool as_sources = options.terrains.empty() && options.techniques.empty() && !options.pose;
    Suite suite{.name = "tables",
                .groups =
                    as_sources ? source_groups(options.suite.quick) : terrain_groups(options)};
    if (options.suite.moving || options.suite.cold) {
        const std::string_view views = options.suite.moving ? "moving" : "cold";
        for (Group& group : suite.groups) {
            group.test += fmt::format("{}{}", group.test.empty() ? "" : ", ", views);
        }
    }
    suite.keep_scenes = !as_sources;
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
