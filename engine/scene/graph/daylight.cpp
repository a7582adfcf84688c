#include "engine/scene/graph/daylight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::scene {
namespace {

// Metres.
constexpr double earth_radius = 6.36e6;
constexpr double air_top = 8.0e4;
constexpr double molecule_height = 8.0e3;
constexpr double aerosol_height = 1.2e3;

// At 680, 550 and 440 nm, the lights of red, green and blue (Bruneton and Neyret 2008), 1/metre.
constexpr glm::dvec3 wavelengths{680.0, 550.0, 440.0};
constexpr glm::dvec3 molecules{5.8e-6, 13.5e-6, 33.1e-6};
constexpr glm::dvec3 ozone{0.65e-6, 1.88e-6, 0.085e-6};
constexpr double aerosol_albedo = 0.9;
constexpr double aerosol_forward = 0.76; // mean cosine
constexpr double ground_albedo = 0.2;

glm::dvec3 aerosols_of(double turbidity) {
    constexpr double angstrom = 1.3; // exponent of continental aerosols (Angstrom 1929)
    const double at_550 = (turbidity - 1.0) * molecules.y * molecule_height / aerosol_height;
    return {at_550 * std::pow(wavelengths.x / 550.0, -angstrom), at_550,
            at_550 * std::pow(wavelengths.z / 550.0, -angstrom)};
}

double rayleigh_phase(double cosine) {
    return 3.0 / (16.0 * std::numbers::pi) * (1.0 + cosine * cosine);
}

// Cornette and Shanks 1992.
double aerosol_phase(double cosine) {
    constexpr double g = aerosol_forward;
    const double base = 1.0 + g * g - 2.0 * g * cosine;
    return 3.0 / (8.0 * std::numbers::pi) * (1.0 - g * g) * (1.0 + cosine * cosine) /
           ((2.0 + g * g) * base * std::sqrt(base));
}

// What a metre of air holds, relative to the ground's.
struct Density {
    double molecules = 0.0;
    double aerosols = 0.0;
    double ozone = 0.0;
};

Density density_at(double height) {
    constexpr double ozone_middle = 2.5e4;
    constexpr double ozone_half = 1.5e4;
    return {std::exp(-height / molecule_height), std::exp(-height / aerosol_height),
            std::max(0.0, 1.0 - std::abs(height - ozone_middle) / ozone_half)};
}

double height_of(glm::dvec3 place) {
    return std::max(glm::length(place) - earth_radius, 0.0);
}

// Metres from a place in the air to the top of the air.
double way_out(glm::dvec3 place, glm::dvec3 direction) {
    const double along = glm::dot(place, direction);
    constexpr double top = earth_radius + air_top;
    return -along + std::sqrt(std::max(along * along - glm::dot(place, place) + top * top, 0.0));
}

bool hits_earth(glm::dvec3 place, glm::dvec3 direction) {
    const double along = glm::dot(place, direction);
    return along < 0.0 && along * along > glm::dot(place, place) - earth_radius * earth_radius;
}

class Atmosphere {
public:
    Atmosphere(double altitude, double turbidity)
        : aerosols_(aerosols_of(turbidity)),
          to_sun_(std::cos(glm::radians(altitude)), 0.0, std::sin(glm::radians(altitude))) {
        // The uniform source: what the sky and the ground send from all sides, scattered again.
        const glm::dvec3 sun = direct() * std::max(to_sun_.z, 0.0) / std::numbers::pi;
        constexpr int orders = 4;
        for (int order = 0; order < orders; ++order) {
            again_ = 0.5 * (hemisphere(1.0) + ground_albedo * (hemisphere(2.0) + sun));
        }
    }

    [[nodiscard]] glm::dvec3 direct() const {
        return hits_earth(eye(), to_sun_) ? glm::dvec3(0.0) : transmittance(eye(), to_sun_);
    }

    // Linear radiance of the sky for a sun of irradiance 1.
    [[nodiscard]] glm::dvec3 sky(glm::dvec3 direction) const {
        constexpr int count = 24;
        const double length = way_out(eye(), direction);
        const double cosine = glm::dot(direction, to_sun_);
        const double by_molecules = rayleigh_phase(cosine);
        const double by_aerosols = aerosol_phase(cosine) * aerosol_albedo;
        glm::dvec3 depth(0.0);
        glm::dvec3 light(0.0);
        double last = 0.0;
        for (int i = 0; i < count; ++i) {
            const double end = length * std::pow((i + 1.0) / count, 2.0); // finer near the eye
            const double step = end - last;
            const glm::dvec3 place = eye() + (last + 0.5 * step) * direction;
            const Density density = density_at(height_of(place));
            const glm::dvec3 fading = extinction_of(density) * step;
            const glm::dvec3 seen = glm::exp(-(depth + 0.5 * fading)) * step;
            const glm::dvec3 sun =
                hits_earth(place, to_sun_) ? glm::dvec3(0.0) : transmittance(place, to_sun_);
            const glm::dvec3 scattered = molecules * density.molecules;
            const glm::dvec3 hazy = aerosols_ * density.aerosols;
            light += seen * (sun * (scattered * by_molecules + hazy * by_aerosols) +
                             again_ * (scattered + aerosol_albedo * hazy));
            depth += fading;
            last = end;
        }
        return light;
    }

    // Mean over the directions above the ground, weighted by the sine of the height to a power - 1.
    [[nodiscard]] glm::dvec3 hemisphere(double power) const {
        constexpr int rings = 6;
        constexpr int sectors = 8;
        glm::dvec3 sum(0.0);
        for (int ring = 0; ring < rings; ++ring) {
            const double up = std::pow((ring + 0.5) / rings, 1.0 / power);
            for (int sector = 0; sector < sectors; ++sector) {
                const double around = 2.0 * std::numbers::pi * (sector + 0.5) / sectors;
                const double out = std::sqrt(1.0 - up * up);
                sum += sky({out * std::cos(around), out * std::sin(around), up});
            }
        }
        return sum / static_cast<double>(rings * sectors);
    }

    [[nodiscard]] glm::dvec3 to_sun() const { return to_sun_; }
    [[nodiscard]] glm::dvec3 at_ground() const { return molecules + aerosols_; }

private:
    static glm::dvec3 eye() { return {0.0, 0.0, earth_radius + 1.0}; }

    [[nodiscard]] glm::dvec3 extinction_of(const Density& density) const {
        return molecules * density.molecules + aerosols_ * density.aerosols + ozone * density.ozone;
    }
    [[nodiscard]] glm::dvec3 transmittance(glm::dvec3 place, glm::dvec3 direction) const {
        constexpr int count = 10;
        const double length = way_out(place, direction);
        glm::dvec3 depth(0.0);
        double last = 0.0;
        for (int i = 0; i < count; ++i) {
            const double end = length * std::pow((i + 1.0) / count, 2.0);
            depth += extinction_of(density_at(height_of(place + 0.5 * (last + end) * direction))) *
                     (end - last);
            last = end;
        }
        return glm::exp(-depth);
    }

    glm::dvec3 aerosols_;
    glm::dvec3 to_sun_;
    glm::dvec3 again_{0.0};
};

double luminance(glm::dvec3 color) {
    return glm::dot(color, {0.2126, 0.7152, 0.0722}); // of sRGB's primaries
}

// Bright light fades towards white instead of being cut off.
glm::vec3 tone_mapped(glm::dvec3 radiance) {
    return glm::vec3(1.0 - glm::exp(-radiance));
}

glm::dvec3 direction_at(double azimuth, double sine) {
    const double out = std::sqrt(1.0 - sine * sine);
    return {out * std::cos(azimuth), out * std::sin(azimuth), sine};
}

constexpr double horizon_sine = 0.02;
constexpr double middle_sine = 0.25;

float curve_through(double share) {
    constexpr double min_curve = 0.08;
    constexpr double max_curve = 2.0;
    const double curve =
        share > middle_sine ? middle_sine * (1.0 - share) / (share - middle_sine) : max_curve;
    return static_cast<float>(std::clamp(curve, min_curve, max_curve));
}

// Means over all azimuths.
glm::dvec3 ring_of(const Atmosphere& air, double sine) {
    constexpr int sectors = 8;
    glm::dvec3 sum(0.0);
    for (int sector = 0; sector < sectors; ++sector) {
        sum += air.sky(direction_at(2.0 * std::numbers::pi * (sector + 0.5) / sectors, sine));
    }
    return sum / static_cast<double>(sectors);
}

// The highest place that is at least 50 degrees from the sun.
glm::dvec3 free_zenith(const Atmosphere& air) {
    const double sun = glm::degrees(std::asin(air.to_sun().z));
    const double height = std::min(90.0, 130.0 - sun);
    return direction_at(std::numbers::pi, std::sin(glm::radians(height)));
}

// Ground that faces a sun 40 degrees high in clear air is neutral, as on daylight film.
constexpr glm::dvec3 white_balance{0.90, 0.99, 1.10};

void set_sky(const Atmosphere& air, glm::dvec3 exposure, Sky& sky) {
    sky.horizon = tone_mapped(exposure * ring_of(air, horizon_sine));
    sky.zenith = tone_mapped(exposure * air.sky(free_zenith(air)));
    const glm::vec3 middle = tone_mapped(exposure * ring_of(air, middle_sine));
    const double low = luminance(glm::dvec3(sky.horizon));
    const double high = luminance(glm::dvec3(sky.zenith));
    sky.curve = std::abs(high - low) > 1e-3
                    ? curve_through((luminance(glm::dvec3(middle)) - low) / (high - low))
                    : 1.0F;
    // 15 degrees beside the sun.
    const double height = std::clamp(glm::degrees(std::asin(air.to_sun().z)), 2.0, 70.0);
    const double sine = std::sin(glm::radians(height));
    const double beside = glm::radians(15.0) / std::cos(glm::radians(height));
    const auto share = static_cast<float>(std::pow(std::cos(glm::radians(15.0)), 8.0));
    const glm::vec3 bright = tone_mapped(exposure * air.sky(direction_at(beside, sine)));
    const glm::vec3 usual = tone_mapped(exposure * ring_of(air, sine));
    sky.glow = glm::max(bright - usual, glm::vec3(0.0F)) / share;
}

} // namespace

Daylight daylight_at(double altitude, double turbidity) {
    const Atmosphere air(altitude, turbidity);
    const glm::dvec3 sun = air.direct();
    const glm::dvec3 sky = air.hemisphere(2.0) * std::numbers::pi; // irradiance of level ground
    // Half of the light on ground that faces the sun, and half of that on level ground: slopes are
    // not too bright at noon, plains not too dark in the evening. Night is as dark as dusk.
    constexpr double desired = 1.38;
    constexpr double darkest = 0.02;
    const double sine = std::max(air.to_sun().z, 0.0);
    const double light = luminance(sun * (0.5 + 0.5 * sine) + sky);
    const double exposure = desired / std::max(light, darkest);
    Daylight result;
    result.sun = glm::vec3(exposure * white_balance * sun);
    // Slopes and shadows also get light from sunny ground.
    result.ambient =
        glm::vec3(exposure * white_balance * (sky + 0.85 * ground_albedo * (sun * sine + sky)));
    // The sky is printed brighter than the ground, as eyes see it.
    constexpr double of_sky = 3.2;
    set_sky(air, of_sky * std::numbers::pi * exposure * white_balance, result.sky);
    const glm::dvec3 fading = air.at_ground();
    result.sky.fading = glm::vec3(3.0 * fading / (fading.x + fading.y + fading.z));
    return result;
}

} // namespace reljef::scene
