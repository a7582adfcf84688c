#include "app/cli/appearance_options.h"

#include <cmath>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/parsed_option.h"
#include "engine/scene/graph/daylight.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::cli {
namespace {

Result<session::SunChoice> parse_sun(const std::string& text) {
    if (text.find('T') != std::string::npos) {
        const auto time = geo::universal_time(text);
        return time ? Result<session::SunChoice>(*time) : Error{"--sun: " + time.error().message};
    }
    const auto numbers = parse_numbers<2>(
        "--sun", text, "AZIMUTH,ALTITUDE in degrees, or a time in UTC as 2026-06-21T12:00,");
    if (!numbers) {
        return numbers.error();
    }
    const auto [azimuth, altitude] = *numbers;
    if (std::abs(azimuth) > 360.0) {
        return Error{fmt::format("--sun: azimuth {} found, -360 to 360 was expected", azimuth)};
    }
    if (std::abs(altitude) > 90.0) {
        return Error{fmt::format("--sun: altitude {} found, -90 to 90 was expected", altitude)};
    }
    return session::SunChoice(glm::dvec2(azimuth, altitude));
}

} // namespace

void add_appearance_options(CLI::App& command, session::SceneOptions& choice) {
    add_parsed(command, "--sun", choice.sun, parse_sun,
               "direction of the sun, degrees: clockwise from north, above the horizon (negative: "
               "below); or a time in UTC as 2026-06-21T12:00, over georeferenced terrain (300,40; "
               "on maps 315,35)",
               "AZIMUTH,ALTITUDE|TIME");
    add_parsed(command, "--turbidity", choice.turbidity,
               number_in("--turbidity", scene::min_turbidity, scene::max_turbidity),
               "haze of the air, 1 (none) to 10: colours of sun, sky and distance (1.4)", "T");
    add_parsed(
        command, "--visibility", choice.visibility, number_in("--visibility", 0.0, 1e9),
        "metres to 2 % contrast at the lowest ground; 0: no haze (10 widths of the terrain, at "
        "least 30,000)",
        "M");
    command
        .add_option(
            "--sky", choice.sky,
            "picture of all directions, twice as wide as high; of the sky alone, four times; "
            "a cross of six faces, 4:3; or a folder of six, whose names end in front, right, back, "
            "left, up and down (the sun's own sky)")
        ->type_name("FILE|FOLDER");
    add_parsed(command, "--sky-turn", choice.sky_turn, number_in("--sky-turn", -360.0, 360.0),
               "where the middle of that picture lies, degrees clockwise from north (0)", "DEG");
    add_parsed(
        command, "--base", choice.base,
        word_of<session::BaseKind>("--base", {{"plane", session::BaseKind::plane},
                                              {"solid", session::BaseKind::solid},
                                              {"none", session::BaseKind::none}}),
        "plane: the terrain lies on an endless plane; solid: it is a block with walls below "
        "its border, on pale ground; none: it floats in the sky (plane; pictures of the whole "
        "terrain: solid where it is no island)",
        "KIND");
    add_parsed(command, "--occlusion", choice.hides_sky,
               word_of<bool>("--occlusion", {{"on", true}, {"off", false}}),
               "on: valleys and streets get less light from the sky (on)", "on|off");
    add_parsed(command, "--eye-dome", choice.eye_dome, number_in("--eye-dome", 0.0, 1.0),
               "eye-dome lighting, 0 (none) to 1: darkens valleys, feet of walls and ground behind "
               "ridges; hits, errors and --compare are without it (0)",
               "S");
    add_parsed(
        command, "--contours", choice.contours, number_in("--contours", 0.0, scene::max_contours),
        "metres of height from one contour line to the next, every fifth bold; 0: none (0)", "M");
    add_parsed(command, "--contour-labels", choice.contour_labels,
               word_of<bool>("--contour-labels", {{"on", true}, {"off", false}}),
               "on: writes the height, in metres, on bold contour lines (on)", "on|off");
    add_parsed(
        command, "--grain", choice.grain, number_in("--grain", 0.0, scene::max_grain),
        "contrast of fine structure on near ground, which the data do not have: soil, scree, "
        "grass, rock and snow by slope and colour; 0 (none) to 2; hits, errors and --compare "
        "are without it (1; on maps, pictures of the whole terrain and ramps of one colour "
        "0)",
        "G");
}

} // namespace reljef::cli
