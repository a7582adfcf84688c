#include "bench/report/results.h"

namespace reljef::bench {

Setting setting_of(const scene::Technique& technique) {
    const scene::TechniqueInfo& info = scene::technique_info(technique.id());
    Setting setting{std::string(info.name), {}, scene::to_string(technique)};
    for (const scene::ParameterInfo& parameter : info.parameters) {
        setting.parameters.push_back({std::string(parameter.name), parameter.get(technique)});
    }
    for (const scene::OptionNumber& number : scene::option_numbers(technique.options)) {
        setting.parameters.push_back({number.name, number.value});
    }
    return setting;
}

Timing timed(const std::vector<double>& ms, std::optional<double> noise_floor) {
    Timing timing;
    timing.frames = ms.size();
    timing.ms = summarize(ms);
    timing.fps_1_percent_low = 1000.0 / mean_of_largest(ms, 0.01);
    if (ms.size() >= min_frames) {
        timing.interval = median_interval(ms);
        timing.noise_floor = noise_floor;
    }
    return timing;
}

std::optional<double> Row::taps() const {
    const double pixels = static_cast<double>(size.x) * size.y;
    return work ? std::optional(static_cast<double>(work->taps) / pixels) : std::nullopt;
}

bool Row::noisy() const {
    return has_few_frames() || (timing.noise_floor && *timing.noise_floor > max_noise);
}

} // namespace reljef::bench
