#include "app/objects/point_light_option.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/parsed_option.h"
#include "app/objects/assignments.h"

namespace reljef::app {
namespace {

constexpr const char* light_form = "LAT,LON[:height=M][,intensity=I][,range=M][,color=#RRGGBB]";

Result<void> set_light_key(io::PointLightDescription& light, const Assignment& assignment) {
    const auto& [key, value] = assignment;
    if (key == "height") {
        return set_number(light.height,
                          cli::number_in("--point-light: height", -io::max_object_height,
                                         io::max_object_height)(value));
    }
    if (key == "intensity") {
        return set_number(light.intensity, cli::number_in("--point-light: intensity", 0.0,
                                                          io::max_intensity, true)(value));
    }
    if (key == "range") {
        return set_number(light.range,
                          cli::number_in("--point-light: range", 0.0, io::max_range, true)(value));
    }
    if (key == "color") {
        return set_color(light.color, value, "--point-light");
    }
    return Error{fmt::format(
        "--point-light: '{}' found, height, intensity, range or color was expected", key)};
}

} // namespace

Result<io::PointLightDescription> parse_point_light(const std::string& text) {
    const std::size_t colon = text.find(':');
    const auto place = parse_place(text.substr(0, colon), "--point-light");
    if (!place) {
        return place.error();
    }
    io::PointLightDescription light;
    light.at = *place;
    if (colon == std::string::npos) {
        return light;
    }
    const auto assignments = assignments_of(text.substr(colon + 1), "--point-light");
    if (!assignments) {
        return assignments.error();
    }
    for (const Assignment& assignment : *assignments) {
        if (auto set = set_light_key(light, assignment); !set) {
            return set.error();
        }
    }
    return light;
}

std::string to_text(const io::PointLightDescription& light) {
    const glm::dvec2 at = light.at.value_or(glm::dvec2(0.0));
    std::string text =
        fmt::format("{},{}:height={},intensity={}", at.x, at.y, light.height, light.intensity);
    if (light.range) {
        text += fmt::format(",range={}", *light.range);
    }
    return text + ",color=" + io::to_hex(light.color);
}

void add_point_light_option(CLI::App& command, std::vector<io::PointLightDescription>& lights) {
    add_repeated(
        command, "--point-light", lights, io::max_point_lights, parse_point_light,
        "lamp above the ground, without shadows; may be repeated. Latitude and longitude, or x "
        "and y in scene metres on terrain that is not georeferenced; height: above the ground, "
        "metres (5); intensity: light of white ground that faces the lamp from a metre away, 1 "
        "is white, and it falls with the square of the distance (25); range: where it ends, "
        "metres (10 times the root of the intensity); color: sRGB (#ffffff). Of the lamps "
        "whose "
        "range meets the view, the 16 brightest at the eye are drawn; --truth draws all. "
        "Example: --sun 0,-10 --point-light "
        "45.7,6.8:intensity=4e4,range=2000,color=#ffcc88")
        ->type_name(light_form);
}

} // namespace reljef::app
