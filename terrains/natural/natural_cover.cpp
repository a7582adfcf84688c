#include "terrains/natural/natural_land.h"

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/parallel_for.h"
#include "engine/material/noise.h"

namespace reljef::terrains::natural {
namespace {

using Tint = glm::vec3; // sRGB-encoded, of 255

constexpr float tree_line = 1640.0F;
constexpr float snow_line = 2290.0F;

constexpr Tint snow{229.0F, 233.0F, 238.0F};
constexpr Tint old_snow{203.0F, 209.0F, 214.0F};
constexpr Tint grey_rock{121.0F, 116.0F, 110.0F};
constexpr Tint brown_rock{118.0F, 106.0F, 92.0F};
constexpr Tint pale_rock{156.0F, 149.0F, 138.0F};
constexpr Tint scree{147.0F, 141.0F, 131.0F};
constexpr Tint heath{107.0F, 101.0F, 76.0F};
constexpr Tint alpine_grass{112.0F, 110.0F, 75.0F};
constexpr Tint lush_grass{100.0F, 116.0F, 62.0F};
constexpr Tint hay{137.0F, 138.0F, 90.0F};
constexpr Tint field{132.0F, 124.0F, 92.0F};
constexpr Tint conifers{46.0F, 57.0F, 42.0F};
constexpr Tint broadleaves{72.0F, 82.0F, 51.0F};
constexpr Tint gravel{166.0F, 161.0F, 150.0F};
constexpr Tint stream_water{82.0F, 101.0F, 100.0F};
constexpr Tint lake_water{36.0F, 62.0F, 72.0F};

/// Low-frequency noise, sampled at every `cells`-th cell of the land.
struct SlowNoise {
    int cells = 1;
    Grid<float> values;
};

struct Fall {
    glm::vec2 direction{0.0F}; // downhill, at most 1 long
    float random = 0.0F;       // [-0.5,0.5)
};

struct Surroundings {
    Grid<float> near; // heights averaged over about 100 m
    Grid<float> far;  // heights averaged over about 600 m
    Grid<Fall> fall;  // of `near`
    SlowNoise broad;
    SlowNoise patch;
};

struct Site {
    glm::vec2 place{0.0F}; // col, row
    float height = 0.0F;   // metres above the sea
    float slope = 0.0F;
    float north = 0.0F;  // slope down to the north
    float hollow = 0.0F; // metres below the near average
    float basin = 0.0F;  // metres below the far average
    float above_water = 0.0F;
    float streak = 0.0F; // noise along the fall line, about [-1,1]
    float broad = 0.0F;  // noise over 2 km, about [-1,1]
    float patch = 0.0F;  // noise over 400 m
    float grain = 0.0F;  // noise per cell
    float crowns = 0.0F; // noise over 2×2 cells, about [-0.5,0.5]
};

/// Random numbers averaged along the line of steepest descent (Cabral & Leedom 1993), for gullies,
/// scree and avalanche tracks.
float streak_at(const Grid<Fall>& falls, int col, int row) {
    constexpr int steps = 6;
    float sum = 0.0F;
    for (const float stride : {-0.8F, 0.8F}) {
        glm::vec2 place = glm::vec2(col, row) + 0.5F;
        for (int step = 0; step < steps; ++step) {
            const Fall& fall = falls.clamped(static_cast<int>(place.x), static_cast<int>(place.y));
            sum += fall.random;
            place += stride * fall.direction;
        }
    }
    return 0.5F * sum;
}

float value_at(const SlowNoise& noise, int col, int row) {
    const int x = col / noise.cells;
    const int y = row / noise.cells;
    const float u = static_cast<float>(col % noise.cells) / static_cast<float>(noise.cells);
    const float v = static_cast<float>(row % noise.cells) / static_cast<float>(noise.cells);
    const Grid<float>& values = noise.values;
    return glm::mix(glm::mix(values(x, y), values(x + 1, y), u),
                    glm::mix(values(x, y + 1), values(x + 1, y + 1), u), v);
}

Site site_at(const Land& land, const Surroundings& around, int col, int row, std::uint32_t seed) {
    const Grid<float>& heights = land.heights;
    const float run = 2.0F * design_spacing;
    const float east = (heights.clamped(col + 1, row) - heights.clamped(col - 1, row)) / run;
    const float south = (heights.clamped(col, row + 1) - heights.clamped(col, row - 1)) / run;
    Site site;
    site.place = glm::vec2(col, row);
    site.height = heights(col, row) + base_height;
    site.slope = std::sqrt(east * east + south * south);
    site.north = std::clamp(south, -1.0F, 1.0F);
    site.hollow = around.near(col, row) - heights(col, row);
    site.basin = around.far(col, row) - heights(col, row);
    site.above_water = land.above_water(col, row);
    site.streak = streak_at(around.fall, col, row);
    site.broad = value_at(around.broad, col, row);
    site.patch = value_at(around.patch, col, row);
    site.crowns = 0.5F * (around.fall(col, row).random + around.fall.clamped(col + 1, row).random +
                          around.fall.clamped(col, row + 1).random +
                          around.fall.clamped(col + 1, row + 1).random);
    site.grain = 2.0F * material::unit_hash(seed + 77, col, row) - 1.0F;
    return site;
}

Tint ground(const Site& site) {
    const float high = smoothstep(1500.0F, 2350.0F, site.height + 180.0F * site.patch);
    const float moist = smoothstep(-8.0F, 10.0F, site.hollow + 6.0F * site.patch);
    const Tint low_grass = glm::mix(alpine_grass, lush_grass, 0.35F + 0.65F * moist);
    const Tint tint = glm::mix(low_grass, glm::mix(heath, alpine_grass, moist), high);
    return tint * (1.0F + 0.10F * site.patch + 0.05F * site.grain + 0.06F * site.streak);
}

Tint rock(const Site& site) {
    const float kind = site.broad + 0.3F * site.patch;
    const Tint base = kind > 0.0F ? glm::mix(grey_rock, pale_rock, std::min(1.0F, 1.6F * kind))
                                  : glm::mix(grey_rock, brown_rock, std::min(1.0F, -2.0F * kind));
    const float weathered = 0.82F + 0.18F * smoothstep(1300.0F, 2100.0F, site.height);
    return base * weathered *
           (1.0F + 0.26F * site.streak + 0.07F * site.grain + 0.10F * site.patch -
            0.05F * smoothstep(2.0F, 14.0F, site.hollow));
}

/// Parcels of grass and crops on a valley floor, on a lattice whose direction varies.
Tint parcels(const Site& site, std::uint32_t seed) {
    const float turn =
        std::floor(2.0F * material::gradient_noise(seed + 81, site.place / 70.0F) + 0.5F);
    const glm::vec2 axis = glm::vec2{1.0F, 0.35F + 0.6F * turn} /
                           std::sqrt(1.0F + (0.35F + 0.6F * turn) * (0.35F + 0.6F * turn));
    const float along = glm::dot(site.place, axis) / 6.5F;
    const float across = (site.place.y * axis.x - site.place.x * axis.y) / 3.2F;
    const auto strip = static_cast<std::int32_t>(std::floor(across));
    const float shift = material::unit_hash(seed + 83, strip, 0);
    const auto parcel = static_cast<std::int32_t>(std::floor(along + shift));
    const float kind = material::unit_hash(seed + 85, strip, parcel);
    const float shade = 0.92F + 0.16F * material::unit_hash(seed + 87, strip, parcel);
    const float crops = 1.0F - smoothstep(650.0F, 950.0F, site.height);
    const Tint grass = glm::mix(lush_grass, hay, smoothstep(0.2F, 1.1F, kind));
    const Tint tint = kind < 0.13F * crops ? field : grass;
    return tint * (shade + 0.04F * site.grain + 0.06F * site.patch);
}

Tint trees(const Site& site) {
    const Tint tint =
        glm::mix(conifers, broadleaves,
                 1.0F - smoothstep(650.0F, 1250.0F, site.height + 260.0F * site.patch));
    return tint * (1.0F + 0.20F * site.grain + 0.34F * site.crowns + 0.10F * site.patch +
                   0.06F * site.broad);
}

float forest(const Site& site) {
    const float line = tree_line + 220.0F * site.broad + 300.0F * site.patch +
                       110.0F * site.streak - 4.0F * std::max(site.hollow, 0.0F) -
                       120.0F * std::max(site.north, -0.5F);
    const float below = smoothstep(-70.0F, 60.0F, line - site.height);
    const float steady = 1.0F - smoothstep(1.0F, 1.35F, site.slope + 0.12F * site.streak);
    const float settled = 1.0F - smoothstep(60.0F, 320.0F, site.above_water);
    const float clearing = site.patch + 0.5F * site.broad + 0.2F * site.grain - 0.22F * settled;
    const float dense =
        smoothstep(-0.48F, -0.22F, clearing + 0.5F * smoothstep(0.15F, 0.5F, site.slope) - 0.12F);
    return below * steady * dense;
}

/// 1 on the cleared valley floors.
float meadow(const Site& site) {
    const float flat = 1.0F - smoothstep(0.14F, 0.30F, site.slope + 0.10F * site.patch);
    const float low = 1.0F - smoothstep(1200.0F, 1600.0F, site.height);
    return flat * low * (1.0F - smoothstep(50.0F, 110.0F, site.above_water + 40.0F * site.patch));
}

float snow_cover(const Site& site) {
    const float over = site.height - snow_line + 210.0F * site.north + 150.0F * site.broad +
                       190.0F * site.patch + 80.0F * site.streak +
                       9.0F * std::clamp(site.hollow, -14.0F, 22.0F);
    const float holds =
        1.0F -
        smoothstep(0.85F, 1.35F, site.slope - 0.10F * site.streak - 0.0005F * std::max(over, 0.0F));
    return smoothstep(-60.0F, 110.0F, over + 40.0F * site.grain) * holds;
}

float bare(const Site& site) {
    const float alpine = smoothstep(1700.0F, 2500.0F, site.height + 200.0F * site.patch);
    const float limit = 1.34F - 0.78F * alpine;
    return smoothstep(limit - 0.10F, limit + 0.12F,
                      site.slope + 0.12F * site.streak + 0.16F * site.patch -
                          0.010F * std::clamp(site.hollow, -12.0F, 12.0F));
}

/// Loose stones under the walls and on the highest slopes.
float loose(const Site& site) {
    const float alpine =
        smoothstep(1800.0F, 2300.0F, site.height + 300.0F * site.patch + 120.0F * site.streak);
    const float apron = smoothstep(0.40F, 0.60F, site.slope) *
                        smoothstep(-2.0F, 10.0F, site.hollow) *
                        smoothstep(1400.0F, 2000.0F, site.height);
    return std::max(alpine, apron * smoothstep(-0.1F, 0.3F, site.streak + 0.5F * site.patch));
}

/// Ambient light in hollows and on crests.
float occlusion(const Site& site) {
    return std::clamp(1.0F - 0.0075F * site.hollow - 0.0011F * site.basin, 0.76F, 1.09F);
}

/// Blends `tint()` over `under`; evaluates it only where it is visible.
template <class Work> void lay(Tint& under, float part, const Work& tint) {
    if (part > 0.0F) {
        under = glm::mix(under, tint(), part);
    }
}

Tint snowy(const Site& site) {
    const float fresh = smoothstep(0.0F, 350.0F, site.height - snow_line + 200.0F * site.patch);
    return glm::mix(old_snow, snow, fresh) * (1.0F + 0.02F * site.patch + 0.05F * site.streak);
}

Tint dry_cover(const Site& site, std::uint32_t seed) {
    Tint tint = ground(site);
    lay(tint, 0.9F * loose(site),
        [&] { return scree * (1.0F + 0.22F * site.streak + 0.06F * site.grain); });
    const float floor = meadow(site);
    lay(tint, floor, [&] { return parcels(site, seed); });
    const float hedges = smoothstep(0.80F, 0.92F, site.patch + 0.45F * site.grain);
    lay(tint, std::max(forest(site) * (1.0F - floor), hedges * floor), [&] { return trees(site); });
    lay(tint, bare(site), [&] { return rock(site); });
    lay(tint, snow_cover(site), [&] { return snowy(site); });
    return tint * occlusion(site);
}

Tint cover_at(const Land& land, const Site& site, int col, int row, std::uint32_t seed) {
    Tint tint = dry_cover(site, seed);
    const float stones = 1.0F - smoothstep(1900.0F, 2300.0F, site.height);
    lay(tint, 0.85F * stones * land.gravel(col, row),
        [&] { return gravel * (1.0F + 0.08F * site.grain); });
    const bool lake = land.lake(col, row) != 0;
    lay(tint, land.water(col, row) * (lake ? 1.0F : 0.9F),
        [&] { return (lake ? lake_water : stream_water) * (1.0F + 0.06F * site.patch); });
    return tint;
}

SlowNoise slow_noise(std::uint32_t seed, int cells, float scale,
                     const material::FractalOptions& fractal, const LandOptions& options) {
    const int size = options.size / cells + 2;
    SlowNoise noise{cells, Grid<float>(size, size)};
    for_each_cell(size, size, {options.threads, {}, {}}, [&](int col, int row) {
        noise.values(col, row) = material::fractal_noise(
            seed, glm::vec2(col, row) * (static_cast<float>(cells) / scale), fractal);
    });
    return noise;
}

Surroundings surroundings_of(const Land& land, const LandOptions& options) {
    const int size = land.heights.cols();
    Surroundings around{
        land.heights,
        {},
        Grid<Fall>(size, size),
        slow_noise(options.seed + 73, 8, 90.0F, {.octaves = 2}, options),
        slow_noise(options.seed + 75, 2, 19.0F, {.octaves = 3, .gain = 0.65F}, options)};
    blur(around.near, 2, 2, options.threads);
    around.far = around.near;
    blur(around.far, 15, 2, options.threads);
    for_each_cell(size, size, {options.threads, {}, {}}, [&](int col, int row) {
        const glm::vec2 fall{around.near.clamped(col - 1, row) - around.near.clamped(col + 1, row),
                             around.near.clamped(col, row - 1) - around.near.clamped(col, row + 1)};
        around.fall(col, row) = {fall / (glm::length(fall) + 1.0e-3F),
                                 material::unit_hash(options.seed + 71, col, row) - 0.5F};
    });
    return around;
}

Rgba8 encoded(Tint tint) {
    const auto channel = [](float value) {
        return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
    };
    return {channel(tint.r), channel(tint.g), channel(tint.b), 255};
}

} // namespace

Image paint_cover(const Land& land, const LandOptions& options) {
    const Surroundings around = surroundings_of(land, options);
    Image image(land.heights.cols(), land.heights.rows());
    for_each_cell(image.cols(), image.rows(), {options.threads, {}, {}}, [&](int col, int row) {
        const Site site = site_at(land, around, col, row, options.seed);
        image(col, row) = encoded(cover_at(land, site, col, row, options.seed));
    });
    return image;
}

} // namespace reljef::terrains::natural
