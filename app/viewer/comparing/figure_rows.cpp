#include "app/viewer/comparing/figure_rows.h"

#include <cmath>
#include <functional>
#include <string>

#include <fmt/format.h>

#include "engine/session/comparing/error_map.h"

namespace reljef::app {
namespace {

using Text = std::function<std::string(const session::ErrorFigures&)>;

Text pixels(double session::PixelQuantiles::*which) {
    return [which](const session::ErrorFigures& figures) {
        constexpr double smallest_shown = 0.01;
        if (!figures.pixels) {
            return std::string("none");
        }
        const double error = *figures.pixels.*which;
        return error < smallest_shown ? std::string("< 0.01 px") : fmt::format("{:.2g} px", error);
    };
}

std::string percent(double share) {
    return share == 0.0 ? "0 %" : share < 0.01 ? "< 0.01 %" : fmt::format("{:.2f} %", share);
}

} // namespace

std::vector<FigureContent> figure_rows(std::span<const session::ErrorFigures> figures) {
    using session::ErrorFigures;
    using session::PixelQuantiles;
    const std::vector<std::pair<const char*, Text>> texts{
        {"Wrong pixels", [](const ErrorFigures& of) { return percent(of.wrong_percent); }},
        {"Holes", [](const ErrorFigures& of) { return percent(of.hole_percent); }},
        {"Half within", pixels(&PixelQuantiles::median)},
        {"99 % within", pixels(&PixelQuantiles::p99)},
        {"99.9 % within", pixels(&PixelQuantiles::p999)},
        {"All within", pixels(&PixelQuantiles::max)},
        {"PSNR",
         [](const ErrorFigures& of) {
             return of.psnr ? fmt::format("{:.1f} dB", *of.psnr) : std::string("equal");
         }},
        {"SSIM", [](const ErrorFigures& of) {
             return of.ssim ? fmt::format("{:.4f}", *of.ssim) : std::string("none");
         }}};
    std::vector<FigureContent> rows;
    for (const auto& [name, text] : texts) {
        FigureContent row{name, {}, {}};
        row.left = !figures.empty() ? text(figures.front()) : std::string();
        row.right = figures.size() > 1 ? text(figures.back()) : std::string();
        rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<LegendStop> error_colors() {
    constexpr int stops = 17;
    const double decades = std::log10(session::max_mapped_error / session::min_mapped_error);
    std::vector<LegendStop> colors;
    for (int i = 0; i < stops; ++i) {
        const double pixels = session::min_mapped_error * std::pow(10.0, decades * i / (stops - 1));
        colors.push_back({pixels, session::error_color(pixels)});
    }
    return colors;
}

} // namespace reljef::app
