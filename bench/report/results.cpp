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

bool Row::has_few_frames() const {
    return timing && timing->frames < min_frames;
}

bool Row::noisy() const {
    return has_few_frames() || (timing && timing->noise_floor && *timing->noise_floor > max_noise);
}

bool Row::shows_nothing() const {
    return error && !error->reprojection_px;
}

} // namespace reljef::bench
