#include "app/objects/light_option.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/parsed_option.h"
#include "app/objects/assignments.h"

namespace reljef::app {
namespace {

Result<void> set_key(io::LightDescription& light, const Assignment& assignment) {
    const auto& [key, value] = assignment;
    if (key == "intensity") {
        return set_number(light.intensity, cli::number_in("--light: intensity", 0.0,
                                                          io::max_light_intensity, true)(value));
    }
    if (key == "color") {
        return set_color(light.color, value, "--light");
    }
    return Error{fmt::format("--light: '{}' found, intensity or color was expected", key)};
}

Result<io::LightDescription> parse_direction(const std::string& text) {
    const auto angles = cli::parse_numbers<2>("--light", text, "AZIMUTH,ALTITUDE in degrees");
    if (!angles) {
        return angles.error();
    }
    const auto [azimuth, altitude] = *angles;
    if (!(azimuth >= -360.0 && azimuth <= 360.0)) {
        return Error{fmt::format("--light: azimuth {} found, -360 to 360 was expected", azimuth)};
    }
    if (!(altitude >= 0.0 && altitude <= 90.0)) {
        return Error{fmt::format("--light: altitude {} found, 0 to 90 was expected", altitude)};
    }
    return io::LightDescription{.azimuth = azimuth, .altitude = altitude};
}

} // namespace

Result<io::LightDescription> parse_light(const std::string& text) {
    const std::size_t colon = text.find(':');
    auto light = parse_direction(text.substr(0, colon));
    if (!light || colon == std::string::npos) {
        return light;
    }
    const auto assignments = assignments_of(text.substr(colon + 1), "--light");
    if (!assignments) {
        return assignments.error();
    }
    for (const Assignment& assignment : *assignments) {
        if (auto set = set_key(*light, assignment); !set) {
            return set.error();
        }
    }
    return light;
}

std::string to_text(const io::LightDescription& light) {
    return fmt::format("{},{}:intensity={},color={}", light.azimuth, light.altitude,
                       light.intensity, io::to_hex(light.color));
}

void add_light_option(CLI::App& command, std::vector<io::LightDescription>& lights) {
    add_repeated(command, "--light", lights, io::max_lights, parse_light,
                 "light besides the sun, without shadows; may be repeated. Direction as --sun's, "
                 "altitude 0 to 90; intensity: light of white ground that faces it, 1 is white "
                 "(0.5); color: sRGB (#ffffff). It is one of the 16 lights that a picture shows, "
                 "see --point-light. Example: --sun 265,20 --light "
                 "85,30:intensity=0.2,color=#88aaff")
        ->type_name("AZIMUTH,ALTITUDE[:intensity=I][,color=#RRGGBB]");
}

} // namespace reljef::app
