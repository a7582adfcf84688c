#include "app/viewer/panels/panel_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "engine/geo/place.h"
#include "engine/view/picture/scale_bar.h"

namespace reljef::app {
namespace {

bool has_format(const PlaceContent& place, PlaceFormat format) {
    switch (format) {
    case PlaceFormat::geographic:
    case PlaceFormat::mgrs:
        return place.on_earth.has_value();
    case PlaceFormat::crs:
        return place.in_crs.has_value();
    case PlaceFormat::scene:
        return true;
    }
    return false;
}

// Rays meet the surface itself, so nothing but the rounding of floats and coarse tiles of a stream
// moves a pixel.
std::string exact_error(std::optional<double> kept) {
    constexpr double smallest_shown = 0.01;
    if (!kept) {
        return "rounding only";
    }
    return *kept < smallest_shown ? std::string("rounding, below 0.01 px")
                                  : fmt::format("at most {:.2g} px", *kept);
}

} // namespace

std::string length_text(double metres) {
    return metres < 0.1       ? fmt::format("{:.2g} mm", 1000.0 * metres)
           : metres < 10.0    ? fmt::format("{:.2f} m", metres)
           : metres < 10000.0 ? fmt::format("{:.0f} m", metres)
                              : fmt::format("{:.1f} km", metres / 1000.0);
}

std::string count_text(std::size_t count) {
    const auto number = static_cast<double>(count);
    return count < 10'000      ? fmt::format("{}", count)
           : count < 1'000'000 ? fmt::format("{:.1f} k", number / 1e3)
                               : fmt::format("{:.2f} M", number / 1e6);
}

std::string short_number(double value) {
    constexpr double many = 1000.0;
    const bool is_whole = value == std::round(value) || std::abs(value) >= many;
    return std::abs(value) < 1e15 && is_whole ? fmt::format("{:.0f}", value)
                                              : fmt::format("{:.4g}", value);
}

std::vector<AxisTick> axis_ticks(double low, double high, double max_count) {
    const double step = view::round_step((high - low) / std::max(max_count, 1.0));
    const double rounding = 1e-9 * step;
    std::vector<AxisTick> ticks;
    for (double number = std::ceil((low - rounding) / step); number * step <= high + rounding;
         number += 1.0) {
        const double value = number == 0.0 ? 0.0 : number * step;
        ticks.push_back({value, view::text_of_multiple(value, step)});
    }
    return ticks;
}

std::string short_text(const scene::Technique& technique) {
    const std::string text = scene::to_string(technique);
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        double value = 0.0;
        constexpr std::string_view digits = "-0123456789";
        const bool begins =
            at > 0 && text[at - 1] == '=' && digits.find(text[at]) != std::string_view::npos;
        const auto [end, code] =
            std::from_chars(text.data() + at, text.data() + text.size(), value);
        if (begins && code == std::errc{}) {
            result += short_number(value);
            at = static_cast<std::size_t>(end - text.data());
        } else {
            result += text[at++];
        }
    }
    return result;
}

std::string technique_summary(const TechniqueContent& content) {
    if (!content.model) {
        return short_text(content.requested);
    }
    const ModelContent& model = content.models.at(*content.model);
    return fmt::format("{}: {}", model.name, short_text(model.technique));
}

PlaceFormat next_format(PlaceFormat format, const PlaceContent& place) {
    constexpr std::array order{PlaceFormat::geographic, PlaceFormat::mgrs, PlaceFormat::crs,
                               PlaceFormat::scene};
    auto index = static_cast<std::size_t>(format);
    do {
        index = (index + 1) % order.size();
    } while (!has_format(place, order.at(index)));
    return order.at(index);
}

std::string place_text(const PlaceContent& place, PlaceFormat format) {
    if (!has_format(place, format)) {
        return place_text(place, PlaceFormat::scene);
    }
    switch (format) {
    case PlaceFormat::geographic:
        return fmt::format("{:.5f}\u00b0 {}  {:.5f}\u00b0 {}", std::abs(place.on_earth->latitude),
                           place.on_earth->latitude < 0.0 ? 'S' : 'N',
                           std::abs(place.on_earth->longitude),
                           place.on_earth->longitude < 0.0 ? 'W' : 'E');
    case PlaceFormat::mgrs:
        return geo::mgrs_text(*place.on_earth);
    case PlaceFormat::crs:
        return fmt::format("{0:.{2}f}, {1:.{2}f}", place.in_crs->at.x, place.in_crs->at.y,
                           place.in_crs->is_metric ? 1 : 6);
    case PlaceFormat::scene:
        break;
    }
    return fmt::format("x {:.1f} m  y {:.1f} m", place.world.x, place.world.y);
}

std::string error_summary(const view::FrameStats& stats, const scene::Technique& technique) {
    if (stats.reliefs_as_triangles > 0) {
        return "triangles: rays not precise here";
    }
    const bool is_exact = technique.id() == scene::TechniqueId::exact;
    const double bound =
        is_exact ? scene::max_expected_error_of_rays : scene::error_bound(technique);
    if (bound > 0.0 && stats.tiles_unproven > 0) {
        return "unproven";
    }
    if (is_exact && stats.kept_error.value_or(0.0) <= bound) {
        return exact_error(stats.kept_error);
    }
    if (stats.kept_error) {
        return *stats.kept_error > bound ? fmt::format("up to {:.1f} px", *stats.kept_error)
                                         : fmt::format("at most {:.2g} px", bound);
    }
    return "no bound";
}

std::string choice_summary(const view::Choice& choice) {
    if (choice.tiles_by_rays == 0) {
        return "triangles";
    }
    if (choice.typical) {
        return fmt::format("unproven {}, right for {:.0f} % of the probes",
                           choice.typical->technique, 100.0 * choice.typical->share);
    }
    return choice.tiles_as_triangles == 0
               ? std::string("rays")
               : fmt::format("{} tiles, rays for {:.0f} %", choice.tiles_as_triangles,
                             100.0 * choice.ray_pixels);
}

} // namespace reljef::app
