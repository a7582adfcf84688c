#include "engine/scene/technique/technique.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reljef::scene {
namespace {

constexpr std::array<ParameterInfo, 3> polygons_parameters{
    {{"lods", 1.0, 1.0, 5.0, true,
      "levels of detail at most, by distance; 1: every sample is a vertex"},
     {"error", 0.0, 0.0, most_polygons_error, false,
      "pixels that no pixel is farther from where it belongs, instead of levels; 0: by levels",
      true, least_polygons_error},
     {"morph", 0.0, 0.0, 1.0, true,
      "with error, 1: vertices rise to their places as the view nears, so that nothing jumps",
      true}}};

constexpr ParameterInfo offset_parameter{
    "offset",
    -0.5,
    -1.0,
    0.0,
    false,
    "where the reference plane lies: 0 lowest, -1 highest height; a mesh lies at its material's"};
constexpr std::array<ParameterInfo, 1> parallax_parameters{offset_parameter};
constexpr std::array<ParameterInfo, 2> iterated_parameters{
    offset_parameter, {"k", 3.0, 1.0, 64.0, true, "times the height is looked at again"}};
constexpr std::array<ParameterInfo, 1> steep_parameters{
    {{"n", 32.0, 1.0, 4096.0, true, "equal steps along the ray"}}};
constexpr std::array<ParameterInfo, 2> relief_parameters{
    {{"n", 11.0, 1.0, 4096.0, true, "equal steps along the ray"},
     {"k", 8.0, 0.0, 32.0, true, "times the bracket is halved"}}};
constexpr std::array<ParameterInfo, 2> interval_parameters{
    {{"n", 14.0, 1.0, 4096.0, true, "equal steps along the ray"},
     {"k", 2.0, 1.0, 32.0, true, "chords drawn through the bracket"}}};
constexpr std::array<ParameterInfo, 2> pom_parameters{
    {{"min", 8.0, 1.0, 4096.0, true, "equal steps seen from straight above"},
     {"max", 32.0, 1.0, 4096.0, true, "equal steps seen along the ground"}}};
constexpr std::array<ParameterInfo, 1> displacement_parameters{
    {{"texels", 4.0, 1.0, 256.0, false, "of the heights between two vertices, at most"}}};
constexpr std::array<ParameterInfo, 1> emboss_parameters{
    {{"delta", 1.5, 0.25, 64.0, false, "texels towards the light to the second height"}}};

constexpr std::array<ParameterInfo, 4> cone_parameters{
    {{"relaxed", 1.0, 0.0, 1.0, true, "1: cones that a ray may meet the surface in once"},
     {"n", 32.0, 1.0, 4096.0, true, "cones at the most"},
     {"k", 2.0, 0.0, 32.0, true, "times the bracket is halved before the chord"},
     {"step", 1.5, 0.0, 16.0, false, "samples a step goes at least; 0: passes over nothing"}}};

constexpr std::array<ParameterInfo, 2> layers_parameters{
    {{"n", 32.0, 1.0, 4096.0, true, "equal steps along the ray"},
     {"k", 6.0, 0.0, 32.0, true, "times the bracket is halved before the chord"}}};

constexpr std::array<TechniqueInfo, 19> catalogue{
    {{TechniqueId::texture,
      "texture",
      "diffuse colour over the flat reference surface, lit by the height gradient",
      "GPU surface-detail survey (2008) ch. 1; Janković 2010 ch. 2",
      {}},
     {TechniqueId::polygons, "polygons",
      "the heightfield as triangles: all, fewer by distance, or as few as an error allows",
      "Janković 2010 ch. 2.7 test 4; Lindstrom and Pascucci 2001", polygons_parameters},
     {TechniqueId::displacement, "displacement",
      "a mesh cut fine, its vertices moved along the normal by the height",
      "GPU surface-detail survey (2008) ch. 3.1; Cook 1984", displacement_parameters},
     {TechniqueId::bump,
      "bump",
      "a mesh lit by the height's derivatives: N + F_u (N x P_v) - F_v (N x P_u)",
      "Janković 2010 ch. 2.2; Blinn 1978",
      {}},
     {TechniqueId::emboss, "emboss",
      "h(t) - h(t + delta l.xy) added to a mesh's diffuse light; nothing shines",
      "GPU surface-detail survey (2008) ch. 3.3; Schlag 1994", emboss_parameters},
     {TechniqueId::normal,
      "normal",
      "a mesh lit by its normal map, with half vector and ambient light",
      "GPU surface-detail survey (2008) ch. 3.4; Cohen, Olano and Manocha 1998",
      {}},
     {TechniqueId::parallax, "parallax",
      "one look at the height shifts the place along the ray: t + (h + b) s v.xy / v.z",
      "Janković 2010 ch. 2.3; Kaneko et al. 2001", parallax_parameters},
     {TechniqueId::parallax_limited, "parallax-limited",
      "parallax with offset limiting: t + (h + b) s v.xy",
      "GPU surface-detail survey (2008) ch. 3.5; Welsh 2004", parallax_parameters},
     {TechniqueId::parallax_iterated, "parallax-iterated",
      "parallax looked at again from where it led, the heights averaged",
      "GPU surface-detail survey (2008) ch. 3.5", iterated_parameters},
     {TechniqueId::steep, "steep", "equal steps along the ray until one lies below the surface",
      "GPU surface-detail survey (2008) ch. 3.6.1; McGuire and McGuire 2005", steep_parameters},
     {TechniqueId::relief, "relief", "equal steps, then the bracket halved",
      "Janković 2010 ch. 2.4.6; Policarpo, Oliveira and Comba 2005", relief_parameters},
     {TechniqueId::interval, "interval", "equal steps, then chords through the bracket",
      "Janković 2010 ch. 2.4.9; Risser, Shah and Pattanaik 2006", interval_parameters},
     {TechniqueId::pom, "pom", "steps by the angle of view, then one chord",
      "Janković 2010 ch. 2.3.3; Tatarchuk 2005", pom_parameters},
     {TechniqueId::cone, "cone", "from cone to cone that holds nothing, or one crossing",
      "Dummer 2006; Policarpo and Oliveira 2007 (GPU Gems 3 ch. 18)", cone_parameters},
     {TechniqueId::exact,
      "exact",
      "the ray against the bilinear surface itself: the true first hit",
      "Tevs, Ihrke and Seidel 2008",
      {}},
     {TechniqueId::lattice, "lattice",
      "a mesh as a sheet with its heights on both sides of it: height 0 is a hole",
      "GPU surface-detail survey (2008) ch. 3.6.9", layers_parameters},
     {TechniqueId::dual_layer, "dual-layer",
      "a mesh as a sheet with one height map on its front and another on its back",
      "GPU surface-detail survey (2008) ch. 3.6.10", layers_parameters},
     {TechniqueId::multi_layer, "multi-layer",
      "a mesh as two solids, one over the other: four heights a place",
      "GPU surface-detail survey (2008) ch. 3.6.11; Policarpo and Oliveira 2006",
      layers_parameters},
     {TechniqueId::prewarp,
      "prewarp",
      "the surface warped forward onto the reference plane, rows and then columns, each frame: "
      "(u + k1 d)/(1 + k3 d), (v + k2 d)/(1 + k3 d)",
      "Janković 2010 ch. 2.4.1-5; Oliveira, Bishop and McAllister 2000",
      {}}}};

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
    const auto value = parse_number(fmt::format("technique {}", info.name), *parameter, text);
    if (!value) {
        return value.error();
    }
    technique.values[static_cast<std::size_t>(parameter - info.parameters.data())] = *value;
    return {};
}

// Takes the next assignment off the list: up to a comma, or, of an option, up to the comma before
// the next '='.
std::string_view take_assignment(std::string_view& list) {
    auto end = std::min(list.find(','), list.size());
    if (is_option(list.substr(0, end)) && end < list.size()) {
        const auto next = std::min(list.find(',', end + 1), list.size());
        const bool belongs = list.substr(end, next - end).find('=') == std::string_view::npos;
        end = belongs ? next : end;
    }
    const auto assignment = list.substr(0, end);
    list = list.substr(std::min(end + 1, list.size()));
    return assignment;
}

// Sets a parameter or an option; `seen` are the options set so far.
Result<void> assign(Technique& technique, std::string_view assignment,
                    std::vector<std::string_view>& seen) {
    const auto name = split(assignment, '=').first;
    if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
        return Error{fmt::format("technique {}: '{}' found twice, once was expected",
                                 technique_info(technique.id).name, name)};
    }
    seen.push_back(name);
    return is_option(assignment) ? set_option(technique.options, technique.id, assignment)
                                 : set_parameter(technique, assignment);
}

// Levels that an error takes the place of.
bool is_replaced(const Technique& technique, const ParameterInfo& known) {
    return technique.id == TechniqueId::polygons && known.name == "lods" &&
           parameter(technique, "error") > 0.0;
}

// What no parameter shows by itself.
Result<Technique> without_contradiction(Technique technique) {
    if (technique.id == TechniqueId::polygons && parameter(technique, "error") > 0.0 &&
        parameter(technique, "lods") > 1.0) {
        return Error{"technique polygons: lods and error found, one of them was expected"};
    }
    return technique;
}

std::size_t index_of(const TechniqueInfo& info, std::string_view name) {
    const auto found =
        std::find_if(info.parameters.begin(), info.parameters.end(),
                     [&](const ParameterInfo& parameter) { return parameter.name == name; });
    check(found != info.parameters.end(), "a technique without that parameter");
    return static_cast<std::size_t>(found - info.parameters.begin());
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

std::vector<TechniqueInfo> terrain_techniques() {
    std::vector<TechniqueInfo> infos;
    std::copy_if(catalogue.begin(), catalogue.end(), std::back_inserter(infos),
                 [](const TechniqueInfo& info) { return draws_terrain(info.id); });
    return infos;
}

Geometry geometry_of(TechniqueId id) {
    switch (id) {
    case TechniqueId::texture:
    case TechniqueId::bump:
    case TechniqueId::emboss:
    case TechniqueId::normal:
    case TechniqueId::prewarp:
        return Geometry::flat;
    case TechniqueId::polygons:
    case TechniqueId::displacement:
        return Geometry::full;
    default:
        return Geometry::box;
    }
}

bool looks_for_surface(TechniqueId id) {
    return geometry_of(id) == Geometry::box;
}

bool draws_terrain(TechniqueId id) {
    return id != TechniqueId::displacement && id != TechniqueId::bump &&
           id != TechniqueId::emboss && id != TechniqueId::normal && !looks_for_layers(id);
}

bool draws_any_mesh(TechniqueId id) {
    return id != TechniqueId::prewarp;
}

bool looks_for_layers(TechniqueId id) {
    return id == TechniqueId::lattice || id == TechniqueId::dual_layer ||
           id == TechniqueId::multi_layer;
}

bool needs_plane(TechniqueId id) {
    return geometry_of(id) == Geometry::box || id == TechniqueId::prewarp;
}

double parameter(const Technique& technique, std::string_view name) {
    return technique.values[index_of(technique_info(technique.id), name)];
}

Technique with_parameter(Technique technique, std::string_view name, double value) {
    const TechniqueInfo& info = technique_info(technique.id);
    const std::size_t index = index_of(info, name);
    check(value >= info.parameters[index].low && value <= info.parameters[index].high,
          "a parameter out of its range");
    technique.values[index] = value;
    return technique;
}

bool is_two_sided(const Technique& technique) {
    return technique.options.two_sided || looks_for_layers(technique.id);
}

Technique make_technique(TechniqueId id) {
    Technique technique{id, {}, {}};
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
    std::vector<std::string_view> seen;
    while (!assignments.empty()) {
        if (auto set = assign(technique, take_assignment(assignments), seen); !set) {
            return set.error();
        }
    }
    return without_contradiction(std::move(technique));
}

std::string to_string(const Technique& technique) {
    const TechniqueInfo& info = technique_info(technique.id);
    std::string list;
    for (std::size_t i = 0; i < info.parameters.size(); ++i) {
        const ParameterInfo& known = info.parameters[i];
        const bool is_usual = known.is_tacit && technique.values[i] == known.default_value;
        if (!is_usual && !is_replaced(technique, known)) {
            list += fmt::format(",{}={}", known.name, technique.values[i]);
        }
    }
    list += to_string(technique.options);
    return list.empty() ? std::string(info.name)
                        : fmt::format("{}:{}", info.name, std::string_view(list).substr(1));
}

} // namespace reljef::scene
