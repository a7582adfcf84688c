#include "engine/scene/technique/technique_options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/scene/technique/technique.h"

namespace reljef::scene {
namespace {

constexpr std::array<ParameterInfo, 2> steps_numbers{
    {{"min", 8.0, 1.0, 4096.0, true, "equal steps seen from straight above"},
     {"max", 32.0, 1.0, 4096.0, true, "equal steps seen along the ground"}}};
constexpr std::array<ParameterInfo, 3> fade_numbers{
    {{"min", 0.0, 0.0, 1.0, false, "of the heights, seen along the ground"},
     {"max", 1.0, 0.0, 1.0, false, "of the heights, seen from straight above"},
     {"k", 1.0, 1.0, 64.0, false, "the greater, the later they fade"}}};
constexpr std::array<ParameterInfo, 1> shadow_numbers{
    {{"M", 0.2, 0.001, 1.0, false,
      "soft: how deep in the surface, of the range of heights, a ray has no light left"}}};
constexpr std::array<ParameterInfo, 1> edges_numbers{
    {{"E", 0.005, 1e-6, 1.0, false,
      "smooth: over the surface, of the range of heights, where a ray shows nothing of it"}}};

constexpr std::array<std::string_view, 3> shadow_words{"none", "hard", "soft"};
constexpr std::array<std::string_view, 2> edges_words{"none", "smooth"};
constexpr std::array<std::string_view, 2> sides_words{"one", "two"};
constexpr std::array<std::string_view, 3> border_words{"wrap", "clamp", "discard"};
constexpr std::array<std::string_view, 2> depth_words{"none", "write"};
constexpr std::array<std::string_view, 2> silhouettes_words{"none", "true"};

constexpr OptionInfo steps_info{
    "steps",
    "min..max",
    "as many as the technique has",
    "equal steps by the angle of view: n = min + (max - min)(1 - cos a)",
    "GPU surface-detail survey (2008) ch. 3.6.4",
    steps_numbers};
constexpr OptionInfo fade_info{
    "fade",
    "min..max[,k]",
    "1..1",
    "heights by the angle of view: s times min + (max - min)(1 - (1 - cos a)^k)",
    "GPU surface-detail survey (2008) ch. 3.6.4",
    fade_numbers};
constexpr OptionInfo shadow_info{
    "shadow",
    "none|hard|soft[,M]",
    "none",
    "a ray from the hit to the sun: hard, lit where it meets nothing; soft, 1 - p/M of the light "
    "at "
    "its deepest penetration p; none, shadows as computed once for all views",
    "GPU surface-detail survey (2008) ch. 3.6.5-6; Policarpo, Oliveira and Comba 2005",
    shadow_numbers};
constexpr OptionInfo edges_info{
    "edges",
    "none|smooth[,E]",
    "none",
    "the nearest place that the ray passes by less than E is blended into the one it hits, by "
    "distance/E",
    "GPU surface-detail survey (2008) ch. 3.6.7",
    edges_numbers};
constexpr OptionInfo sides_info{
    "sides",
    "one|two",
    "one",
    "two: a detail tile is seen from behind too, heights inverted, normals negated",
    "GPU surface-detail survey (2008) ch. 3.6.8",
    {}};
constexpr OptionInfo border_info{
    "border",
    "wrap|clamp|discard",
    "as the tile has",
    "what lies beyond a detail tile: its copies, its border drawn out, nothing",
    "",
    {}};
constexpr OptionInfo depth_info{
    "depth", "none|write",
    "none",  "write: the depth of the hit, so that meshes cut the relief where it is seen",
    "",      {}};

constexpr OptionInfo silhouettes_info{
    "silhouettes",
    "none|true",
    "none",
    "true: rays enter a mesh's relief through a hull around it, and what leaves that has met "
    "nothing: its outline is that of its heights, its depth that of the hit",
    "Hirche, Ehlert, Guthe and Doggett 2004; Porumbescu, Budge, Feng and Joy 2005",
    {}};

// One assignment: key=value,more.
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
        found.more ? fmt::format(",{}", *found.more) : std::string(), info.name, info.form)};
}

Result<double> number_of(const OptionInfo& info, std::size_t index, std::string_view text) {
    return parse_number(fmt::format("option {}", info.name), info.numbers[index], text);
}

// The two numbers of "min..max".
Result<std::pair<double, double>> range_of(const OptionInfo& info, const Assignment& found) {
    const auto [low_text, high_text] = cut(found.value, "..");
    if (!high_text) {
        return unexpected(info, found);
    }
    const auto low = number_of(info, 0, low_text);
    if (!low) {
        return low.error();
    }
    const auto high = number_of(info, 1, *high_text);
    if (!high) {
        return high.error();
    }
    if (*low > *high) {
        return Error{fmt::format("option {}: {}..{} found, the smaller number first was expected",
                                 info.name, low_text, *high_text)};
    }
    return std::pair{*low, *high};
}

// Which of the words the value is.
Result<std::size_t> word_of(const OptionInfo& info, const Assignment& found,
                            std::span<const std::string_view> words) {
    const auto at = std::find(words.begin(), words.end(), found.value);
    // Only the last word of those with a number takes one.
    const bool may_have_more = !info.numbers.empty() && at + 1 == words.end();
    if (at == words.end() || (found.more && !may_have_more)) {
        return unexpected(info, found);
    }
    return static_cast<std::size_t>(at - words.begin());
}

// The number behind a word, or its default.
Result<double> number_behind(const OptionInfo& info, const Assignment& found) {
    return found.more ? number_of(info, 0, *found.more) : info.numbers.front().default_value;
}

Result<void> set_steps(TechniqueOptions& options, const Assignment& found) {
    const auto range = range_of(steps_info, found);
    if (!range || found.more) {
        return range ? unexpected(steps_info, found) : range.error();
    }
    options.steps = StepRange{range->first, range->second};
    return {};
}

Result<void> set_fade(TechniqueOptions& options, const Assignment& found) {
    const auto range = range_of(fade_info, found);
    if (!range) {
        return range.error();
    }
    const auto power = found.more ? number_of(fade_info, 2, *found.more) : 1.0;
    if (!power) {
        return power.error();
    }
    options.fade = Fade{range->first, range->second, *power};
    return {};
}

Result<void> set_shadow(TechniqueOptions& options, const Assignment& found) {
    const auto word = word_of(shadow_info, found, shadow_words);
    if (!word) {
        return word.error();
    }
    const auto depth = number_behind(shadow_info, found);
    if (!depth) {
        return depth.error();
    }
    if (*word > 0) {
        options.shadow = Shadow{*word == 1 ? 0.0 : *depth};
    }
    return {};
}

Result<void> set_edges(TechniqueOptions& options, const Assignment& found) {
    const auto word = word_of(edges_info, found, edges_words);
    if (!word) {
        return word.error();
    }
    const auto distance = number_behind(edges_info, found);
    if (!distance) {
        return distance.error();
    }
    if (*word > 0) {
        options.smooth_edges = *distance;
    }
    return {};
}

Result<void> set_sides(TechniqueOptions& options, const Assignment& found) {
    const auto word = word_of(sides_info, found, sides_words);
    if (!word) {
        return word.error();
    }
    options.two_sided = *word == 1;
    return {};
}

Result<void> set_border(TechniqueOptions& options, const Assignment& found) {
    const auto word = word_of(border_info, found, border_words);
    if (!word) {
        return word.error();
    }
    options.border = static_cast<BorderRule>(*word);
    return {};
}

Result<void> set_depth(TechniqueOptions& options, const Assignment& found) {
    const auto word = word_of(depth_info, found, depth_words);
    if (!word) {
        return word.error();
    }
    options.writes_depth = *word == 1;
    return {};
}

Result<void> set_silhouettes(TechniqueOptions& options, const Assignment& found) {
    const auto word = word_of(silhouettes_info, found, silhouettes_words);
    if (!word) {
        return word.error();
    }
    options.true_silhouettes = *word == 1;
    return {};
}

struct Entry {
    OptionInfo info;
    Result<void> (*set)(TechniqueOptions&, const Assignment&);
};

constexpr std::array<Entry, 8> entries{{{steps_info, set_steps},
                                        {fade_info, set_fade},
                                        {shadow_info, set_shadow},
                                        {edges_info, set_edges},
                                        {sides_info, set_sides},
                                        {border_info, set_border},
                                        {depth_info, set_depth},
                                        {silhouettes_info, set_silhouettes}}};

constexpr auto option_infos = [] {
    std::array<OptionInfo, entries.size()> list;
    std::transform(entries.begin(), entries.end(), list.begin(),
                   [](const Entry& entry) { return entry.info; });
    return list;
}();

const Entry* entry_of(std::string_view name) {
    const auto* const found = std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) {
        return entry.info.name == name;
    });
    return found == entries.end() ? nullptr : found;
}

bool steps_equally(TechniqueId id) {
    return id == TechniqueId::steep || id == TechniqueId::relief || id == TechniqueId::interval;
}

bool looks_once(TechniqueId id) {
    return id == TechniqueId::parallax || id == TechniqueId::parallax_limited ||
           id == TechniqueId::parallax_iterated;
}

std::string_view reason_without_ray(std::string_view option) {
    return option == "border"
               ? "it shows what lies beyond the tile as its material says; relief and exact take it"
               : "it looks for no surface along a ray; relief and exact do";
}

// Why one that looks for layers cannot.
std::string_view reason_with_layers(std::string_view option) {
    if (option == "steps") {
        return "its steps are as many from wherever it is seen; steep, relief and interval take it";
    }
    if (option == "edges") {
        return "what its rays miss may lie behind a hole; relief and exact take it";
    }
    if (option == "silhouettes") {
        return "its sheets show both sides as they are; relief and exact take it";
    }
    return option == "sides" ? "it is seen from both sides as it is" : std::string_view();
}

// Why a technique cannot take an option; empty where it can.
std::string_view reason_against(TechniqueId id, std::string_view option) {
    if (geometry_of(id) != Geometry::box) {
        return reason_without_ray(option);
    }
    if (option == "steps" && id == TechniqueId::pom) {
        return "its own min and max say the same";
    }
    if (looks_for_layers(id)) {
        return reason_with_layers(option);
    }
    if (option == "steps" && !steps_equally(id)) {
        return "it takes no equal steps; steep, relief and interval do";
    }
    if ((option == "shadow" || option == "edges" || option == "silhouettes") && looks_once(id)) {
        return "it follows no ray; relief and exact do";
    }
    return {};
}

void add_range(std::vector<OptionNumber>& numbers, const std::string& name, double low,
               double high) {
    numbers.push_back({name + ".min", low});
    numbers.push_back({name + ".max", high});
}

} // namespace

std::span<const OptionInfo> option_catalogue() {
    return option_infos;
}

std::vector<OptionInfo> options_of(TechniqueId id) {
    std::vector<OptionInfo> taken;
    std::copy_if(option_infos.begin(), option_infos.end(), std::back_inserter(taken),
                 [&](const OptionInfo& info) { return reason_against(id, info.name).empty(); });
    return taken;
}

bool is_option(std::string_view assignment) {
    return entry_of(assignment_of(assignment).key) != nullptr;
}

Result<void> set_option(TechniqueOptions& options, TechniqueId id, std::string_view assignment) {
    const Assignment found = assignment_of(assignment);
    const Entry* const entry = entry_of(found.key);
    check(entry != nullptr, "set_option of what is no option");
    const auto reason = reason_against(id, found.key);
    if (!reason.empty()) {
        return Error{fmt::format("technique {}: option '{}' found, {}", technique_info(id).name,
                                 found.key, reason)};
    }
    return entry->set(options, found);
}

std::string to_string(const TechniqueOptions& options) {
    std::string text;
    if (options.steps) {
        text += fmt::format(",steps={}..{}", options.steps->low, options.steps->high);
    }
    if (options.fade) {
        text += fmt::format(",fade={}..{}", options.fade->low, options.fade->high);
        text += options.fade->power == 1.0 ? "" : fmt::format(",{}", options.fade->power);
    }
    if (options.shadow) {
        text += options.shadow->depth == 0.0
                    ? ",shadow=hard"
                    : fmt::format(",shadow=soft,{}", options.shadow->depth);
    }
    if (options.smooth_edges) {
        text += fmt::format(",edges=smooth,{}", *options.smooth_edges);
    }
    text += options.two_sided ? ",sides=two" : "";
    if (options.border) {
        text += fmt::format(",border={}", border_words[static_cast<std::size_t>(*options.border)]);
    }
    text += options.writes_depth ? ",depth=write" : "";
    text += options.true_silhouettes ? ",silhouettes=true" : "";
    return text;
}

std::vector<OptionNumber> option_numbers(const TechniqueOptions& options) {
    std::vector<OptionNumber> numbers;
    if (options.steps) {
        add_range(numbers, "steps", options.steps->low, options.steps->high);
    }
    if (options.fade) {
        add_range(numbers, "fade", options.fade->low, options.fade->high);
        numbers.push_back({"fade.k", options.fade->power});
    }
    if (options.shadow) {
        numbers.push_back({"shadow.M", options.shadow->depth});
    }
    if (options.smooth_edges) {
        numbers.push_back({"edges.E", *options.smooth_edges});
    }
    if (options.two_sided) {
        numbers.push_back({"sides", 1.0});
    }
    if (options.border) {
        numbers.push_back({"border", static_cast<double>(*options.border)});
    }
    if (options.writes_depth) {
        numbers.push_back({"depth", 1.0});
    }
    if (options.true_silhouettes) {
        numbers.push_back({"silhouettes", 1.0});
    }
    return numbers;
}

Result<double> parse_number(std::string_view subject, const ParameterInfo& parameter,
                            std::string_view text) {
    double value = 0.0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = code == std::errc{} && end == text.data() + text.size();
    const bool fits = is_number && value >= parameter.low && value <= parameter.high &&
                      (value == parameter.low || value >= parameter.least) &&
                      (!parameter.whole || value == std::round(value));
    if (!fits) {
        const bool has_gap = parameter.least > parameter.low;
        return Error{fmt::format("{}: {}={} found, {}a {}number from {} to {} was expected",
                                 subject, parameter.name, text,
                                 has_gap ? fmt::format("{} or ", parameter.low) : std::string(),
                                 parameter.whole ? "whole " : "",
                                 has_gap ? parameter.least : parameter.low, parameter.high)};
    }
    return value;
}

} // namespace reljef::scene
