#include "bench/suites/pareto_suite.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

#include "bench/report/pareto_front.h"
#include "bench/runner/gallery_tiles.h"
#include "bench/runner/suite.h"

namespace reljef::bench {
namespace {

constexpr std::array poses{scene::Pose::overview, scene::Pose::oblique, scene::Pose::low,
                           scene::Pose::grazing};

constexpr scene::Pose detail_pose = scene::Pose::oblique; // as in the figures of the sources

constexpr int max_view_cols = 512; // there are hundreds of rows

bool is_wide(const scene::NumberInfo& parameter) {
    return parameter.low > 0.0 && parameter.high > 10.0 * parameter.low;
}

double value_at(const scene::NumberInfo& parameter, double share) {
    if (share == 0.0 || share == 1.0) {
        return share == 0.0 ? parameter.low : parameter.high;
    }
    const double value = is_wide(parameter)
                             ? parameter.low * std::pow(parameter.high / parameter.low, share)
                             : std::lerp(parameter.low, parameter.high, share);
    return parameter.whole ? std::round(value) : value;
}

bool is_accepted(const scene::Technique& technique) {
    return scene::parse_technique(scene::to_string(technique)).has_value();
}

// Ranks techniques by the typical cost of their kind.
int cost_rank(const scene::TechniqueInfo& info) {
    constexpr int searches = 2;
    constexpr std::array<std::pair<std::string_view, int>, 5> ranks{
        {{"texture", 0}, {"parallax", 1}, {"exact", 3}, {"prewarp", 4}, {"cone", 5}}};
    constexpr int triangles = 6;
    const auto found = std::find_if(ranks.begin(), ranks.end(), [&](const auto& rank) {
        return info.name.starts_with(rank.first);
    });
    const bool is_full = scene::geometry_of(info.id) == scene::Geometry::full;
    return is_full ? triangles : found == ranks.end() ? searches : found->second;
}

std::vector<scene::TechniqueInfo> by_cost(std::vector<scene::TechniqueInfo> infos) {
    std::stable_sort(infos.begin(), infos.end(),
                     [](const scene::TechniqueInfo& a, const scene::TechniqueInfo& b) {
                         return cost_rank(a) < cost_rank(b);
                     });
    return infos;
}

// The values of a parameter except its default, grouped by their distance from it in steps.
std::vector<std::vector<double>> values_by_distance(const scene::NumberInfo& parameter) {
    const std::vector<double> values = values_over_range(parameter);
    const auto usual = std::find(values.begin(), values.end(), parameter.default_value);
    std::vector<std::vector<double>> rings(values.size() - 1);
    for (auto value = values.begin(); value != values.end(); ++value) {
        if (const auto distance = std::abs(value - usual); distance > 0) {
            rings[static_cast<std::size_t>(distance) - 1].push_back(*value);
        }
    }
    return rings;
}

// A technique with one parameter `ring` + 1 steps from its default.
std::vector<scene::Technique> settings_of_ring(const scene::TechniqueInfo& info, std::size_t ring) {
    std::vector<scene::Technique> settings;
    for (const scene::ParameterInfo& parameter : info.parameters) {
        const auto rings = values_by_distance(parameter);
        for (const double value : ring < rings.size() ? rings[ring] : std::vector<double>()) {
            scene::Technique setting = scene::make_technique(info.id);
            parameter.set(setting, value);
            if (is_accepted(setting)) {
                settings.push_back(setting);
            }
        }
    }
    return settings;
}

// Indices of an option's words except its default. An option whose default is no word has a range;
// its first word stands for it.
std::vector<std::size_t> choices_of(const scene::OptionInfo& option) {
    const auto usual = static_cast<std::size_t>(
        std::find(option.words.begin(), option.words.end(), option.default_value) -
        option.words.begin());
    if (usual == option.words.size()) {
        return {0};
    }
    std::vector<std::size_t> choices(option.words.size());
    std::iota(choices.begin(), choices.end(), std::size_t{0});
    std::erase(choices, usual);
    return choices;
}

// Techniques that suit a scene; on heightfield textures also the options.
std::vector<scene::Technique> usual_settings(const SceneChoice& scene) {
    const std::vector<scene::TechniqueInfo> infos = techniques_of(scene);
    std::vector<scene::Technique> settings = settings_over_range(infos);
    if (suits(scene::TechniqueId::relief, scene) && !scene.detail.empty()) {
        const auto options = settings_of_options();
        settings.insert(settings.begin() + static_cast<std::ptrdiff_t>(infos.size()),
                        options.begin(), options.end());
    }
    return settings;
}

std::vector<SceneChoice> pareto_scenes(const ParetoOptions& options) {
    const std::vector<std::string> built_in{"gallery", "natural", "urban"};
    const bool is_default = options.terrains.empty();
    std::vector<SceneChoice> scenes;
    for (const std::string& terrain : is_default ? built_in : options.terrains) {
        if (terrain == "gallery") {
            const auto details = gallery_scenes();
            scenes.insert(scenes.end(), details.begin(), details.end());
        } else {
            scenes.push_back({terrain, is_default && options.suite.quick ? quick_samples : 0});
        }
    }
    return scenes;
}

std::vector<scene::Technique> settings_on(const SceneChoice& scene, const ParetoOptions& options) {
    if (options.techniques.empty()) {
        return usual_settings(scene);
    }
    const bool takes_any = scene.detail.empty() && !options.terrains.empty();
    std::vector<scene::Technique> settings;
    std::copy_if(
        options.techniques.begin(), options.techniques.end(), std::back_inserter(settings),
        [&](const scene::Technique& setting) { return takes_any || suits(setting.id(), scene); });
    return settings;
}

bool lacks_a_technique(const Front& front, const std::vector<LeftOut>& left_out) {
    return std::any_of(left_out.begin(), left_out.end(), [&](const LeftOut& group) {
        return group.scene == front.scene && group.pose == front.pose && !group.techniques.empty();
    });
}

} // namespace

std::vector<double> values_over_range(const scene::NumberInfo& parameter) {
    std::vector<double> values{parameter.default_value};
    for (int i = 0; i < max_values; ++i) {
        values.push_back(value_at(parameter, i / (max_values - 1.0)));
    }
    std::erase_if(values, [&](double value) { return !parameter.allows(value); });
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

std::vector<scene::Technique>
settings_over_range(const std::vector<scene::TechniqueInfo>& techniques) {
    const std::vector<scene::TechniqueInfo> catalogue = by_cost(techniques);
    std::vector<scene::Technique> all;
    std::transform(catalogue.begin(), catalogue.end(), std::back_inserter(all),
                   [](const scene::TechniqueInfo& info) { return scene::make_technique(info.id); });
    for (std::size_t ring = 0; ring < max_values; ++ring) {
        for (const scene::TechniqueInfo& info : catalogue) {
            const std::vector<scene::Technique> settings = settings_of_ring(info, ring);
            all.insert(all.end(), settings.begin(), settings.end());
        }
    }
    return all;
}

std::vector<scene::Technique> settings_of_options() {
    std::vector<scene::Technique> settings;
    for (const scene::OptionInfo& option : scene::option_catalogue()) {
        for (const std::size_t choice : choices_of(option)) {
            scene::Technique setting{scene::Relief{}};
            option.choose(setting.options, choice);
            if (is_accepted(setting)) {
                settings.push_back(setting);
            }
        }
    }
    return settings;
}

std::vector<Group> pareto_groups(const ParetoOptions& options) {
    std::vector<Group> groups;
    std::size_t place = 0;
    for (const SceneChoice& scene : pareto_scenes(options)) {
        const auto settings = settings_on(scene, options);
        for (const scene::Pose pose : poses) {
            const bool is_measured =
                !settings.empty() && (scene.detail.empty() || pose == detail_pose);
            if (is_measured && options.shard.has(place++)) {
                groups.push_back({"", scene, pose, candidates_of(settings)});
            }
        }
    }
    return groups;
}

Results run_pareto(const ParetoOptions& options, const std::stop_token& stop) {
    Suite suite{.name = "pareto", .groups = pareto_groups(options)};
    suite.max_view_cols = max_view_cols;
    Results results = run_suite(suite, options.suite, stop);
    results.shard = options.shard;
    results.fronts = fronts_of(results.rows);
    for (Front& front : results.fronts) {
        if (lacks_a_technique(front, results.left_out)) {
            front.area.reset();
        }
    }
    return results;
}

} // namespace reljef::bench
