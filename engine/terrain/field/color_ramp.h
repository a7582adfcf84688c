#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::terrain {

/// A colour at a height; between two stops colours are mixed in sRGB.
struct RampStop {
    double height = 0.0;       ///< metres, or a share of the terrain's range
    glm::vec3 color{0.0F};     ///< sRGB, 0..255
    bool is_share = false;     ///< `height` is in [0, 1]
    bool follows_snow = false; ///< `height` is that in the Alps; it moves with the snow line

    friend bool operator==(const RampStop&, const RampStop&) = default;
};

/// Colours of a terrain by height. With `has_cover`, steep ground is rock, and high ground is snow
/// where it is not too steep.
struct ColorRamp {
    std::string name;
    std::vector<RampStop> stops; ///< at least one
    bool has_cover = false;
    bool has_water = true; ///< seas and lakes
    std::optional<Rgba8> no_data;

    friend bool operator==(const ColorRamp&, const ColorRamp&) = default;
};

/// Whether all ground has the same colour.
bool has_one_color(const ColorRamp& ramp);

inline constexpr std::string_view default_ramp = "relief";
inline constexpr std::string_view map_ramp = "atlas"; ///< the default of maps

/// The built-in ramp of this name: "relief", "natural", "swiss", "desert", "clay", "stretched",
/// "atlas".
std::optional<ColorRamp> named_ramp(std::string_view name);

/// Their names, the default first.
std::vector<std::string_view> ramp_names();

/// Where the ramps begin to draw permanent snow, metres, by the latitude in degrees. It is chosen
/// for the look of mountains from the equator to the poles; climates differ by hundreds of metres.
double snow_line(double latitude);

/// Where ramps with cover draw snow on a terrain.
struct SnowCover {
    double height = 0.0;   ///< of the line on ground that faces neither pole, metres
    double poleward = 1.0; ///< 1 in the north, -1 in the south
};
SnowCover snow_cover(const Heightfield& heightfield);
inline constexpr double snow_turn = 200.0;  ///< metres by which it is lower on poleward slopes
inline constexpr double snow_reach = 250.0; ///< metres below the line, from where snow begins

/// The nearest 8-bit colour of one in 0..255; opaque.
Rgba8 rgba8(glm::vec3 color);

/// A ramp over one terrain: colours at any height.
class RampColors {
public:
    RampColors(const ColorRamp& ramp, const Heightfield& heightfield);

    /// sRGB, 0..255; without rock and snow. `height`: metres.
    [[nodiscard]] glm::vec3 at(double height) const;
    /// With rock and snow. `gradient`: ∂z/∂x, ∂z/∂y, metres per metre.
    [[nodiscard]] glm::vec3 at(double height, glm::vec2 gradient) const;
    [[nodiscard]] double snow_height() const { return snow_.height; } ///< metres

private:
    std::vector<RampStop> stops_; // in metres
    bool has_cover_;
    SnowCover snow_;
};

} // namespace reljef::terrain
