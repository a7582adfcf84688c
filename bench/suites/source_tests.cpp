#include "bench/suites/source_tests.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "engine/core/check.h"

namespace reljef::bench {
namespace {

constexpr std::array<SourceMeasurement, 24> measurements{{
    {"parallax-1", "urban (tile repeated)", 1, "texture", 45},
    {"parallax-1", "urban (tile repeated)", 1, "parallax", 35},
    {"parallax-1", "urban (tile repeated)", 2, "texture", 894},
    {"parallax-1", "urban (tile repeated)", 2, "parallax", 867},
    {"parallax-2", "urban (fragment of a 4096x4096 image)", 1, "texture", 48},
    {"parallax-2", "urban (fragment of a 4096x4096 image)", 1, "parallax", 36},
    {"parallax-2", "urban (fragment of a 4096x4096 image)", 2, "texture", 885},
    {"parallax-2", "urban (fragment of a 4096x4096 image)", 2, "parallax", 807},
    {"parallax-3", "natural", 1, "texture", 51},
    {"parallax-3", "natural", 1, "parallax", 43},
    {"parallax-3", "natural", 2, "texture", 893},
    {"parallax-3", "natural", 2, "parallax", 808},
    {"relief-1", "urban 512 (tile repeated)", 2, "texture", 176},
    {"relief-1", "urban 512 (tile repeated)", 2, "relief", 44},
    {"relief-2", "urban 1024 (spread over the terrain)", 2, "texture", 196},
    {"relief-2", "urban 1024 (spread over the terrain)", 2, "relief", 56},
    {"relief-3", "natural 1280", 2, "texture", 170},
    {"relief-3", "natural 1280", 2, "relief", 60},
    {"relief-4", "1024 heightfield", 2, "texture", 824},
    {"relief-4", "1024 heightfield", 2, "polygons lod=1", 5},
    {"relief-4", "1024 heightfield", 2, "polygons lod=3", 62},
    {"relief-4", "1024 heightfield", 2, "polygons lod=5", 170},
    {"relief-4", "1024 heightfield", 2, "parallax", 716},
    {"relief-4", "1024 heightfield", 2, "relief", 55},
}};

constexpr int chosen_configuration = 2;

struct SourceTechnique {
    std::string_view name; // the sources' name
    scene::Technique technique;
};

constexpr std::array source_techniques{
    SourceTechnique{"texture", {scene::Texture{}}},
    SourceTechnique{"parallax", {scene::Parallax{}}},
    SourceTechnique{"relief", {scene::Relief{}}},
    SourceTechnique{"polygons lod=1", {scene::Polygons{.max_levels = 1}}},
    SourceTechnique{"polygons lod=3", {scene::Polygons{.max_levels = 3}}},
    SourceTechnique{"polygons lod=5", {scene::Polygons{.max_levels = 5}}}};

const scene::Technique& technique_of(std::string_view name) {
    const auto* const found =
        std::find_if(source_techniques.begin(), source_techniques.end(),
                     [&](const SourceTechnique& row) { return row.name == name; });
    check(found != source_techniques.end(), "a technique of the sources without a row");
    return found->technique;
}

std::vector<SourceMeasurement> measurements_of(std::string_view test) {
    std::vector<SourceMeasurement> found;
    std::copy_if(measurements.begin(), measurements.end(), std::back_inserter(found),
                 [&](const SourceMeasurement& measurement) {
                     return measurement.test == test &&
                            measurement.configuration == chosen_configuration;
                 });
    return found;
}

Group group_of(std::string_view test, const SceneChoice& scene) {
    const std::vector<SourceMeasurement> found = measurements_of(test);
    Group group{std::string(test), scene, scene::Pose::overview, {}};
    for (const SourceMeasurement& measurement : found) {
        group.candidates.push_back(
            {technique_of(measurement.technique),
             SourceFigure{measurement.fps, found.front().fps / measurement.fps,
                          fmt::format("{}, configuration {}", test, chosen_configuration)}});
    }
    return group;
}

Group with_ours(Group group, std::initializer_list<scene::Technique> techniques) {
    for (const scene::Technique& technique : techniques) {
        group.candidates.push_back({technique});
    }
    return group;
}

} // namespace

std::span<const SourceMeasurement> source_measurements() {
    return measurements;
}

std::vector<Group> source_groups(bool quick) {
    const SceneChoice urban_tile{"urban", 512, true};
    const SceneChoice natural{"natural", 1025};
    return {group_of("parallax-1", urban_tile),
            group_of("relief-1", urban_tile),
            group_of("parallax-2", {"urban", quick ? 2048 : 4096}),
            group_of("relief-2", {"urban", 1024}),
            group_of("parallax-3", natural),
            with_ours(group_of("relief-4", natural),
                      {scene::Technique{scene::Polygons{.error = 1.0}},
                       scene::Technique{scene::Exact{}},
                       scene::Technique{scene::Automatic{.error = 1.0}}}),
            group_of("relief-3", {"natural", 1280})};
}

} // namespace reljef::bench
