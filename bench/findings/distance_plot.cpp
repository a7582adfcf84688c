#include "bench/findings/distance_plot.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/vec2.hpp>

#include "bench/findings/figures.h"

namespace reljef::bench {
namespace {

struct PlotLine {
    std::string name;
    std::string color;
    std::vector<glm::dvec2> points; // metres, and the quantity
};

// Both axes are logarithmic. That of the quantity is longer if the lines need it, see fitted().
struct PlotPanel {
    std::string title = {};
    std::vector<PlotLine> lines = {};
    double low = 0.01; // of the quantity
    double high = 1000.0;
    double farthest = 10'000.0; // metres
    double left = 0.0;          // of the plot in the picture, SVG units
    double mark = 0.0;          // a line across, with these words
    std::string mark_words = {};
};

constexpr double nearest = 100.0;    // metres
constexpr double plot_width = 330.0; // SVG units
constexpr double plot_top = 40.0;
constexpr double plot_height = 240.0;
constexpr double text_height = 15.0;

struct Drawn {
    std::string name;
    std::string color;
    scene::Technique technique;
    bool as_objects = false; // or as heights
};

std::vector<Drawn> drawn_forms() {
    return {{"plain texture", "#777777", {scene::Texture{}}},
            {"parallax", "#c87800", {scene::Parallax{}}},
            {"relief", "#1f6fb4", {scene::Relief{}}},
            {"buildings, ground", "#2a8a3e", {scene::Polygons{.error = 1.0}}, true}};
}

// The row of each distance in metres.
using RowOf = std::function<RowName(double metres, const Drawn& drawn)>;

Result<PlotLine> line_of(const Drawn& drawn, Quantity quantity, const RowOf& row_of,
                         const CommittedResults& results) {
    PlotLine line{drawn.name, drawn.color, {}};
    for (const double metres : {100.0, 300.0, 1000.0, 3000.0, 10'000.0}) {
        const auto number = results.number(row_of(metres, drawn), quantity);
        if (!number) {
            return number.error();
        }
        if (*number && (*number)->value > 0.0) {
            line.points.emplace_back(metres, (*number)->value);
        }
    }
    return line;
}

RowName error_row(double metres, const Drawn& drawn) {
    return {"distance.json",
            {{"scene", "urban"},
             {"at",
              metres < 1000.0 ? fmt::format("{} m", metres) : fmt::format("{} km", 0.001 * metres)},
             {"label", scene::to_string(drawn.technique)}}};
}

RowName time_row(double metres, const Drawn& drawn) {
    return city({"objects.json", "urban 1024", static_cast<int>(metres)},
                drawn.as_objects ? "meshes" : "heights", drawn.technique);
}

double share_between(double value, double low, double high) {
    return std::log(value / low) / std::log(high / low);
}

glm::dvec2 place_of(const PlotPanel& panel, glm::dvec2 point) {
    return {panel.left + plot_width * share_between(point.x, nearest, panel.farthest),
            plot_top + plot_height * (1.0 - share_between(point.y, panel.low, panel.high))};
}

std::string text_at(glm::dvec2 place, const char* anchor, const std::string& text) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", place.x,
                       place.y, anchor, text);
}

std::string rule(glm::dvec2 from, glm::dvec2 to, const char* color, double width) {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" "
                       "stroke=\"{}\" stroke-width=\"{}\"/>\n",
                       from.x, from.y, to.x, to.y, color, width);
}

std::string axes(const PlotPanel& panel) {
    std::string svg = text_at({panel.left, plot_top - 16.0}, "start", panel.title);
    for (const auto& [metres, name] : {std::pair{100.0, "100 m"},
                                       {300.0, "300 m"},
                                       {1000.0, "1 km"},
                                       {3000.0, "3 km"},
                                       {10'000.0, "10 km"}}) {
        if (metres > panel.farthest) {
            continue;
        }
        const glm::dvec2 bottom = place_of(panel, {metres, panel.low});
        svg += rule(bottom, place_of(panel, {metres, panel.high}), "#e4e4e4", 1.0);
        svg += text_at(bottom + glm::dvec2(0.0, 18.0), "middle", name);
    }
    for (const auto& [value, is_between] : // those for short axes
         {std::pair{0.01, false},
          {0.1, false},
          {1.0, false},
          {10.0, false},
          {20.0, true},
          {50.0, true},
          {100.0, false},
          {200.0, true},
          {500.0, true},
          {1000.0, false}}) {
        if (value < panel.low || value > panel.high || (is_between && panel.low < 1.0)) {
            continue;
        }
        const glm::dvec2 start = place_of(panel, {nearest, value});
        svg += rule(start, place_of(panel, {panel.farthest, value}), "#e4e4e4", 1.0);
        svg += text_at(start + glm::dvec2(-8.0, 4.0), "end", fmt::format("{:g}", value));
    }
    if (!panel.mark_words.empty()) {
        const glm::dvec2 start = place_of(panel, {nearest, panel.mark});
        svg += rule(start, place_of(panel, {panel.farthest, panel.mark}), "#555555", 1.5);
        svg += text_at(start + glm::dvec2(6.0, 16.0), "start", panel.mark_words);
    }
    return svg;
}

std::string line_svg(const PlotPanel& panel, const PlotLine& line) {
    std::vector<std::string> places;
    std::string dots;
    for (const glm::dvec2& point : line.points) {
        const glm::dvec2 place = place_of(panel, point);
        places.push_back(fmt::format("{:.1f},{:.1f}", place.x, place.y));
        dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n",
                            place.x, place.y, line.color);
    }
    return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n",
                       fmt::join(places, " "), line.color) +
           dots;
}

// The names of the lines at their ends, none over another.
std::string names_svg(const PlotPanel& panel, std::vector<PlotLine> lines) {
    const auto end_of = [&](const PlotLine& line) { return place_of(panel, line.points.back()); };
    std::sort(lines.begin(), lines.end(), [&](const PlotLine& first, const PlotLine& second) {
        return end_of(first).y < end_of(second).y;
    });
    std::string svg;
    double free = 0.0; // from here down
    for (const PlotLine& line : lines) {
        glm::dvec2 place = end_of(line) + glm::dvec2(8.0, 4.0);
        place.y = std::max(place.y, free);
        free = place.y + text_height;
        svg +=
            fmt::format("<g fill=\"{}\">{}</g>\n", line.color, text_at(place, "start", line.name));
    }
    return svg;
}

// With a little room around the lines.
PlotPanel fitted(PlotPanel panel) {
    constexpr double room = 1.25;
    for (const PlotLine& line : panel.lines) {
        for (const glm::dvec2& point : line.points) {
            panel.low = std::min(panel.low, point.y / room);
            panel.high = std::max(panel.high, point.y * room);
        }
    }
    return panel;
}

std::string panel_svg(const PlotPanel& given) {
    const PlotPanel panel = fitted(given);
    std::string svg = axes(panel);
    std::vector<PlotLine> lines = panel.lines;
    std::erase_if(lines, [](const PlotLine& line) { return line.points.empty(); });
    for (const PlotLine& line : lines) {
        svg += line_svg(panel, line);
    }
    return svg + names_svg(panel, lines);
}

} // namespace

Result<std::string> distance_plot(const CommittedResults& results) {
    PlotPanel errors{.title = "error over a city, pixels", .left = 60.0};
    errors.mark = 1.0;
    errors.mark_words = "one pixel";
    PlotPanel times{.title = "time of a frame over 476 buildings, ms",
                    .low = 5.0,
                    .high = 150.0,
                    .farthest = 3000.0,
                    .left = 490.0};
    for (const Drawn& drawn : drawn_forms()) {
        auto error = line_of(drawn, Quantity::error_px, error_row, results);
        auto time = line_of(drawn, Quantity::ms, time_row, results);
        if (!error || !time) {
            return error ? time.error() : error.error();
        }
        errors.lines.push_back(std::move(*error));
        times.lines.push_back(std::move(*time));
    }
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 960 310\" "
           "font-family=\"sans-serif\" font-size=\"13\">\n"
           "<title>Error and time over the distance of the eye from a city</title>\n"
           "<rect width=\"960\" height=\"310\" fill=\"white\"/>\n" +
           panel_svg(errors) + panel_svg(times) + "</svg>\n";
}

} // namespace reljef::bench
