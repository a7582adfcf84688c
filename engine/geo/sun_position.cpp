#include "engine/geo/sun_position.h"

#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace reljef::geo {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double hours_per_day = 24.0;
constexpr double days_per_century = 36'525.0;

std::chrono::year_month_day calendar_day(const UniversalTime& time) {
    return {std::chrono::year(time.year), std::chrono::month(static_cast<unsigned>(time.month)),
            std::chrono::day(static_cast<unsigned>(time.day))};
}

// Days since 2000 January 1, 12 h (the epoch J2000).
double days_since_epoch(const UniversalTime& time) {
    constexpr std::chrono::sys_days epoch = std::chrono::year(2000) / 1 / 1;
    const auto days = (std::chrono::sys_days(calendar_day(time)) - epoch).count();
    return static_cast<double>(days) + time.hours / hours_per_day - 0.5;
}

// The sun's apparent right ascension and declination, radians.
struct Equatorial {
    double ascension = 0.0;
    double declination = 0.0;
};

Equatorial sun_among_stars(double days) {
    const double t = days / days_per_century;
    const double mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
    const double anomaly = (357.52911 + t * (35999.05029 - t * 0.0001537)) * degree;
    const double center = (1.914602 - t * (0.004817 + t * 0.000014)) * std::sin(anomaly) +
                          (0.019993 - t * 0.000101) * std::sin(2.0 * anomaly) +
                          0.000289 * std::sin(3.0 * anomaly);
    const double node = (125.04 - 1934.136 * t) * degree;
    const double longitude =
        (mean_longitude + center - 0.00569 - 0.00478 * std::sin(node)) * degree;
    const double obliquity = (23.439291 - 0.0130042 * t + 0.00256 * std::cos(node)) * degree;
    return {std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude)),
            std::asin(std::sin(obliquity) * std::sin(longitude))};
}

Result<void> check(const UniversalTime& time) {
    if (time.year < first_sun_year || time.year > last_sun_year) {
        return Error{fmt::format("the sun's position: year {} found, {} to {} was expected",
                                 time.year, first_sun_year, last_sun_year)};
    }
    const bool is_day = time.month >= 1 && time.day >= 1 && calendar_day(time).ok();
    if (!is_day || !(time.hours >= 0.0 && time.hours < hours_per_day)) {
        return Error{fmt::format("the sun's position: {:04}-{:02}-{:02} and {} h found, a day of "
                                 "the calendar and 0 to 24 h was expected",
                                 time.year, time.month, time.day, time.hours)};
    }
    return {};
}

// Year, month, day, hours, minutes and seconds of "2026-06-21T12:00:30Z"; seconds and Z may lack.
std::optional<std::array<int, 6>> numbers_of(std::string_view text) {
    constexpr std::string_view form = "dddd-dd-ddTdd:dd:dd";
    constexpr std::size_t without_seconds = form.size() - 3;
    if (text.ends_with('Z')) {
        text.remove_suffix(1);
    }
    if (text.size() != form.size() && text.size() != without_seconds) {
        return std::nullopt;
    }
    std::array<int, 6> numbers{};
    std::size_t part = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool is_digit = text[i] >= '0' && text[i] <= '9';
        if (form[i] == 'd' ? !is_digit : text[i] != form[i]) {
            return std::nullopt;
        }
        if (is_digit) {
            numbers[part] = 10 * numbers[part] + (text[i] - '0');
        } else {
            ++part;
        }
    }
    return numbers;
}

} // namespace

Result<SunPosition> sun_position(const UniversalTime& time, double latitude, double longitude) {
    if (const auto good = check(time); !good) {
        return good.error();
    }
    const double days = days_since_epoch(time);
    const Equatorial sun = sun_among_stars(days);
    const double t = days / days_per_century;
    const double sidereal = 280.46061837 + 360.98564736629 * days + 0.000387933 * t * t;
    const double hour_angle = std::fmod(sidereal + longitude, 360.0) * degree - sun.ascension;
    const double place = latitude * degree;
    const double sine = std::sin(place) * std::sin(sun.declination) +
                        std::cos(place) * std::cos(sun.declination) * std::cos(hour_angle);
    // Meeus counts the azimuth from the south.
    const double from_south =
        std::atan2(std::sin(hour_angle), std::cos(hour_angle) * std::sin(place) -
                                             std::tan(sun.declination) * std::cos(place));
    return SunPosition{std::fmod(from_south / degree + 540.0, 360.0),
                       std::asin(std::fmin(std::fmax(sine, -1.0), 1.0)) / degree};
}

Result<SunPosition> sun_by_day(const UniversalTime& time, double latitude, double longitude) {
    const auto sun = sun_position(time, latitude, longitude);
    return !sun || sun->altitude > 0.0
               ? sun
               : Error{
                     fmt::format("the sun is {:.1f} degrees below the horizon at that time, a time "
                                 "by day was expected",
                                 -sun->altitude)};
}

Result<UniversalTime> universal_time(std::string_view text) {
    const auto numbers = numbers_of(text);
    if (!numbers) {
        return Error{
            fmt::format("'{}' found, a time in UTC was expected, as 2026-06-21T12:00", text)};
    }
    const auto [year, month, day, hours, minutes, seconds] = *numbers;
    const UniversalTime time{year, month, day, hours + minutes / 60.0 + seconds / 3600.0};
    if (minutes > 59 || seconds > 59) {
        return Error{fmt::format("'{}' found, at most 59 minutes and seconds were expected", text)};
    }
    const auto good = check(time);
    return good ? Result<UniversalTime>(time)
                : Error{fmt::format("'{}': {}", text, good.error().message)};
}

UniversalTime day_of_year(int year, int day) {
    const std::chrono::sys_days first = std::chrono::year(year) / 1 / 1;
    const std::chrono::year_month_day found{first + std::chrono::days(day - 1)};
    return {static_cast<int>(found.year()), static_cast<int>(static_cast<unsigned>(found.month())),
            static_cast<int>(static_cast<unsigned>(found.day())), 0.0};
}

} // namespace reljef::geo
