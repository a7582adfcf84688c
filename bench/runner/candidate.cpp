#include "bench/runner/candidate.h"

#include <algorithm>
#include <charconv>

namespace reljef::bench {
namespace {

// A parameter of a technique that does not exist yet; one that is no number is left out.
std::optional<Setting::Parameter> parameter_named(std::string_view text) {
    const auto equals = std::min(text.find('='), text.size());
    const std::string_view digits = text.substr(std::min(equals + 1, text.size()));
    double value = 0.0;
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return code == std::errc{} && end == digits.data() + digits.size()
               ? std::optional(Setting::Parameter{std::string(text.substr(0, equals)), value})
               : std::nullopt;
}

Setting setting_named(const std::string& text) {
    const auto colon = std::min(text.find(':'), text.size());
    Setting setting{text.substr(0, colon), {}, text};
    for (std::size_t begin = colon + 1; begin < text.size();) {
        const auto end = std::min(text.find(',', begin), text.size());
        if (auto parameter = parameter_named(std::string_view(text).substr(begin, end - begin))) {
            setting.parameters.push_back(std::move(*parameter));
        }
        begin = end + 1;
    }
    return setting;
}

} // namespace

Candidate candidate_of(const scene::Technique& technique) {
    return {setting_of(technique), technique, std::nullopt};
}

Candidate candidate_named(const std::string& text) {
    const auto technique = scene::parse_technique(text);
    return technique ? candidate_of(*technique)
                     : Candidate{setting_named(text), std::nullopt, std::nullopt};
}

} // namespace reljef::bench
