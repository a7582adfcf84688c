#include "engine/scene/technique/technique_options.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/scene/technique/technique.h"

namespace reljef::scene {
namespace {

template <auto option, auto member>
std::optional<double> option_number(const TechniqueOptions& options) {
    const auto& held = options.*option;
    return held ? std::optional(static_cast<double>((*held).*member)) : std::nullopt;
}

template <auto option, auto member>
void set_option_number(TechniqueOptions& options, double value) {
    auto& held = options.*option;
    check(held.has_value(), "a number of an option that is not there");
    auto& number = (*held).*member;
    number = static_cast<std::remove_reference_t<decltype(number)>>(value);
}

template <auto option, auto member> constexpr OptionNumberInfo number_row(NumberInfo row) {
    return {number_of(member, row), option_number<option, member>,
            set_option_number<option, member>};
}

constexpr auto steps_member = &TechniqueOptions::steps;
constexpr auto fade_member = &TechniqueOptions::fade;
constexpr std::array steps_numbers{
    number_row<steps_member, &StepRange::low>(
        {"min", 1.0, 4096.0, "equal steps in views from straight above"}),
    number_row<steps_member, &StepRange::high>(
        {"max", 1.0, 4096.0, "equal steps in views along the surface"})};
constexpr std::array fade_numbers{
    number_row<fade_member, &Fade::low>(
        {"min", 0.0, 1.0, "share of the heights in views along the surface"}),
    number_row<fade_member, &Fade::high>(
        {"max", 0.0, 1.0, "share of the heights in views from straight above"}),
    number_row<fade_member, &Fade::power>({.name = "k",
                                           .low = 1.0,
                                           .high = 64.0,
                                           .meaning = "exponent; larger values fade later",
                                           .is_tacit = true})};
constexpr std::array shadow_numbers{number_row<&TechniqueOptions::shadow, &Shadow::depth>(
    {"M", 0.001, 1.0, "soft: depth of full shadow, as a share of the height range"})};
constexpr std::array edges_numbers{number_row<&TechniqueOptions::smooth_edges,
                                              &SmoothEdges::distance>(
    {"E", 1e-6, 1.0,
     "smooth: distance over the surface at which blending ends, as a share of the height range"})};

constexpr std::array<std::string_view, 3> shadow_words{"none", "hard", "soft"};
constexpr std::array<std::string_view, 2> edges_words{"none", "smooth"};
constexpr std::array<std::string_view, 2> sides_words{"one", "two"};
constexpr std::array<std::string_view, 3> border_words{"wrap", "clamp", "discard"};
constexpr std::array<std::string_view, 3> depth_words{"objects", "none", "write"};
constexpr std::array<std::string_view, 2> silhouettes_words{"none", "true"};

// For an option that is off by default and on with the word at `place`.
template <auto option, std::size_t place>
std::optional<std::size_t> chosen_if_on(const TechniqueOptions& options) {
    return options.*option ? std::optional(place) : std::nullopt;
}

template <auto option, std::size_t place>
void switch_on(TechniqueOptions& options, std::optional<std::size_t> word) {
    auto& held = options.*option;
    if constexpr (std::is_same_v<decltype(held), bool&>) {
        held = word == place;
    } else if (word == place) {
        held.emplace();
    } else {
        held.reset();
    }
}

constexpr std::size_t hard_word = 1;
constexpr std::size_t soft_word = 2;

std::optional<std::size_t> chosen_shadow(const TechniqueOptions& options) {
    return options.shadow ? std::optional(options.shadow->depth == 0.0 ? hard_word : soft_word)
                          : std::nullopt;
}

void choose_shadow(TechniqueOptions& options, std::optional<std::size_t> word) {
    options.shadow.reset();
    if (word == hard_word) {
        options.shadow = Shadow{.depth = 0.0};
    } else if (word == soft_word) {
        options.shadow = Shadow{};
    }
}

// The words of `border` are in the order of WrapMode.
std::optional<std::size_t> chosen_border(const TechniqueOptions& options) {
    return options.border ? std::optional(static_cast<std::size_t>(*options.border)) : std::nullopt;
}

// The words of `depth` are in the order of HitDepth, the first is the default.
std::optional<std::size_t> chosen_depth(const TechniqueOptions& options) {
    const auto word = static_cast<std::size_t>(options.depth);
    return word > 0 ? std::optional(word) : std::nullopt;
}

void choose_depth(TechniqueOptions& options, std::optional<std::size_t> word) {
    options.depth = static_cast<HitDepth>(word.value_or(0));
}

void choose_border(TechniqueOptions& options, std::optional<std::size_t> word) {
    options.border = word ? std::optional(static_cast<material::WrapMode>(*word)) : std::nullopt;
}

std::string_view reason_without_ray(TechniqueId id) {
    return searches_surface(id)
               ? ""
               : "it does not search for the surface along a ray; relief and exact do";
}

std::string_view reason_without_path(TechniqueId id) {
    const bool is_parallax = id == TechniqueId::parallax || id == TechniqueId::parallax_limited ||
                             id == TechniqueId::parallax_iterated;
    return is_parallax ? "it follows no ray; relief and exact do" : reason_without_ray(id);
}

std::string_view reason_against_shadow(TechniqueId id) {
    const bool has_bound = id == TechniqueId::polygons || id == TechniqueId::automatic;
    return has_bound ? "" : reason_without_path(id);
}

std::string_view reason_against_steps(TechniqueId id) {
    if (!searches_surface(id)) {
        return reason_without_ray(id);
    }
    if (id == TechniqueId::pom) {
        return "its parameters min and max do the same";
    }
    if (searches_layers(id)) {
        return "its number of steps does not depend on the view; steep, relief and interval have "
               "the option";
    }
    const bool steps_equally =
        id == TechniqueId::steep || id == TechniqueId::relief || id == TechniqueId::interval;
    return steps_equally ? "" : "it makes no equal steps; steep, relief and interval do";
}

std::string_view reason_against_edges(TechniqueId id) {
    return searches_layers(id) ? "its rays may pass through holes; relief and exact have the option"
                               : reason_without_path(id);
}

std::string_view reason_against_sides(TechniqueId id) {
    return searches_layers(id) ? "it shows both sides already" : reason_without_ray(id);
}

std::string_view reason_against_border(TechniqueId id) {
    return searches_surface(id)
               ? ""
               : "it uses the border of the material; relief and exact have the option";
}

std::string_view reason_against_silhouettes_of(TechniqueId id) {
    return searches_layers(id)
               ? "its sheets have outlines already; relief and exact have the option"
               : reason_without_path(id);
}

constexpr std::array<OptionInfo, 8> option_infos{
    {{.name = "steps",
      .default_value = "those of the technique",
      .meaning = "number of equal steps by the view angle a: n = min + (max - min)(1 - cos a)",
      .source = "GPU surface-detail survey (2008) ch. 3.6.4",
      .numbers = steps_numbers,
      .chosen = chosen_if_on<steps_member, 0>,
      .choose = switch_on<steps_member, 0>,
      .reason_against = reason_against_steps},
     {.name = "fade",
      .default_value = "1..1",
      .meaning =
          "scale of the heights by the view angle a: s times min + (max - min)(1 - (1 - cos a)^k)",
      .source = "GPU surface-detail survey (2008) ch. 3.6.4",
      .numbers = fade_numbers,
      .chosen = chosen_if_on<fade_member, 0>,
      .choose = switch_on<fade_member, 0>,
      .reason_against = reason_without_ray},
     {.name = "shadow",
      .default_value = "none",
      .meaning =
          "a ray from the hit to the sun. hard: shadow if it hits the surface; soft: 1 - p/M of "
          "the light at its deepest penetration p; none: shadows computed once for all views",
      .source = "GPU surface-detail survey (2008) ch. 3.6.5-6; Policarpo, Oliveira and Comba 2005",
      .words = shadow_words,
      .numbers = shadow_numbers,
      .chosen = chosen_shadow,
      .choose = choose_shadow,
      .reason_against = reason_against_shadow},
     {.name = "edges",
      .default_value = "none",
      .meaning = "smooth: blends the hit with the nearest surface point within E of the ray, by "
                 "distance/E",
      .source = "GPU surface-detail survey (2008) ch. 3.6.7",
      .words = edges_words,
      .numbers = edges_numbers,
      .chosen = chosen_if_on<&TechniqueOptions::smooth_edges, 1>,
      .choose = switch_on<&TechniqueOptions::smooth_edges, 1>,
      .reason_against = reason_against_edges},
     {.name = "sides",
      .default_value = "one",
      .meaning = "two: also draws the back, with inverted heights and negated normals",
      .source = "GPU surface-detail survey (2008) ch. 3.6.8",
      .words = sides_words,
      .chosen = chosen_if_on<&TechniqueOptions::two_sided, 1>,
      .choose = switch_on<&TechniqueOptions::two_sided, 1>,
      .reason_against = reason_against_sides},
     {.name = "border",
      .default_value = "that of the material",
      .meaning = "beyond the detail texture: wrap repeats it, clamp stretches its border, discard "
                 "shows nothing",
      .words = border_words,
      .chosen = chosen_border,
      .choose = choose_border,
      .reason_against = reason_against_border},
     {.name = "depth",
      .default_value = "objects",
      .meaning = "write: writes the depth of the hit, so that ground hides objects behind it; "
                 "objects: on a terrain, if objects are in the view",
      .words = depth_words,
      .chosen = chosen_depth,
      .choose = choose_depth,
      .reason_against = reason_without_ray},
     {.name = "silhouettes",
      .default_value = "none",
      .meaning =
          "true: rays start at a hull around the mesh, so the relief has its own outline and depth",
      .source = "Hirche, Ehlert, Guthe and Doggett 2004; Porumbescu, Budge, Feng and Joy 2005",
      .words = silhouettes_words,
      .chosen = chosen_if_on<&TechniqueOptions::true_silhouettes, 1>,
      .choose = switch_on<&TechniqueOptions::true_silhouettes, 1>,
      .reason_against = reason_against_silhouettes_of}}};

static_assert(std::all_of(option_infos.begin(), option_infos.end(),
                          [](const OptionInfo& info) {
                              return std::all_of(info.numbers.begin(), info.numbers.end(),
                                                 [](const OptionNumberInfo& number) {
                                                     return number.allows(number.default_value);
                                                 });
                          }),
              "every default lies in its range");

// key=value,more
struct Assignment {
    std::string_view key;
    std::string_view value;
    std::optional<std::string_view> more;
};

std::pair<std::string_view, std::optional<std::string_view>> cut(std::string_view text,
                                                                 std::string_view separator) {
    const auto at = text.find(separator);
    return at == std::string_view::npos
               ? std::pair{text, std::optional<std::string_view>{}}
               : std::pair{text.substr(0, at), std::optional(text.substr(at + separator.size()))};
}

Assignment assignment_of(std::string_view text) {
    const auto [key, rest] = cut(text, "=");
    const auto [value, more] = cut(rest.value_or(""), ",");
    return {key, value, more};
}

Error unexpected(const OptionInfo& info, const Assignment& found) {
    return Error{fmt::format(
        "option {}: {}={}{} found, {}={} was expected", info.name, info.name, found.value,
        found.more ? fmt::format(",{}", *found.more) : std::string(), info.name, form_of(info))};
}

// The numbers after the range or the last word.
std::span<const OptionNumberInfo> numbers_after(const OptionInfo& info) {
    return info.words.empty() ? info.numbers.subspan(2) : info.numbers;
}

Result<double> number_in(const OptionInfo& info, const OptionNumberInfo& number,
                         std::string_view text) {
    return parse_number(fmt::format("option {}", info.name), number, text);
}

// Sets the number after a word or a range. Precondition: the option has one if `found.more`.
Result<void> set_after(TechniqueOptions& options, const OptionInfo& info, const Assignment& found) {
    if (!found.more) {
        return {};
    }
    const OptionNumberInfo& number = numbers_after(info).front();
    const auto value = number_in(info, number, *found.more);
    if (!value) {
        return value.error();
    }
    number.set(options, *value);
    return {};
}

Result<void> set_range(TechniqueOptions& options, const OptionInfo& info, const Assignment& found) {
    const auto [low_text, high_text] = cut(found.value, "..");
    if (!high_text) {
        return unexpected(info, found);
    }
    const OptionNumberInfo& low = info.numbers[0];
    const OptionNumberInfo& high = info.numbers[1];
    const auto low_value = number_in(info, low, low_text);
    const auto high_value = number_in(info, high, *high_text);
    if (!low_value || !high_value) {
        return low_value ? high_value.error() : low_value.error();
    }
    if (*low_value > *high_value) {
        return Error{fmt::format("option {}: {}..{} found, the smaller number first was expected",
                                 info.name, low_text, *high_text)};
    }
    if (found.more && numbers_after(info).empty()) {
        return unexpected(info, found);
    }
    info.choose(options, 0);
    low.set(options, *low_value);
    high.set(options, *high_value);
    return set_after(options, info, found);
}

Result<void> set_word(TechniqueOptions& options, const OptionInfo& info, const Assignment& found) {
    const auto at = std::find(info.words.begin(), info.words.end(), found.value);
    const auto word = static_cast<std::size_t>(at - info.words.begin());
    const bool may_have_more = !info.numbers.empty() && word + 1 == info.words.size();
    if (word == info.words.size() || (found.more && !may_have_more)) {
        return unexpected(info, found);
    }
    info.choose(options, word);
    return set_after(options, info, found);
}

const OptionInfo* option_named(std::string_view name) {
    const auto* const found =
        std::find_if(option_infos.begin(), option_infos.end(),
                     [&](const OptionInfo& info) { return info.name == name; });
    return found == option_infos.end() ? nullptr : found;
}

// The text of an option that differs from its default.
std::string value_text(const OptionInfo& info, std::size_t word, const TechniqueOptions& options) {
    const bool is_range = info.words.empty();
    std::string text = is_range ? fmt::format("{}..{}", *info.numbers[0].get(options),
                                              *info.numbers[1].get(options))
                                : std::string(info.words[word]);
    if (!is_range && word + 1 < info.words.size()) {
        return text;
    }
    for (const OptionNumberInfo& number : numbers_after(info)) {
        const double value = *number.get(options);
        const bool is_usual = number.is_tacit && value == number.default_value;
        text += is_usual ? "" : fmt::format(",{}", value);
    }
    return text;
}

} // namespace

void OptionNumberInfo::set(TechniqueOptions& options, double value) const {
    check(allows(value), "a number of an option out of its range");
    setter(options, value);
}

std::span<const OptionInfo> option_catalogue() {
    return option_infos;
}

std::string form_of(const OptionInfo& info) {
    std::string form = info.words.empty()
                           ? fmt::format("{}..{}", info.numbers[0].name, info.numbers[1].name)
                           : fmt::format("{}", fmt::join(info.words, "|"));
    for (const OptionNumberInfo& number : numbers_after(info)) {
        form += fmt::format("[,{}]", number.name);
    }
    return form;
}

std::vector<OptionInfo> options_of(TechniqueId id) {
    std::vector<OptionInfo> taken;
    std::copy_if(option_infos.begin(), option_infos.end(), std::back_inserter(taken),
                 [&](const OptionInfo& info) { return info.reason_against(id).empty(); });
    return taken;
}

bool is_option(std::string_view assignment) {
    return option_named(assignment_of(assignment).key) != nullptr;
}

Result<void> set_option(TechniqueOptions& options, TechniqueId id, std::string_view assignment) {
    const Assignment found = assignment_of(assignment);
    const OptionInfo& info =
        checked_pointer(option_named(found.key), "set_option of what is no option");
    const auto reason = info.reason_against(id);
    if (!reason.empty()) {
        return Error{fmt::format("technique {}: option '{}' found, {}", technique_info(id).name,
                                 found.key, reason)};
    }
    TechniqueOptions changed = options;
    auto set =
        info.words.empty() ? set_range(changed, info, found) : set_word(changed, info, found);
    if (set) {
        options = changed;
    }
    return set;
}

std::string to_string(const TechniqueOptions& options) {
    std::string text;
    for (const OptionInfo& info : option_infos) {
        if (const auto word = info.chosen(options)) {
            text += fmt::format(",{}={}", info.name, value_text(info, *word, options));
        }
    }
    return text;
}

std::vector<OptionNumber> option_numbers(const TechniqueOptions& options) {
    std::vector<OptionNumber> numbers;
    for (const OptionInfo& info : option_infos) {
        const auto word = info.chosen(options);
        if (word && info.numbers.empty()) {
            numbers.push_back({std::string(info.name), static_cast<double>(*word)});
        }
        for (const OptionNumberInfo& number : info.numbers) {
            if (const auto value = number.get(options)) {
                numbers.push_back({fmt::format("{}.{}", info.name, number.name), *value});
            }
        }
    }
    return numbers;
}

} // namespace reljef::scene
