#include <array>
#include <cmath>
#include <limits>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/command.h"
#include "app/options.h"
#include "app/terrain_source.h"

namespace reljef::app {
namespace {

struct HeightChoice {
    TerrainChoice terrain;
    std::vector<std::array<double, 2>> places; // latitude, longitude, degrees
};

std::vector<std::array<double, 2>> places_of(const std::vector<std::string>& texts) {
    std::vector<std::array<double, 2>> places;
    for (const std::string& text : texts) {
        const auto place = parse_numbers<2>("--at", text, "LAT,LON in degrees");
        if (!place) {
            throw CLI::ValidationError(place.error().message);
        }
        places.push_back(*place);
    }
    return places;
}

// The height at a latitude and longitude, metres; NaN on a void. Fails off the terrain.
Result<double> height_at(const terrain::Terrain& terrain, double latitude, double longitude) {
    const terrain::Heightfield& heightfield = terrain.heightfield;
    const auto sample = heightfield.georeference->geodetic.sample(latitude, longitude);
    // The map is good to a ten-millionth of a sample: its own border counts as inside.
    constexpr double border = 1e-7;
    const glm::dvec2 last{heightfield.heights.cols() - 1, heightfield.heights.rows() - 1};
    if (!sample || sample->x < -border || sample->y < -border || sample->x > last.x + border ||
        sample->y > last.y + border) {
        return Error{fmt::format("--at: {},{} found, a place on {} was expected", latitude,
                                 longitude, terrain.name)};
    }
    return terrain::touches_void(heightfield, *sample)
               ? std::numeric_limits<double>::quiet_NaN()
               : terrain::bilinear_height(heightfield.heights.view(), *sample);
}

Result<void> print_heights(const HeightChoice& choice, const Interrupt& interrupt) {
    auto source = open_terrain(choice.terrain, interrupt.token());
    if (!source) {
        return source.error();
    }
    if (!source->terrain.heightfield.georeference) {
        return Error{fmt::format("{}: has no coordinate system, one was expected for --at",
                                 source->terrain.name)};
    }
    for (const auto& [latitude, longitude] : choice.places) {
        const auto height = height_at(source->terrain, latitude, longitude);
        if (!height) {
            return height.error();
        }
        fmt::print("{},{},{}\n", latitude, longitude,
                   std::isnan(*height) ? "nan" : fmt::format("{:.6f}", *height));
    }
    return {};
}

} // namespace

Command add_height_command(CLI::App& program, Interrupt& interrupt) {
    auto* arguments = program.add_subcommand("height", "print heights at places on Earth");
    auto choice = std::make_shared<HeightChoice>();
    add_terrain_options(*arguments, choice->terrain);
    arguments
        ->add_option_function<std::vector<std::string>>(
            "--at",
            [choice](const std::vector<std::string>& texts) { choice->places = places_of(texts); },
            "latitude and longitude, degrees; again for more places")
        ->type_name("LAT,LON")
        ->required()
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    arguments->footer(
        "Prints LAT,LON,HEIGHT, one line a place; the height is in metres above the DEM's "
        "own zero, nan on a void.\n"
        "Example:\n  reljef height N45E006.hgt --at 45.8326,6.8652");
    return {arguments, [choice, &interrupt] { return print_heights(*choice, interrupt); }};
}

} // namespace reljef::app
