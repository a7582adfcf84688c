#pragma once

#include <algorithm>
#include <cmath>

#include "engine/scene/technique/technique.h"
#include "tests/terrain/chance.h"

namespace reljef::scene {

/// Any allowed value, now and then an end of the range.
inline double random_value(const NumberInfo& number, test::Chance& chance) {
    if (chance.one_in(4)) {
        return chance.one_in(2) ? number.low : number.high;
    }
    const double value = chance.between(number.low, number.high);
    const double allowed = number.whole ? std::round(value) : value;
    return number.allows(allowed) ? allowed : number.min_above_low;
}

/// Any options that go with a technique, by the table alone.
inline TechniqueOptions random_options(TechniqueId id, test::Chance& chance) {
    TechniqueOptions options;
    for (const OptionInfo& info : options_of(id)) {
        if (chance.one_in(2)) {
            continue;
        }
        const int last = static_cast<int>(info.words.size()) - 1;
        const int word = chance.whole(0, std::max(last, 0));
        info.choose(options, static_cast<std::size_t>(word));
        if (word < last || !info.chosen(options)) {
            continue; // only the last word has numbers
        }
        for (const OptionNumberInfo& number : info.numbers) {
            number.set(options, random_value(number, chance));
        }
        if (info.words.empty()) { // a range
            const auto [low, high] =
                std::minmax({*info.numbers[0].get(options), *info.numbers[1].get(options)});
            info.numbers[0].set(options, low);
            info.numbers[1].set(options, high);
        }
    }
    return options;
}

/// Any values of a technique's parameters that go together, and any options, by the table alone.
inline Technique random_technique(const TechniqueInfo& info, test::Chance& chance) {
    Technique technique{info.defaults, random_options(info.id, chance)};
    for (const ParameterInfo& parameter : info.parameters) {
        parameter.set(technique, random_value(parameter, chance));
    }
    for (const ParameterInfo& parameter : info.parameters) {
        for (const ParameterInfo& other : info.parameters) {
            if (other.name == parameter.replaced_by &&
                other.get(technique) != other.default_value) {
                parameter.set(technique, parameter.default_value);
            }
        }
    }
    return technique;
}

} // namespace reljef::scene
