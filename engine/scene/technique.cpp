#include "engine/scene/technique.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reljef::scene {
namespace {

constexpr std::array<ParameterInfo, 1> polygons_parameters{
    {{"lods", 1.0, 1.0, 1.0, true, "levels of detail at most; 1: every sample is a vertex"}}};

constexpr std::array<TechniqueInfo, 2> catalogue{
    {{TechniqueId::texture,
      "texture",
      "diffuse colour over the flat reference surface, lit by the height gradient",
      "GPU surface-detail survey (2008) ch. 1; Janković 2010 ch. 2",
      {}},
     {TechniqueId::polygons, "polygons", "the heightfield as triangles",
      "Janković 2010 ch. 2.7 test 4", polygons_parameters}}};

std::vector<std::string_view> names_of(const auto& infos) {
    std::vector<std::string_view> names;
    std::transform(infos.begin(), infos.end(), std::back_inserter(names),
                   [](const auto& info) { return info.name; });
    return names;
}

// Splits at the first `separator`; the second part is empty where there is none.
std::pair<std::string_view, std::string_view> split(std::string_view text, char separator) {
    const auto at = text.find(separator);
    return at == std::string_view::npos ? std::pair{text, std::string_view{}}
                                        : std::pair{text.substr(0, at), text.substr(at + 1)};
}

Result<double> parse_value(const TechniqueInfo& technique, const ParameterInfo& parameter,
                           std::string_view text) {
    double value = 0.0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = code == std::errc{} && end == text.data() + text.size();
    const bool fits = is_number && value >= parameter.low && value <= parameter.high &&
                      (!parameter.whole || value == std::round(value));
    if (!fits) {
        return Error{fmt::format("technique {}: {}={} found, a {}number from {} to {} was expected",
                                 technique.name, parameter.name, text,
                                 parameter.whole ? "whole " : "", parameter.low, parameter.high)};
    }
    return value;
}

Result<void> set_parameter(Technique& technique, std::string_view assignment) {
    const TechniqueInfo& info = technique_info(technique.id);
    const auto [key, text] = split(assignment, '=');
    const auto* const parameter =
        std::find_if(info.parameters.begin(), info.parameters.end(),
                     [&, name = key](const ParameterInfo& p) { return p.name == name; })
            .base();
    if (parameter == info.parameters.data() + info.parameters.size()) {
        return info.parameters.empty()
                   ? Error{fmt::format("technique {}: parameter '{}' found, it has none", info.name,
                                       key)}
                   : Error{fmt::format("technique {}: parameter '{}' found, one of {} was expected",
                                       info.name, key, fmt::join(names_of(info.parameters), ", "))};
    }
    const auto value = parse_value(info, *parameter, text);
    if (!value) {
        return value.error();
    }
    technique.values[static_cast<std::size_t>(parameter - info.parameters.data())] = *value;
    return {};
}

} // namespace

std::span<const TechniqueInfo> technique_catalogue() {
    return catalogue;
}

const TechniqueInfo& technique_info(TechniqueId id) {
    const auto* const found =
        std::find_if(catalogue.begin(), catalogue.end(),
                     [&](const TechniqueInfo& info) { return info.id == id; });
    check(found != catalogue.end(), "technique without a catalogue entry");
    return *found;
}

Technique make_technique(TechniqueId id) {
    Technique technique{id, {}};
    for (const ParameterInfo& parameter : technique_info(id).parameters) {
        technique.values.push_back(parameter.default_value);
    }
    return technique;
}

Result<Technique> parse_technique(std::string_view text) {
    auto [name, assignments] = split(text, ':');
    const auto* const info =
        std::find_if(catalogue.begin(), catalogue.end(),
                     [n = name](const TechniqueInfo& entry) { return entry.name == n; });
    if (info == catalogue.end()) {
        return Error{fmt::format("technique '{}' found, one of {} was expected", name,
                                 fmt::join(names_of(catalogue), ", "))};
    }
    Technique technique = make_technique(info->id);
    if (text.ends_with(':') || text.ends_with(',')) {
        return Error{fmt::format("technique '{}' found, key=value was expected at its end", text)};
    }
    while (!assignments.empty()) {
        const auto [first, rest] = split(assignments, ',');
        if (auto set = set_parameter(technique, first); !set) {
            return set.error();
        }
        assignments = rest;
    }
    return technique;
}

std::string to_string(const Technique& technique) {
    const TechniqueInfo& info = technique_info(technique.id);
    std::string text(info.name);
    for (std::size_t i = 0; i < info.parameters.size(); ++i) {
        text += fmt::format("{}{}={}", i == 0 ? ':' : ',', info.parameters[i].name,
                            technique.values[i]);
    }
    return text;
}

} // namespace reljef::scene
