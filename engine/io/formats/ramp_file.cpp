#include "engine/io/formats/ramp_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "engine/core/atomic_file.h"

namespace reljef::io {
namespace {

// Those of gdaldem.
constexpr std::array<std::pair<std::string_view, glm::vec3>, 16> color_names{
    {{"white", {255.0F, 255.0F, 255.0F}},
     {"black", {0.0F, 0.0F, 0.0F}},
     {"red", {255.0F, 0.0F, 0.0F}},
     {"green", {0.0F, 255.0F, 0.0F}},
     {"blue", {0.0F, 0.0F, 255.0F}},
     {"yellow", {255.0F, 255.0F, 0.0F}},
     {"magenta", {255.0F, 0.0F, 255.0F}},
     {"cyan", {0.0F, 255.0F, 255.0F}},
     {"aqua", {0.0F, 191.0F, 191.0F}},
     {"grey", {191.0F, 191.0F, 191.0F}},
     {"gray", {191.0F, 191.0F, 191.0F}},
     {"orange", {255.0F, 128.0F, 0.0F}},
     {"brown", {191.0F, 128.0F, 64.0F}},
     {"purple", {128.0F, 0.0F, 255.0F}},
     {"violet", {128.0F, 0.0F, 255.0F}},
     {"indigo", {0.0F, 128.0F, 255.0F}}}};

constexpr std::size_t max_file_bytes = std::size_t{1} << 20U;

std::string lower_case(std::string_view word) {
    std::string lower(word);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return lower;
}

std::vector<std::string> words_of(std::string_view line) {
    std::vector<std::string> words;
    const std::string_view content = line.substr(0, line.find('#'));
    constexpr std::string_view separators = " \t,:\r";
    for (std::size_t at = content.find_first_not_of(separators); at != std::string_view::npos;) {
        const std::size_t end = content.find_first_of(separators, at);
        words.push_back(lower_case(content.substr(at, end - at)));
        at = content.find_first_not_of(separators, end);
    }
    return words;
}

std::optional<double> number_of(std::string_view word) {
    double value = 0.0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool is_number = code == std::errc{} && end == word.data() + word.size();
    return is_number && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<glm::vec3> color_of(const std::vector<std::string>& words) {
    if (words.size() == 2) {
        const auto* const found =
            std::find_if(color_names.begin(), color_names.end(),
                         [&](const auto& color) { return color.first == words[1]; });
        return found == color_names.end() ? std::nullopt : std::optional(found->second);
    }
    if (words.size() != 4 && words.size() != 5) {
        return std::nullopt;
    }
    glm::vec3 color(0.0F);
    for (std::size_t i = 1; i < words.size(); ++i) {
        const auto value = number_of(words[i]);
        if (!value || *value < 0.0 || *value > 255.0) {
            return std::nullopt;
        }
        if (i <= 3) {
            color[static_cast<int>(i) - 1] = static_cast<float>(*value);
        }
    }
    return color;
}

// "12" or "40%".
std::optional<terrain::RampStop> stop_of(std::string_view word, glm::vec3 color) {
    const bool is_share = word.ends_with('%');
    const auto value = number_of(word.substr(0, word.size() - (is_share ? 1U : 0U)));
    if (!value || (is_share && (*value < 0.0 || *value > 100.0))) {
        return std::nullopt;
    }
    return terrain::RampStop{is_share ? *value / 100.0 : *value, color, is_share, false};
}

} // namespace

Result<terrain::ColorRamp> parse_ramp(std::string_view text, const std::string& name) {
    terrain::ColorRamp ramp{name, {}, false, false, {}};
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) {
        text.remove_prefix(byte_order_mark.size());
    }
    int number = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line = text.substr(at, end - at);
        const std::vector<std::string> words = words_of(line);
        at = end + 1;
        ++number;
        if (words.empty()) {
            continue;
        }
        const auto wrong = [&](std::string_view expected) {
            return Error{fmt::format("{}, line {}: '{}' found, {} was expected", name, number,
                                     line.substr(0, 60), expected)};
        };
        const auto color = color_of(words);
        if (!color) {
            return wrong("a height and a colour (red, green and blue from 0 to 255, or a name)");
        }
        if (words.front() == "nv") {
            ramp.no_data = terrain::rgba8(*color);
            continue;
        }
        const auto stop = stop_of(words.front(), *color);
        if (!stop) {
            return wrong("a height in metres, or a share from 0% to 100%,");
        }
        ramp.stops.push_back(*stop);
    }
    if (ramp.stops.empty()) {
        return Error{
            fmt::format("{}: no height with a colour found, at least one was expected", name)};
    }
    return ramp;
}

Result<terrain::ColorRamp> read_ramp_file(const std::filesystem::path& path) {
    const auto text = read_text_file(path, max_file_bytes);
    return text ? parse_ramp(*text, path.string()) : Result<terrain::ColorRamp>(text.error());
}

} // namespace reljef::io
