#include "engine/scene/technique/technique.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reljef::scene {
namespace {

std::string names_of(const auto& infos) {
    std::vector<std::string_view> names;
    std::transform(infos.begin(), infos.end(), std::back_inserter(names),
                   [](const auto& info) { return info.name; });
    return fmt::format("{}", fmt::join(names, ", "));
}

// Null if no row has the name.
auto named(const auto& infos, std::string_view name) {
    const auto found = std::find_if(infos.begin(), infos.end(),
                                    [&](const auto& info) { return info.name == name; });
    return found == infos.end() ? nullptr : &*found;
}

// Splits at the first `separator`; without one the second part is empty.
std::pair<std::string_view, std::string_view> split(std::string_view text, char separator) {
    const auto at = std::min(text.find(separator), text.size());
    return {text.substr(0, at), text.substr(std::min(at + 1, text.size()))};
}

Result<void> set_parameter(Technique& technique, std::string_view assignment) {
    const TechniqueInfo& info = technique_info(technique.id());
    const auto [key, text] = split(assignment, '=');
    const ParameterInfo* const parameter = named(info.parameters, key);
    if (parameter == nullptr) {
        return info.parameters.empty()
                   ? Error{fmt::format("technique {}: parameter '{}' found, it has none", info.name,
                                       key)}
                   : Error{fmt::format("technique {}: parameter '{}' found, one of {} was expected",
                                       info.name, key, names_of(info.parameters))};
    }
    const auto value = parse_number(fmt::format("technique {}", info.name), *parameter, text);
    if (!value) {
        return value.error();
    }
    parameter->set(technique, *value);
    return {};
}

// Removes the first assignment from the list. It ends at a comma; the assignment of an option ends
// at the comma before the next '='.
std::string_view take_assignment(std::string_view& list) {
    auto end = std::min(list.find(','), list.size());
    if (is_option(list.substr(0, end)) && end < list.size()) {
        const auto next = std::min(list.find(',', end + 1), list.size());
        end = list.substr(end, next - end).find('=') == std::string_view::npos ? next : end;
    }
    const auto assignment = list.substr(0, end);
    list = list.substr(std::min(end + 1, list.size()));
    return assignment;
}

// Sets a parameter or an option; `seen`: the names set so far.
Result<void> assign(Technique& technique, std::string_view assignment,
                    std::vector<std::string_view>& seen) {
    const auto name = split(assignment, '=').first;
    if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
        return Error{fmt::format("technique {}: '{}' found twice, once was expected",
                                 technique_info(technique.id()).name, name)};
    }
    seen.push_back(name);
    return is_option(assignment) ? set_option(technique.options, technique.id(), assignment)
                                 : set_parameter(technique, assignment);
}

bool is_default(const Technique& technique, const ParameterInfo& parameter) {
    return parameter.get(technique) == parameter.default_value;
}

bool is_replaced(const Technique& technique, const ParameterInfo& parameter) {
    const auto* const other =
        named(technique_info(technique.id()).parameters, parameter.replaced_by);
    return other != nullptr && !is_default(technique, *other);
}

template <class Parameters> auto offset_in(Parameters& parameters) {
    if (auto* const parallax = std::get_if<Parallax>(&parameters)) {
        return &parallax->offset;
    }
    if (auto* const limited = std::get_if<ParallaxLimited>(&parameters)) {
        return &limited->offset;
    }
    auto* const iterated = std::get_if<ParallaxIterated>(&parameters);
    return iterated == nullptr ? nullptr : &iterated->offset;
}

// Fails on parameters that exclude each other.
Result<Technique> without_contradiction(const Technique& technique) {
    const TechniqueInfo& info = technique_info(technique.id());
    for (const ParameterInfo& parameter : info.parameters) {
        if (is_replaced(technique, parameter) && !is_default(technique, parameter)) {
            return Error{fmt::format("technique {}: {} and {} found, one of them was expected",
                                     info.name, parameter.name, parameter.replaced_by)};
        }
    }
    return technique;
}

} // namespace

Geometry geometry_of(TechniqueId id) {
    switch (id) {
    case TechniqueId::texture:
    case TechniqueId::bump:
    case TechniqueId::emboss:
    case TechniqueId::normal:
    case TechniqueId::prewarp:
        return Geometry::flat;
    case TechniqueId::polygons:
    case TechniqueId::automatic:
    case TechniqueId::displacement:
        return Geometry::full;
    default:
        return Geometry::box;
    }
}

bool searches_surface(TechniqueId id) {
    return geometry_of(id) == Geometry::box;
}

bool draws_triangles(TechniqueId id) {
    return id == TechniqueId::polygons || id == TechniqueId::automatic;
}

bool draws_terrain(TechniqueId id) {
    return id != TechniqueId::displacement && id != TechniqueId::bump &&
           id != TechniqueId::emboss && id != TechniqueId::normal && !searches_layers(id);
}

bool draws_any_mesh(TechniqueId id) {
    return id != TechniqueId::prewarp && id != TechniqueId::automatic;
}

bool searches_layers(TechniqueId id) {
    return id == TechniqueId::lattice || id == TechniqueId::dual_layer ||
           id == TechniqueId::multi_layer;
}

bool needs_plane(TechniqueId id) {
    return id == TechniqueId::prewarp;
}

bool is_faster_on_plane(TechniqueId id) {
    return searches_surface(id) || needs_plane(id);
}

bool is_two_sided(const Technique& technique) {
    return technique.options.two_sided || searches_layers(technique.id());
}

double error_bound(const Technique& technique) {
    if (const auto* const automatic = std::get_if<Automatic>(&technique.parameters)) {
        return automatic->error;
    }
    const auto* const polygons = std::get_if<Polygons>(&technique.parameters);
    return polygons == nullptr ? 0.0 : polygons->error;
}

const double* parallax_offset(const TechniqueParameters& parameters) {
    return offset_in(parameters);
}

double* parallax_offset(TechniqueParameters& parameters) {
    return offset_in(parameters);
}

Technique make_technique(TechniqueId id) {
    return {technique_info(id).defaults, {}};
}

Technique with_parameter(Technique technique, const ParameterInfo& parameter, double value) {
    for (const ParameterInfo& other : technique_info(technique.id()).parameters) {
        if (other.replaced_by == parameter.name ||
            (!parameter.replaced_by.empty() && other.name == parameter.replaced_by)) {
            other.set(technique, other.default_value);
        }
    }
    parameter.set(technique, value);
    return technique;
}

Result<Technique> parse_technique(std::string_view text) {
    auto [name, assignments] = split(text, ':');
    const TechniqueInfo* const info = named(technique_catalogue(), name);
    if (info == nullptr) {
        return Error{fmt::format("technique '{}' found, one of {} was expected", name,
                                 names_of(technique_catalogue()))};
    }
    Technique technique = make_technique(info->id);
    if (text.ends_with(':') || text.ends_with(',')) {
        return Error{fmt::format("technique '{}' found, key=value was expected at its end", text)};
    }
    std::vector<std::string_view> seen;
    while (!assignments.empty()) {
        if (auto set = assign(technique, take_assignment(assignments), seen); !set) {
            return set.error();
        }
    }
    return without_contradiction(technique);
}

std::string to_string(const Technique& technique) {
    const TechniqueInfo& info = technique_info(technique.id());
    std::string list;
    for (const ParameterInfo& parameter : info.parameters) {
        const bool is_usual = parameter.is_tacit && is_default(technique, parameter);
        if (!is_usual && !is_replaced(technique, parameter)) {
            list += fmt::format(",{}={}", parameter.name, parameter.get(technique));
        }
    }
    list += to_string(technique.options);
    return list.empty() ? std::string(info.name)
                        : fmt::format("{}:{}", info.name, std::string_view(list).substr(1));
}

} // namespace reljef::scene
