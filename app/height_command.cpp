#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <span>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/command.h"
#include "app/message.h"
#include "app/options.h"
#include "app/terrain_source.h"
#include "engine/core/worker_pool.h"

namespace reljef::app {
namespace {

struct HeightChoice {
    TerrainChoice terrain;
    std::vector<glm::dvec2> places; // latitude, longitude, degrees
    std::string points;             // a file of them, "-": standard input; empty: none
};

// What is read of a file at a time; places of so much text are answered together.
constexpr std::size_t chunk_bytes = std::size_t{64} << 20U;

Result<glm::dvec2> checked_place(std::string_view option, glm::dvec2 place) {
    if (std::abs(place.x) <= 90.0 && std::abs(place.y) <= 1e6) {
        return place;
    }
    return Error{fmt::format("{}: {},{} found, a latitude from -90 to 90 and a longitude in "
                             "degrees were expected",
                             option, place.x, place.y)};
}

std::vector<glm::dvec2> places_of(const std::vector<std::string>& texts) {
    std::vector<glm::dvec2> places;
    for (const std::string& text : texts) {
        const auto numbers = parse_numbers<2>("--at", text, "LAT,LON in degrees");
        if (!numbers) {
            throw CLI::ValidationError(numbers.error().message);
        }
        const auto place = checked_place("--at", {(*numbers)[0], (*numbers)[1]});
        if (!place) {
            throw CLI::ValidationError(place.error().message);
        }
        places.push_back(*place);
    }
    return places;
}

// A file that is read piece by piece; standard input for "-".
class TextInput {
public:
    static Result<TextInput> open(const std::string& name) {
        std::FILE* file = name == "-" ? stdin : std::fopen(name.c_str(), "rb");
        if (file == nullptr) {
            return Error{
                fmt::format("--points: '{}' found, a file of lines LAT,LON was expected", name)};
        }
        return TextInput(file);
    }

    // Whole lines of at most chunk_bytes; empty at the end.
    std::string next_lines() {
        std::string text = std::move(rest_);
        const std::size_t kept = text.size();
        text.resize(kept + chunk_bytes);
        text.resize(kept + std::fread(text.data() + kept, 1, chunk_bytes, file_.get()));
        const bool at_end = text.size() < kept + chunk_bytes;
        const auto last = text.rfind('\n');
        const std::size_t whole = at_end || last == std::string::npos ? text.size() : last + 1;
        rest_ = text.substr(whole);
        text.resize(whole);
        return text;
    }

private:
    struct Closer {
        void operator()(std::FILE* file) const {
            if (file != stdin) {
                static_cast<void>(std::fclose(file));
            }
        }
    };
    explicit TextInput(std::FILE* file) : file_(file) {}

    std::unique_ptr<std::FILE, Closer> file_;
    std::string rest_;
};

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    const auto last = text.find_last_not_of(" \t\r");
    return first == std::string_view::npos ? std::string_view()
                                           : text.substr(first, last - first + 1);
}

// A line's place and its own text of it.
struct Line {
    glm::dvec2 place{0.0};
    std::string_view text;
};

// LAT,LON at the beginning of a line; what follows another comma is not looked at.
std::optional<Line> line_of(std::string_view text) {
    Line line;
    const char* const end = text.data() + text.size();
    const auto latitude = std::from_chars(text.data(), end, line.place.x);
    if (latitude.ec != std::errc{} || latitude.ptr == end || *latitude.ptr != ',') {
        return std::nullopt;
    }
    const char* begin = latitude.ptr + 1;
    while (begin != end && *begin == ' ') {
        ++begin;
    }
    const auto longitude = std::from_chars(begin, end, line.place.y);
    if (longitude.ec != std::errc{} || (longitude.ptr != end && *longitude.ptr != ',')) {
        return std::nullopt;
    }
    line.text = text.substr(0, static_cast<std::size_t>(longitude.ptr - text.data()));
    return line;
}

// The lines of a text, empty ones left out; `first_number` is its first line's in the file, whose
// very first line may be a heading.
Result<std::vector<Line>> lines_of(std::string_view text, std::size_t& number) {
    std::vector<Line> lines;
    while (!text.empty()) {
        const std::string_view raw = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(raw.size() + 1, text.size()));
        ++number;
        const std::string_view whole = trimmed(raw);
        const auto line = line_of(whole);
        if (line && checked_place("", line->place)) {
            lines.push_back(*line);
        } else if (!whole.empty() && number > 1) {
            return Error{fmt::format("--points: line {}: '{}' found, LAT,LON in degrees was "
                                     "expected",
                                     number, whole.substr(0, 80))};
        }
    }
    return lines;
}

constexpr int digits_of_heights = 6; // after the point: micrometres

void append_answer(std::string_view place, const io::HeightAnswer& answer, std::string& out) {
    out += place;
    if (answer.kind != io::HeightAnswer::Kind::height) {
        out += ",nan\n";
        return;
    }
    std::array<char, 64> text{}; // heights are below 1e9 m
    const auto written = std::to_chars(text.data(), text.data() + text.size(), answer.height,
                                       std::chars_format::fixed, digits_of_heights);
    out += ',';
    out.append(text.data(), written.ptr);
    out += '\n';
}

void print(const std::string& out) {
    static_cast<void>(std::fwrite(out.data(), 1, out.size(), stdout));
}

// The answers as text, by several threads; in order.
void print_answers(std::span<const Line> lines, std::span<const io::HeightAnswer> answers,
                   unsigned threads) {
    constexpr std::size_t lines_a_part = 1U << 14U;
    std::vector<std::string> parts((lines.size() + lines_a_part - 1) / lines_a_part);
    const auto append_part = [&](int number) {
        const auto part = static_cast<std::size_t>(number);
        const std::size_t end = std::min(lines.size(), (part + 1) * lines_a_part);
        for (std::size_t i = part * lines_a_part; i < end; ++i) {
            append_answer(lines[i].text, answers[i], parts[part]);
        }
    };
    parallel_for(static_cast<int>(parts.size()), append_part,
                 {.threads = threads, .stop = {}, .progress = {}});
    for (const std::string& part : parts) {
        print(part);
    }
}

void keep_faults(std::vector<io::TileFault> found, const TerrainChoice& choice,
                 std::vector<io::TileFault>& faults) {
    for (io::TileFault& fault : found) {
        if (std::find(faults.begin(), faults.end(), fault) == faults.end()) {
            if (!choice.quiet) {
                tell(fmt::format("reljef: left out: {}\n", fault.message));
            }
            faults.push_back(std::move(fault));
        }
    }
}

Result<void> print_places(const HeightChoice& choice, const io::TileSet& tiles,
                          std::vector<io::TileFault>& faults) {
    auto found = tiles.heights(choice.places);
    std::string out;
    for (std::size_t i = 0; i < choice.places.size(); ++i) {
        const glm::dvec2 place = choice.places[i];
        if (found.answers[i].kind == io::HeightAnswer::Kind::outside) {
            print(out);
            return Error{fmt::format("--at: {},{} found, a place on {} was expected", place.x,
                                     place.y, choice.terrain.terrain)};
        }
        append_answer(fmt::format("{},{}", place.x, place.y), found.answers[i], out);
    }
    print(out);
    keep_faults(std::move(found.faults), choice.terrain, faults);
    return {};
}

Result<void> print_points(const HeightChoice& choice, const io::TileSet& tiles,
                          const Interrupt& interrupt, std::vector<io::TileFault>& faults) {
    auto input = TextInput::open(choice.points);
    if (!input) {
        return input.error();
    }
    std::size_t number = 0;
    for (std::string text = input->next_lines(); !text.empty(); text = input->next_lines()) {
        const auto lines = lines_of(text, number);
        if (!lines) {
            return lines.error();
        }
        if (interrupt.requested()) {
            return Error{"interrupted"};
        }
        std::vector<glm::dvec2> places(lines->size());
        std::transform(lines->begin(), lines->end(), places.begin(),
                       [](const Line& line) { return line.place; });
        auto found = tiles.heights(places);
        print_answers(*lines, found.answers, static_cast<unsigned>(choice.terrain.threads));
        keep_faults(std::move(found.faults), choice.terrain, faults);
    }
    return {};
}

Result<void> print_heights(const HeightChoice& choice, const Interrupt& interrupt) {
    const auto tiles = open_tiles(choice.terrain, interrupt.token());
    if (!tiles) {
        return tiles.error();
    }
    std::vector<io::TileFault> faults;
    if (auto printed = print_places(choice, *tiles, faults); !printed) {
        return printed;
    }
    if (!choice.points.empty()) {
        if (auto printed = print_points(choice, *tiles, interrupt, faults); !printed) {
            return printed;
        }
    }
    return report_faults(choice.terrain.terrain, faults.size());
}

} // namespace

Command add_height_command(CLI::App& program, Interrupt& interrupt) {
    auto* arguments = program.add_subcommand("height", "print heights at places on Earth");
    auto choice = std::make_shared<HeightChoice>();
    add_terrain_options(*arguments, choice->terrain);
    auto* at = arguments->add_option_function<std::vector<std::string>>(
        "--at",
        [choice](const std::vector<std::string>& texts) { choice->places = places_of(texts); },
        "latitude and longitude, degrees; again for more places");
    at->type_name("LAT,LON")->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    arguments
        ->add_option("--points", choice->points,
                     "many places: a file of lines LAT,LON, or - for standard input")
        ->type_name("FILE");
    arguments->callback([choice] {
        if (!choice->terrain.imagery.empty()) {
            throw CLI::ValidationError("height: --imagery found, but pictures have no heights: "
                                       "none was expected");
        }
        if (choice->places.empty() && choice->points.empty()) {
            throw CLI::ValidationError("height: no place found, --at LAT,LON or --points FILE was "
                                       "expected");
        }
    });
    arguments->footer(
        "Prints LAT,LON,HEIGHT, one line a place; the height is in metres above the DEM's "
        "own zero, nan on a void, and with --points outside the terrain. In a folder of "
        "tiles the finest has the word, then the newer.\n"
        "Examples:\n"
        "  reljef height N45E006.hgt --at 45.8326,6.8652\n"
        "  reljef height tiles/ --points - < places.csv > heights.csv");
    return {arguments, [choice, &interrupt] { return print_heights(*choice, interrupt); }};
}

} // namespace reljef::app
