#include "bench/pareto_suite.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/pareto_front.h"
#include "bench/suite.h"

namespace reljef::bench {
namespace {

constexpr std::array poses{scene::Pose::overview, scene::Pose::oblique, scene::Pose::low,
                           scene::Pose::grazing};

bool is_wide(const scene::ParameterInfo& parameter) {
    return parameter.low > 0.0 && parameter.high > 10.0 * parameter.low;
}

double value_at(const scene::ParameterInfo& parameter, double share) {
    if (share == 0.0 || share == 1.0) {
        return share == 0.0 ? parameter.low : parameter.high;
    }
    const double value = is_wide(parameter)
                             ? parameter.low * std::pow(parameter.high / parameter.low, share)
                             : std::lerp(parameter.low, parameter.high, share);
    return parameter.whole ? std::round(value) : value;
}

// What the command line would refuse is no setting.
bool is_accepted(const scene::Technique& technique) {
    return scene::parse_technique(scene::to_string(technique)).has_value();
}

// Without the one that it is by default.
std::vector<scene::Technique> settings_of(const scene::TechniqueInfo& info) {
    const scene::Technique usual = scene::make_technique(info.id);
    std::vector<scene::Technique> settings;
    for (std::size_t i = 0; i < info.parameters.size(); ++i) {
        for (const double value : values_over_range(info.parameters[i])) {
            scene::Technique setting = usual;
            setting.values[i] = value;
            if (setting.values != usual.values && is_accepted(setting)) {
                settings.push_back(std::move(setting));
            }
        }
    }
    return settings;
}

std::vector<Candidate> pareto_candidates(const std::vector<scene::Technique>& chosen) {
    const std::string texture =
        scene::to_string(scene::make_technique(scene::TechniqueId::texture));
    std::vector<Candidate> candidates{candidate_named(texture)};
    for (const scene::Technique& technique : chosen.empty() ? settings_over_range() : chosen) {
        if (scene::to_string(technique) != texture) {
            candidates.push_back(candidate_of(technique));
        }
    }
    return candidates;
}

std::vector<Group> pareto_groups(const ParetoOptions& options) {
    std::vector<Group> groups;
    for (const std::string& terrain : options.terrains) {
        for (const scene::Pose pose : poses) {
            groups.push_back({"", {terrain}, pose, pareto_candidates(options.techniques)});
        }
    }
    return groups;
}

} // namespace

std::vector<double> values_over_range(const scene::ParameterInfo& parameter) {
    std::vector<double> values{parameter.default_value};
    for (int i = 0; i < most_values; ++i) {
        values.push_back(value_at(parameter, i / (most_values - 1.0)));
    }
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

std::vector<scene::Technique> settings_over_range() {
    std::vector<scene::Technique> all;
    for (const scene::TechniqueInfo& info : scene::terrain_techniques()) {
        all.push_back(scene::make_technique(info.id));
    }
    for (const scene::TechniqueInfo& info : scene::terrain_techniques()) {
        const std::vector<scene::Technique> settings = settings_of(info);
        all.insert(all.end(), settings.begin(), settings.end());
    }
    return all;
}

Results run_pareto(const ParetoOptions& options, const std::stop_token& stop) {
    Results results = run_suite({"pareto", pareto_groups(options)}, options.suite, stop);
    results.fronts = fronts_of(results.rows);
    return results;
}

} // namespace reljef::bench
