#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <span>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/message.h"
#include "app/cli/options.h"
#include "app/cli/parsed_option.h"
#include "app/cli/standard_input.h"
#include "app/commands.h"
#include "app/place_file.h"
#include "engine/core/parallel_for.h"
#include "engine/session/terrain_source.h"

namespace reljef::app {
namespace {

struct HeightChoice {
    cli::TerrainChoice terrain;
    std::vector<glm::dvec2> places; // latitude, longitude, degrees
    std::string points;             // a file of places; "-": standard input; empty: none
};

// Bytes of a file that are processed together. They need about five times as much memory.
std::size_t bytes_of_piece(const cli::TerrainChoice& choice) {
    constexpr std::size_t part = 16; // of the memory
    constexpr std::size_t max_bytes = std::size_t{64} << 20U;
    return std::min((static_cast<std::size_t>(choice.memory_megabytes) << 20U) / part, max_bytes);
}

std::vector<glm::dvec2> places_of(const std::vector<std::string>& texts) {
    std::vector<glm::dvec2> places;
    for (const std::string& text : texts) {
        const auto numbers = cli::parse_numbers<2>("--at", text, "LAT,LON in degrees");
        if (!numbers) {
            throw CLI::ValidationError(numbers.error().message);
        }
        const glm::dvec2 place((*numbers)[0], (*numbers)[1]);
        if (!is_place(place)) {
            throw CLI::ValidationError(
                fmt::format("--at: {},{} found, a latitude from -90 to 90 and a longitude in "
                            "degrees were expected",
                            place.x, place.y));
        }
        places.push_back(place);
    }
    return places;
}

constexpr int digits_of_heights = 6; // after the point: micrometres

void append_answer(std::string_view place, const io::HeightSample& answer, std::string& out) {
    out += place;
    if (answer.kind != io::HeightSample::Kind::height) {
        out += ",nan\n";
        return;
    }
    fmt::format_to(std::back_inserter(out), ",{:.{}f}\n", answer.height, digits_of_heights);
}

void print(const std::string& out) {
    static_cast<void>(std::fwrite(out.data(), 1, out.size(), stdout));
}

// Prints the answers in order. Several threads format them.
void print_answers(std::span<const std::string_view> texts,
                   std::span<const io::HeightSample> answers, unsigned threads) {
    constexpr std::size_t lines_a_part = 1U << 14U;
    std::vector<std::string> parts((texts.size() + lines_a_part - 1) / lines_a_part);
    const auto append_part = [&](int number) {
        const auto part = static_cast<std::size_t>(number);
        const std::size_t end = std::min(texts.size(), (part + 1) * lines_a_part);
        for (std::size_t i = part * lines_a_part; i < end; ++i) {
            append_answer(texts[i], answers[i], parts[part]);
        }
    };
    parallel_for(static_cast<int>(parts.size()), append_part,
                 {.threads = threads, .stop = {}, .progress = {}});
    for (const std::string& part : parts) {
        print(part);
    }
}

// The only file of a terrain fails with its own sentence.
bool is_whole_terrain(const FileError& error, const cli::TerrainChoice& choice) {
    return error.file == choice.terrain;
}

void keep_errors(std::vector<FileError> found, const cli::TerrainChoice& choice,
                 std::vector<FileError>& errors) {
    for (FileError& error : found) {
        if (std::find(errors.begin(), errors.end(), error) == errors.end()) {
            if (!choice.quiet && !is_whole_terrain(error, choice)) {
                cli::write_stderr(fmt::format("reljef: left out: {}\n", error.message));
            }
            errors.push_back(std::move(error));
        }
    }
}

// For places that may lie in an unreadable file.
std::string left_out_text(std::span<const FileError> errors) {
    return errors.empty() ? std::string()
                          : fmt::format("; {} of its files could not be read: {}", errors.size(),
                                        errors.front().message);
}

bool is_inside(glm::dvec2 place, const geo::GeodeticArea& area) {
    const double east_of_west = place.y - area.west;
    const double turned = east_of_west - 360.0 * std::floor(east_of_west / 360.0);
    return place.x >= area.south && place.x <= area.north && turned <= area.east - area.west;
}

// Places outside the area have no answer.
io::TileSet::Heights heights_within(const session::HeightSource& source,
                                    std::span<const glm::dvec2> places,
                                    const cli::Interrupt& interrupt) {
    auto found = source.tiles.heights(places, interrupt.token());
    for (std::size_t i = 0; source.area && i < places.size(); ++i) {
        if (!is_inside(places[i], *source.area)) {
            found.answers[i] = {};
        }
    }
    return found;
}

Result<void> print_places(const HeightChoice& choice, const session::HeightSource& source,
                          const cli::Interrupt& interrupt, std::vector<FileError>& errors) {
    auto found = heights_within(source, choice.places, interrupt);
    if (interrupt.requested()) {
        return Error{"interrupted"};
    }
    keep_errors(std::move(found.errors), choice.terrain, errors);
    std::string out;
    for (std::size_t i = 0; i < choice.places.size(); ++i) {
        const glm::dvec2 place = choice.places[i];
        if (found.answers[i].kind == io::HeightSample::Kind::outside) {
            print(out);
            return Error{fmt::format("--at: {},{} found, a place on {}{} was expected{}", place.x,
                                     place.y, choice.terrain.terrain,
                                     source.area ? " in its area" : "", left_out_text(errors))};
        }
        append_answer(fmt::format("{},{}", place.x, place.y), found.answers[i], out);
    }
    print(out);
    return {};
}

Result<void> print_points(const HeightChoice& choice, const session::HeightSource& source,
                          const cli::Interrupt& interrupt, std::vector<FileError>& errors) {
    auto file = PlaceFile::open(choice.points, bytes_of_piece(choice.terrain));
    if (!file) {
        return file.error();
    }
    while (!file->at_end()) {
        const auto read = file->next();
        if (!read) {
            return read.error();
        }
        auto heights = heights_within(source, read->places, interrupt);
        if (interrupt.requested()) {
            return Error{"interrupted"};
        }
        print_answers(read->texts, heights.answers, static_cast<unsigned>(choice.terrain.threads));
        keep_errors(std::move(heights.errors), choice.terrain, errors);
    }
    return {};
}

Result<void> print_heights(const HeightChoice& choice, const cli::Interrupt& interrupt) {
    const auto source =
        session::open_heights(choice.terrain, session::HeightUse::at_places, interrupt.token());
    if (!source) {
        return source.error();
    }
    std::vector<FileError> errors;
    keep_errors({source->tiles.errors().begin(), source->tiles.errors().end()}, choice.terrain,
                errors);
    if (auto printed = print_places(choice, *source, interrupt, errors); !printed) {
        return printed;
    }
    if (!choice.points.empty()) {
        if (auto printed = print_points(choice, *source, interrupt, errors); !printed) {
            return printed;
        }
    }
    return !errors.empty() && is_whole_terrain(errors.front(), choice.terrain)
               ? Error{errors.front().message}
               : session::report_errors(choice.terrain.terrain, errors.size());
}

} // namespace

cli::Command add_height_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand("height", "print heights at places on Earth");
    auto choice = std::make_shared<HeightChoice>();
    cli::add_source_options(*arguments, choice->terrain);
    auto* at = arguments->add_option_function<std::vector<std::string>>(
        "--at",
        [choice](const std::vector<std::string>& texts) { choice->places = places_of(texts); },
        "latitude and longitude of a place, degrees; may be repeated");
    at->type_name("LAT,LON")->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    arguments
        ->add_option("--points", choice->points,
                     "file with a line LAT,LON for each place; - for standard input")
        ->type_name("FILE");
    arguments->callback([choice] {
        if (choice->terrain.terrain == "-" && choice->points == "-") {
            throw CLI::ValidationError(
                "--points: - found, and TERRAIN is - too; one standard input was expected");
        }
        if (choice->places.empty() && choice->points.empty()) {
            throw CLI::ValidationError("height: no place found, --at LAT,LON or --points FILE was "
                                       "expected");
        }
    });
    arguments->footer(
        "Prints a line LAT,LON,HEIGHT for each place. The height is in metres above the DEM's "
        "zero. It is nan on a void. With --points, it is also nan outside the terrain or --area. "
        "Where files of a folder overlap, the finest wins; ties go to the newest.\n"
        "Examples:\n"
        "  reljef height N45E006.hgt --at 45.8326,6.8652\n"
        "  reljef height tiles/ --points - < places.csv > heights.csv");
    return {arguments, [choice, &interrupt] {
                return cli::with_standard_input(choice->terrain.terrain, interrupt.token(),
                                                [&] { return print_heights(*choice, interrupt); });
            }};
}

} // namespace reljef::app
