#include "engine/terrain/field/color_ramp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace reljef::terrain {
namespace {

constexpr glm::vec3 rock{134.0F, 127.0F, 120.0F};
constexpr glm::vec3 snow{207.0F, 212.0F, 219.0F};

RampStop of_land(double height, glm::vec3 color) {
    return {height, color, false, true};
}

// Imhof's idea of a relief that the light models: pale, a little warmer and lighter with height.
ColorRamp relief_ramp() {
    return {"relief",
            {{-6000.0, {46.0F, 74.0F, 104.0F}},
             {-200.0, {90.0F, 124.0F, 150.0F}},
             {-1.0, {120.0F, 150.0F, 166.0F}},
             {0.0, {143.0F, 151.0F, 120.0F}},
             of_land(300.0, {148.0F, 155.0F, 121.0F}),
             of_land(900.0, {147.0F, 153.0F, 120.0F}),
             of_land(1600.0, {151.0F, 151.0F, 122.0F}),
             of_land(2200.0, {152.0F, 148.0F, 127.0F}),
             of_land(2700.0, {150.0F, 146.0F, 136.0F}),
             of_land(3400.0, {158.0F, 155.0F, 152.0F}),
             of_land(5000.0, {178.0F, 176.0F, 176.0F})},
            true,
            true,
            {}};
}

// Meadows, woods, alpine grass, rock and snow.
ColorRamp natural_ramp() {
    return {"natural",
            {{-6000.0, {20.0F, 48.0F, 84.0F}},
             {-100.0, {56.0F, 98.0F, 128.0F}},
             {-1.0, {88.0F, 128.0F, 146.0F}},
             {0.0, {122.0F, 140.0F, 88.0F}},
             of_land(400.0, {112.0F, 134.0F, 80.0F}),
             of_land(800.0, {86.0F, 112.0F, 70.0F}),
             of_land(1500.0, {78.0F, 100.0F, 66.0F}),
             of_land(1900.0, {118.0F, 124.0F, 82.0F}),
             of_land(2400.0, {138.0F, 130.0F, 102.0F}),
             of_land(3000.0, {140.0F, 133.0F, 125.0F})},
            true,
            true,
            {}};
}

// Imhof's air perspective: bluish valleys, sunny heights ("Cartographic Relief Presentation").
ColorRamp swiss_ramp() {
    return {"swiss",
            {{-6000.0, {70.0F, 98.0F, 126.0F}},
             {-1.0, {118.0F, 146.0F, 164.0F}},
             {0.0, {122.0F, 144.0F, 140.0F}},
             of_land(600.0, {140.0F, 157.0F, 142.0F}),
             of_land(1400.0, {162.0F, 169.0F, 141.0F}),
             of_land(2200.0, {184.0F, 178.0F, 148.0F}),
             of_land(3000.0, {193.0F, 184.0F, 163.0F}),
             of_land(4500.0, {205.0F, 202.0F, 197.0F})},
            false,
            true,
            {}};
}

ColorRamp desert_ramp() {
    return {"desert",
            {{-6000.0, {46.0F, 74.0F, 104.0F}},
             {-1.0, {120.0F, 150.0F, 166.0F}},
             {0.0, {170.0F, 150.0F, 116.0F}},
             {800.0, {176.0F, 144.0F, 106.0F}},
             {1600.0, {163.0F, 121.0F, 88.0F}},
             {2600.0, {146.0F, 113.0F, 94.0F}},
             {4000.0, {166.0F, 154.0F, 145.0F}}},
            false,
            true,
            {}};
}

ColorRamp clay_ramp() {
    return {"clay", {{0.0, {172.0F, 168.0F, 162.0F}}}, false, false, {}};
}

// Over the range of the terrain, however low it is.
ColorRamp stretched_ramp() {
    constexpr std::array<std::pair<double, glm::vec3>, 7> scale{{{0.00, {94.0F, 123.0F, 81.0F}},
                                                                 {0.15, {119.0F, 139.0F, 91.0F}},
                                                                 {0.32, {159.0F, 159.0F, 111.0F}},
                                                                 {0.50, {160.0F, 139.0F, 97.0F}},
                                                                 {0.68, {133.0F, 106.0F, 77.0F}},
                                                                 {0.84, {141.0F, 133.0F, 126.0F}},
                                                                 {1.00, {205.0F, 205.0F, 207.0F}}}};
    ColorRamp ramp{"stretched", {}, false, true, {}};
    for (const auto& [share, color] : scale) {
        ramp.stops.push_back({share, color, true, false});
    }
    return ramp;
}

// The muted layers of an atlas, from green lowlands to pale heights, over the terrain's own range.
ColorRamp atlas_ramp() {
    ColorRamp ramp{"atlas",
                   {{-6000.0, {86.0F, 118.0F, 146.0F}}, {-1.0, {142.0F, 168.0F, 180.0F}}},
                   false,
                   true,
                   {}};
    constexpr std::array<std::pair<double, glm::vec3>, 6> scale{{{0.00, {134.0F, 150.0F, 118.0F}},
                                                                 {0.20, {160.0F, 166.0F, 128.0F}},
                                                                 {0.42, {186.0F, 176.0F, 138.0F}},
                                                                 {0.64, {178.0F, 156.0F, 124.0F}},
                                                                 {0.84, {162.0F, 142.0F, 124.0F}},
                                                                 {1.00, {188.0F, 179.0F, 170.0F}}}};
    for (const auto& [share, color] : scale) {
        ramp.stops.push_back({share, color, true, false});
    }
    return ramp;
}

using MakeRamp = ColorRamp (*)();
constexpr std::array<std::pair<std::string_view, MakeRamp>, 7> ramps{{{"relief", relief_ramp},
                                                                      {"natural", natural_ramp},
                                                                      {"swiss", swiss_ramp},
                                                                      {"desert", desert_ramp},
                                                                      {"clay", clay_ramp},
                                                                      {"stretched", stretched_ramp},
                                                                      {"atlas", atlas_ramp}}};

// About 2^16 evenly spread samples that are no voids.
std::vector<float> some_heights(const Heightfield& heightfield) {
    const auto heights = heightfield.heights.samples();
    const auto voids = heightfield.void_mask.samples();
    const auto void_count = static_cast<std::size_t>(
        std::count_if(voids.begin(), voids.end(), [](auto v) { return v != 0; }));
    const std::size_t step = std::max<std::size_t>(1, (heights.size() - void_count) >> 16U);
    std::vector<float> picked;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < heights.size(); ++i) {
        if ((voids.empty() || voids[i] == 0) && seen++ % step == 0) {
            picked.push_back(heights[i]);
        }
    }
    return picked;
}

// From the 1st to the 99th percentile of the samples from `lowest` on.
HeightRange usual_range(const Heightfield& heightfield, double lowest) {
    std::vector<float> picked = some_heights(heightfield);
    std::erase_if(picked, [&](float height) { return height < lowest; });
    if (picked.empty()) {
        return heightfield.range;
    }
    const auto at = [&](double share) {
        const auto nth = picked.begin() + static_cast<std::ptrdiff_t>(
                                              share * static_cast<double>(picked.size() - 1));
        std::nth_element(picked.begin(), nth, picked.end());
        return static_cast<double>(*nth);
    };
    return {at(0.01), at(0.99)};
}

constexpr double alpine_latitude = 46.0;

double latitude_of(const Heightfield& heightfield) {
    if (!heightfield.georeference) {
        return alpine_latitude;
    }
    const glm::dvec2 middle =
        0.5 * glm::dvec2(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1);
    return heightfield.georeference->geodetic.latitude_longitude(middle).x;
}

bool is_of_sea(const RampStop& stop) {
    return !stop.is_share && stop.height < 0.0;
}

// Land below the sea, such as polders, is no sea.
bool has_sea_floor(const Heightfield& heightfield) {
    constexpr double deepest_land = -100.0; // metres; only a few basins are deeper
    return heightfield.range.low < deepest_land;
}

// The stops that count on this terrain.
std::vector<RampStop> used_stops(const ColorRamp& ramp, const Heightfield& heightfield) {
    std::vector<RampStop> stops = ramp.stops;
    if (ramp.has_water && !has_sea_floor(heightfield)) {
        std::erase_if(stops, is_of_sea);
    }
    return stops;
}

// Of which shares are. Above a sea that has colours of its own it is the range of the land.
HeightRange shared_range(std::span<const RampStop> stops, const Heightfield& heightfield) {
    if (std::none_of(stops.begin(), stops.end(), [](const auto& stop) { return stop.is_share; })) {
        return {};
    }
    const bool is_land = std::any_of(stops.begin(), stops.end(), is_of_sea);
    return usual_range(heightfield, is_land ? 0.0 : heightfield.range.low);
}

std::vector<RampStop> in_metres(const ColorRamp& ramp, const Heightfield& heightfield,
                                double snow_height) {
    std::vector<RampStop> stops = used_stops(ramp, heightfield);
    const HeightRange range = shared_range(stops, heightfield);
    for (RampStop& stop : stops) {
        if (stop.is_share) {
            stop.height = std::lerp(range.low, range.high, stop.height);
        } else if (stop.follows_snow) {
            stop.height *= snow_height / snow_line(alpine_latitude);
        }
        stop.is_share = stop.follows_snow = false;
    }
    std::stable_sort(stops.begin(), stops.end(),
                     [](const RampStop& a, const RampStop& b) { return a.height < b.height; });
    return stops;
}

} // namespace

Rgba8 rgba8(glm::vec3 color) {
    const glm::vec3 rounded = glm::clamp(color + 0.5F, glm::vec3(0.0F), glm::vec3(255.0F));
    return {static_cast<std::uint8_t>(rounded.r), static_cast<std::uint8_t>(rounded.g),
            static_cast<std::uint8_t>(rounded.b), 255};
}

namespace {

float smooth(double from, double to, double value) {
    return static_cast<float>(glm::smoothstep(from, to, value));
}

} // namespace

bool has_one_color(const ColorRamp& ramp) {
    return !ramp.has_cover &&
           std::all_of(ramp.stops.begin(), ramp.stops.end(), [&](const RampStop& stop) {
               return stop.color == ramp.stops.front().color;
           });
}

std::optional<ColorRamp> named_ramp(std::string_view name) {
    const auto* const found = std::find_if(ramps.begin(), ramps.end(),
                                           [&](const auto& ramp) { return ramp.first == name; });
    return found == ramps.end() ? std::nullopt : std::optional(found->second());
}

std::vector<std::string_view> ramp_names() {
    std::vector<std::string_view> names;
    names.reserve(ramps.size());
    for (const auto& [name, make] : ramps) {
        names.push_back(name);
    }
    return names;
}

double snow_line(double latitude) {
    constexpr std::array<std::pair<double, double>, 7> zones{{{0.0, 4700.0},
                                                              {20.0, 5300.0},
                                                              {35.0, 4400.0},
                                                              {46.0, 2800.0},
                                                              {60.0, 1500.0},
                                                              {75.0, 500.0},
                                                              {90.0, 0.0}}};
    const double place = std::clamp(std::abs(latitude), 0.0, 90.0);
    const auto* const upper = std::find_if(zones.begin() + 1, zones.end() - 1,
                                           [&](const auto& zone) { return place < zone.first; });
    const auto& lower = *(upper - 1);
    return std::lerp(lower.second, upper->second,
                     (place - lower.first) / (upper->first - lower.first));
}

SnowCover snow_cover(const Heightfield& heightfield) {
    const double latitude = latitude_of(heightfield);
    return {snow_line(latitude), latitude < 0.0 ? -1.0 : 1.0};
}

RampColors::RampColors(const ColorRamp& ramp, const Heightfield& heightfield)
    : has_cover_(ramp.has_cover), snow_(snow_cover(heightfield)) {
    stops_ = in_metres(ramp, heightfield, snow_.height);
}

glm::vec3 RampColors::at(double height) const {
    const auto above = std::find_if(stops_.begin(), stops_.end(),
                                    [&](const RampStop& stop) { return height < stop.height; });
    if (above == stops_.begin()) {
        return stops_.front().color;
    }
    if (above == stops_.end()) {
        return stops_.back().color;
    }
    const RampStop& below = *(above - 1);
    const double part = (height - below.height) / (above->height - below.height);
    // Rounding must not leave the range between the two.
    return glm::clamp(glm::mix(below.color, above->color, static_cast<float>(part)),
                      glm::min(below.color, above->color), glm::max(below.color, above->color));
}

glm::vec3 RampColors::at(double height, glm::vec2 gradient) const {
    const glm::vec3 plain = at(height);
    if (!has_cover_ || height < 0.0) {
        return plain;
    }
    // Rise over run. Soil holds to about 35 degrees, snow to about 50 degrees.
    const double slope = glm::length(gradient);
    const double height_share = height / std::max(snow_.height, 1.0);
    const float rocky = smooth(0.5, 1.0, slope + 0.25 * (height_share - 0.7)) * 0.75F;
    const double poleward =
        std::clamp(-snow_.poleward * static_cast<double>(gradient.y), -1.0, 1.0);
    const double line = snow_.height - snow_turn * poleward;
    const float snowy = smooth(line - snow_reach, line + snow_reach, height) *
                        (1.0F - smooth(0.75, 1.5, slope) * 0.9F);
    return glm::mix(glm::mix(plain, rock, rocky), snow, snowy);
}

} // namespace reljef::terrain
