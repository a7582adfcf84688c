#include "engine/view/picture/scale_bar.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace reljef::view {
namespace {

constexpr double largest_step = 5.0;
constexpr double metres_a_kilometre = 1000.0;
constexpr double rounding = 1.0 + 1e-9; // of a quotient of two numbers

double power_of_ten(double number) {
    return std::pow(10.0, std::floor(std::log10(number)));
}

} // namespace

ScaleBar scale_bar(double metres_per_pixel, double max_pixels) {
    const double longest = metres_per_pixel * max_pixels;
    const double power = power_of_ten(longest);
    double metres = power;
    for (const double step : {2.0, largest_step}) {
        metres = step * power <= longest ? step * power : metres;
    }
    return {metres, metres / metres_per_pixel};
}

double round_step(double min) {
    const double power = power_of_ten(min);
    constexpr std::array steps{1.0, 2.0, largest_step};
    const auto* const step = std::find_if(steps.begin(), steps.end(), [&](double factor) {
        return factor * power * rounding >= min;
    });
    return power * (step == steps.end() ? 10.0 : *step);
}

std::string text_of_multiple(double number, double step) {
    const double digits = -std::floor(std::log10(step * rounding));
    const auto shown = std::lround(number / step) == 0 ? 0.0 : number; // never "-0"
    return fmt::format("{:.{}f}", shown, static_cast<int>(std::clamp(digits, 0.0, 9.0)));
}

std::string bar_text(double metres) {
    const bool is_far = metres * rounding >= metres_a_kilometre;
    const double shown = is_far ? metres / metres_a_kilometre : metres;
    return text_of_multiple(shown, shown) + (is_far ? " km" : " m");
}

} // namespace reljef::view
