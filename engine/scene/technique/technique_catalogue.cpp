#include "engine/scene/technique/technique_catalogue.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "engine/scene/technique/technique.h"

namespace reljef::scene {
namespace {

template <class Owner, class Value> Owner owner_of(Value Owner::*member);
template <class Owner, class Value> Value value_of(Value Owner::*member);

template <auto member> double parameter_value(const Technique& technique) {
    const auto& held =
        checked_pointer(std::get_if<decltype(owner_of(member))>(&technique.parameters),
                        "a parameter of another technique");
    return static_cast<double>(held.*member);
}

template <auto member> void set_parameter_value(Technique& technique, double value) {
    auto& held = checked_pointer(std::get_if<decltype(owner_of(member))>(&technique.parameters),
                                 "a parameter of another technique");
    held.*member = static_cast<decltype(value_of(member))>(value);
}

template <auto member>
constexpr ParameterInfo parameter_row(NumberInfo row, std::string_view replaced_by = {}) {
    return {number_of(member, row), replaced_by, parameter_value<member>,
            set_parameter_value<member>};
}

constexpr double max_step_count = 4096.0;
constexpr double max_halvings = 32.0;

constexpr std::array polygons_parameters{
    parameter_row<&Polygons::max_levels>(
        {"lods", 1.0, 5.0,
         "maximum number of levels of detail, chosen by distance; 1 draws every sample"},
        "error"),
    parameter_row<&Polygons::error>({.name = "error",
                                     .high = max_polygons_error,
                                     .meaning = "error bound, pixels; 0: levels by distance (lods)",
                                     .is_tacit = true,
                                     .min_above_low = min_polygons_error}),
    parameter_row<&Polygons::morph>(
        {.name = "morph",
         .high = 1.0,
         .meaning = "1: vertices move gradually when the level changes (geomorphing); needs error",
         .is_tacit = true})};

template <class Kind>
constexpr ParameterInfo offset_parameter =
    parameter_row<&Kind::offset>({"offset", -1.0, 0.0,
                                  "height of the reference plane: 0 the lowest, -1 the highest "
                                  "sample; meshes use that of their material"});

constexpr std::array parallax_parameters{offset_parameter<Parallax>};
constexpr std::array limited_parameters{offset_parameter<ParallaxLimited>};
constexpr std::array iterated_parameters{
    offset_parameter<ParallaxIterated>,
    parameter_row<&ParallaxIterated::iterations>({"k", 1.0, 64.0, "parallax steps"})};

template <class Kind>
constexpr ParameterInfo linear_steps_parameter =
    parameter_row<&Kind::linear_steps>({"n", 1.0, max_step_count, "equal steps along the ray"});

constexpr std::array steep_parameters{linear_steps_parameter<Steep>};
constexpr std::array relief_parameters{
    linear_steps_parameter<Relief>,
    parameter_row<&Relief::bisection_steps>({"k", 0.0, max_halvings, "binary search steps"})};
constexpr std::array interval_parameters{
    linear_steps_parameter<Interval>,
    parameter_row<&Interval::secant_steps>({"k", 1.0, 32.0, "secant steps"})};
constexpr std::array pom_parameters{
    parameter_row<&Pom::min_steps>(
        {"min", 1.0, max_step_count, "equal steps in views from straight above"}),
    parameter_row<&Pom::max_steps>(
        {"max", 1.0, max_step_count, "equal steps in views along the surface"})};

template <class Kind>
constexpr ParameterInfo halvings_parameter = parameter_row<&Kind::bisection_steps>(
    {"k", 0.0, max_halvings, "binary search steps before the secant step"});

constexpr std::array cone_parameters{
    parameter_row<&Cone::relaxed>(
        {"relaxed", 0.0, 1.0, "1: relaxed cones, in which a ray meets the surface at most once"}),
    parameter_row<&Cone::max_steps>({"n", 1.0, max_step_count, "maximum number of cone steps"}),
    halvings_parameter<Cone>,
    parameter_row<&Cone::min_step>({"step", 0.0, 16.0, "minimum step, samples; 0 misses nothing"})};

template <class Kind>
constexpr std::array layers_parameters{linear_steps_parameter<Kind>, halvings_parameter<Kind>};

constexpr std::array displacement_parameters{parameter_row<&Displacement::max_texels>(
    {"texels", 1.0, 256.0, "maximum number of height texels between two vertices"})};
constexpr std::array emboss_parameters{parameter_row<&Emboss::delta>(
    {"delta", 0.25, 64.0, "distance to the second height, towards the light, texels"})};

constexpr std::array automatic_parameters{
    parameter_row<&Automatic::error>({"error", min_polygons_error, max_polygons_error,
                                      "error bound, pixels; exact has no error"}),
    parameter_row<&Automatic::typical>(
        {.name = "typical",
         .high = 1.0,
         .meaning =
             "1: also unproven searches that show nine of ten probed pixels within the bound",
         .is_tacit = true})};

template <class Kind>
constexpr TechniqueInfo technique_row(std::string_view name, std::string_view meaning,
                                      std::string_view source,
                                      std::span<const ParameterInfo> parameters = {}) {
    const TechniqueParameters defaults = Kind{};
    const auto id = static_cast<TechniqueId>(defaults.index());
    return {id, name, meaning, source, defaults, parameters};
}

constexpr std::array catalogue{
    technique_row<Texture>(
        "texture", "diffuse colour over the flat reference surface, lit by the height gradient",
        "GPU surface-detail survey (2008) ch. 1; Janković 2010 ch. 2"),
    technique_row<Polygons>(
        "polygons",
        "the heightfield as triangles: all, fewer by distance, or as few as an error allows",
        "Janković 2010 ch. 2.7 test 4; Lindstrom and Pascucci 2001", polygons_parameters),
    technique_row<Displacement>(
        "displacement", "a fine mesh; each vertex moves along its normal by the height",
        "GPU surface-detail survey (2008) ch. 3.1; Cook 1984", displacement_parameters),
    technique_row<Bump>("bump",
                        "a mesh lit by the height's derivatives: N + F_u (N x P_v) - F_v (N x P_u)",
                        "Janković 2010 ch. 2.2; Blinn 1978"),
    technique_row<Emboss>(
        "emboss", "h(t) - h(t + delta l.xy) added to a mesh's diffuse light; nothing shines",
        "GPU surface-detail survey (2008) ch. 3.3; Schlag 1994", emboss_parameters),
    technique_row<Normal>(
        "normal", "a mesh lit by its normal map, with half vector and ambient light",
        "GPU surface-detail survey (2008) ch. 3.4; Cohen, Olano and Manocha 1998"),
    technique_row<Parallax>(
        "parallax",
        "one height lookup shifts the texture coordinate along the ray: t + (h + b) s v.xy / v.z",
        "Janković 2010 ch. 2.3; Kaneko et al. 2001", parallax_parameters),
    technique_row<ParallaxLimited>(
        "parallax-limited", "parallax with offset limiting: t + (h + b) s v.xy",
        "GPU surface-detail survey (2008) ch. 3.5; Welsh 2004", limited_parameters),
    technique_row<ParallaxIterated>(
        "parallax-iterated", "repeated parallax steps with averaged heights",
        "GPU surface-detail survey (2008) ch. 3.5", iterated_parameters),
    technique_row<Steep>(
        "steep", "linear search: equal steps along the ray until one is below the surface",
        "GPU surface-detail survey (2008) ch. 3.6.1; McGuire and McGuire 2005", steep_parameters),
    technique_row<Relief>("relief", "linear search, then binary search",
                          "Janković 2010 ch. 2.4.6; Policarpo, Oliveira and Comba 2005",
                          relief_parameters),
    technique_row<Interval>("interval", "linear search, then secant steps",
                            "Janković 2010 ch. 2.4.9; Risser, Shah and Pattanaik 2006",
                            interval_parameters),
    technique_row<Pom>("pom", "linear search with steps by the view angle, then one secant step",
                       "Janković 2010 ch. 2.3.3; Tatarchuk 2005", pom_parameters),
    technique_row<Cone>("cone",
                        "cone stepping: each step stays inside an empty cone, or inside a relaxed "
                        "cone with one crossing",
                        "Dummer 2006; Policarpo and Oliveira 2007 (GPU Gems 3 ch. 18)",
                        cone_parameters),
    technique_row<Exact>("exact", "the true first hit of the ray with the bilinear surface",
                         "Tevs, Ihrke and Seidel 2008"),
    technique_row<Lattice>(
        "lattice", "a mesh as a sheet with its heights on both sides of it: height 0 is a hole",
        "GPU surface-detail survey (2008) ch. 3.6.9", layers_parameters<Lattice>),
    technique_row<DualLayer>(
        "dual-layer", "a mesh as a sheet with one height map on its front and another on its back",
        "GPU surface-detail survey (2008) ch. 3.6.10", layers_parameters<DualLayer>),
    technique_row<MultiLayer>(
        "multi-layer", "a mesh as two solid layers, with four heights per texel",
        "GPU surface-detail survey (2008) ch. 3.6.11; Policarpo and Oliveira 2006",
        layers_parameters<MultiLayer>),
    technique_row<Prewarp>("prewarp",
                           "the surface, warped forward onto the reference plane in each frame, "
                           "rows first, then columns: "
                           "(u + k1 d)/(1 + k3 d), (v + k2 d)/(1 + k3 d)",
                           "Janković 2010 ch. 2.4.1-5; Oliveira, Bishop and McAllister 2000"),
    technique_row<Automatic>(
        "auto",
        "in each view the cheapest of what keeps an error bound: triangles for near tiles, exact "
        "for all behind them, or one of both for all",
        "Janković 2010, conclusion", automatic_parameters)};

static_assert(catalogue.size() == std::variant_size_v<TechniqueParameters>);
constexpr auto last_index = static_cast<std::size_t>(TechniqueId::automatic);
static_assert(
    std::is_same_v<std::variant_alternative_t<last_index, TechniqueParameters>, Automatic>);
static_assert(std::all_of(catalogue.begin(), catalogue.end(),
                          [](const TechniqueInfo& info) {
                              return std::all_of(info.parameters.begin(), info.parameters.end(),
                                                 [](const ParameterInfo& parameter) {
                                                     return parameter.allows(
                                                         parameter.default_value);
                                                 });
                          }),
              "every default lies in its range");

} // namespace

namespace {

constexpr double steps_across = 40.0; // of a range
constexpr double part_of_value = 0.1; // a step of a wide range
constexpr double wide = 100.0;        // highest value over the lowest

double step_of(const NumberInfo& number, double value) {
    const double lowest = std::max(number.low, number.min_above_low);
    const bool is_wide = lowest > 0.0 && number.high >= wide * lowest;
    const double step = is_wide ? std::max(part_of_value * value, part_of_value * lowest)
                                : (number.high - number.low) / steps_across;
    return number.whole ? std::max(1.0, std::floor(step)) : step;
}

} // namespace

double nearest_allowed(const NumberInfo& number, double value) {
    if (std::isnan(value)) {
        return number.default_value;
    }
    const double inside = std::clamp(value, number.low, number.high);
    const double gap_end = std::max(number.min_above_low, number.low);
    if (inside < gap_end) {
        return inside - number.low < gap_end - inside ? number.low : gap_end;
    }
    return number.whole ? std::round(inside) : inside;
}

double stepped(const NumberInfo& number, double value, int steps) {
    double reached = value;
    for (int i = 0; i < std::abs(steps); ++i) {
        const double step = step_of(number, reached);
        const double moved = steps > 0 ? reached + step : reached - step;
        double allowed = nearest_allowed(number, moved);
        if (allowed == reached && number.min_above_low > number.low) { // over the gap
            allowed = steps > 0 && reached == number.low ? number.min_above_low : allowed;
            allowed = steps < 0 && reached == number.min_above_low ? number.low : allowed;
        }
        reached = allowed;
    }
    return reached;
}

Result<double> parse_number(std::string_view subject, const NumberInfo& number,
                            std::string_view text) {
    double value = 0.0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = code == std::errc{} && end == text.data() + text.size();
    if (!is_number || !number.allows(value)) {
        const bool has_gap = number.min_above_low > number.low;
        return Error{fmt::format("{}: {}={} found, {}a {}number from {} to {} was expected",
                                 subject, number.name, text,
                                 has_gap ? fmt::format("{} or ", number.low) : std::string(),
                                 number.whole ? "whole " : "",
                                 has_gap ? number.min_above_low : number.low, number.high)};
    }
    return value;
}

void ParameterInfo::set(Technique& technique, double value) const {
    check(allows(value), "a parameter out of its range");
    setter(technique, value);
}

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

} // namespace reljef::scene
