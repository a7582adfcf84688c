#include "app/objects/assignments.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "app/cli/parsed_option.h"
#include "engine/core/geometry.h"
#include "engine/io/formats/scene_file.h"

namespace reljef::app {

Result<std::vector<Assignment>> assignments_of(const std::string& text, const std::string& option) {
    std::vector<Assignment> found;
    std::size_t begin = 0;
    while (begin <= text.size()) {
        const std::size_t comma = std::min(text.find(',', begin), text.size());
        const std::string part = text.substr(begin, comma - begin);
        const std::size_t equals = part.find('=');
        if (equals == std::string::npos && !found.empty()) {
            found.back().value += "," + part;
        } else {
            const std::string key = part.substr(0, equals);
            if (std::any_of(found.begin(), found.end(),
                            [&](const Assignment& other) { return other.key == key; })) {
                return Error{fmt::format("{}: {} found twice, once was expected", option, key)};
            }
            found.push_back({key, equals == std::string::npos ? "" : part.substr(equals + 1)});
        }
        begin = comma + 1;
    }
    return found;
}

Result<glm::dvec2> parse_place(const std::string& text, const std::string& option) {
    const auto place =
        cli::parse_numbers<2>(option, text, "LAT,LON in degrees, or X,Y in scene metres");
    if (!place) {
        return place.error();
    }
    const auto [x, y] = *place;
    if (std::max(std::abs(x), std::abs(y)) > max_world_coordinate) {
        return Error{fmt::format("{}: '{}' found, at most {} was expected", option, text,
                                 max_world_coordinate)};
    }
    return glm::dvec2(x, y);
}

Result<void> set_color(Rgba8& color, const std::string& text, const std::string& option) {
    const auto parsed = io::color_from_hex(text);
    if (!parsed) {
        return Error{fmt::format("{}: color '{}' found, a color such as #ffcc88 was expected",
                                 option, text)};
    }
    color = *parsed;
    return {};
}

} // namespace reljef::app
