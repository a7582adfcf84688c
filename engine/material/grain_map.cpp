#include "engine/material/grain_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"
#include "engine/material/noise.h"

namespace reljef::material {
namespace {

// Cycles along a side. Primes, so that the octaves' lattices of equal zeros do not coincide.
constexpr std::array<int, 4> frequencies{5, 11, 23, 47};
constexpr float largest = 1023.0F;

struct Ground {
    float height = 0.0F;
    float brightness = 0.0F;
};

// Rounded hollows and clods.
Ground soil_at(glm::vec2 place) {
    Ground ground;
    std::uint32_t seed = 10;
    for (const int frequency : frequencies) {
        const glm::vec2 point = place * static_cast<float>(frequency);
        const float wave = gradient_noise(seed, point, frequency);
        ground.height += wave / static_cast<float>(frequency);
        ground.brightness += 0.4F * wave + gradient_noise(seed + 10, point, frequency);
        ++seed;
    }
    return ground;
}

// Ridges between clefts, which are dark.
Ground rock_at(glm::vec2 place) {
    Ground ground;
    std::uint32_t seed = 30;
    for (const int frequency : frequencies) {
        const glm::vec2 point = place * static_cast<float>(frequency);
        const float ridge = 1.0F - 2.0F * std::abs(gradient_noise(seed, point, frequency));
        ground.height += ridge / static_cast<float>(frequency);
        ground.brightness += ridge + 0.5F * gradient_noise(seed + 10, point, frequency);
        ++seed;
    }
    return ground;
}

// Soft tufts, finer than soil, in patches of different brightness.
Ground grass_at(glm::vec2 place) {
    constexpr std::array tufts{29, 67};
    Ground ground;
    std::uint32_t seed = 50;
    for (const int frequency : tufts) {
        const float tuft = gradient_noise(seed, place * static_cast<float>(frequency), frequency);
        ground.height += tuft / static_cast<float>(frequency);
        ground.brightness += tuft;
        ++seed;
    }
    constexpr std::array patches{5, 11};
    for (const int frequency : patches) {
        const float patch = gradient_noise(seed, place * static_cast<float>(frequency), frequency);
        ground.height += 0.5F * patch / static_cast<float>(frequency);
        ground.brightness += 0.8F * patch;
        ++seed;
    }
    return ground;
}

// Flat stones, each with a tilt and a brightness of its own, and dark gaps between them.
Ground stones_at(std::uint32_t seed, glm::vec2 place, int frequency) {
    constexpr float jitter = 0.9F;
    constexpr float gap = 0.2F; // half its width, in squares
    const VoronoiCell stone =
        voronoi(seed, place * static_cast<float>(frequency), frequency, jitter);
    const auto chance = [&](std::uint32_t use) {
        return unit_hash(seed + use, stone.id.x, stone.id.y) - 0.5F;
    };
    const float inside = std::min(stone.to_edge / gap, 1.0F);
    const glm::vec2 tilt = 1.4F * glm::vec2(chance(1), chance(2));
    Ground ground;
    ground.height =
        (glm::dot(tilt, stone.from_seed) * inside + 0.2F * inside) / static_cast<float>(frequency);
    ground.brightness = 1.2F * inside + 1.6F * chance(3);
    return ground;
}

// Two fifths of the squares have a large stone; gravel lies between them.
Ground scree_at(glm::vec2 place) {
    constexpr int large = 13;
    constexpr int small = 37;
    constexpr float share_of_large = 0.4F;
    const VoronoiCell stone = voronoi(70, place * static_cast<float>(large), large, 0.9F);
    const bool is_stone = unit_hash(71, stone.id.x, stone.id.y) < share_of_large;
    Ground ground = is_stone ? stones_at(70, place, large) : stones_at(80, place, small);
    ground.brightness += 0.4F * gradient_noise(90, place * static_cast<float>(small), small);
    return ground;
}

// Ripples of wind across the diagonal, which come and go.
Ground snow_at(glm::vec2 place) {
    constexpr std::array waves{glm::vec2(8.0F, 9.0F), glm::vec2(21.0F, 17.0F)};
    const float bend = gradient_noise(100, 5.0F * place, 5);
    const float swell = gradient_noise(101, 11.0F * place, 11);
    const float crests = 0.6F + 0.8F * gradient_noise(102, 5.0F * place, 5);
    Ground ground;
    ground.height = 0.4F * swell / 11.0F;
    ground.brightness = 0.4F * bend + 0.5F * swell;
    for (const glm::vec2 wave : waves) {
        const float phase = glm::dot(wave, place) + 1.1F * bend + 0.35F * swell;
        const float crest = std::sin(2.0F * std::numbers::pi_v<float> * phase);
        ground.height += std::max(crests, 0.0F) * crest / glm::length(wave);
        ground.brightness += 0.3F * crest;
    }
    return ground;
}

// Slopes along x and y, and brightness.
Grid<glm::vec3> slopes_of(const Grid<Ground>& ground) {
    constexpr int last = GrainMap::side - 1;
    constexpr float half = 0.5F * GrainMap::side;
    Grid<glm::vec3> grain(GrainMap::side, GrainMap::side);
    parallel_for(GrainMap::side, [&](int row) {
        const auto height = [&](int x, int y) { return ground(x & last, y & last).height; };
        for (int col = 0; col < GrainMap::side; ++col) {
            grain(col, row) = {half * (height(col + 1, row) - height(col - 1, row)),
                               half * (height(col, row + 1) - height(col, row - 1)),
                               ground(col, row).brightness};
        }
    });
    return grain;
}

// Gives the three channels the mean 0 and the same standard deviation.
void normalize(Grid<glm::vec3>& grain) {
    const auto count = static_cast<double>(grain.size());
    glm::dvec3 sum(0.0);
    glm::dvec3 squares(0.0);
    for (const glm::vec3& texel : grain.samples()) {
        sum += glm::dvec3(texel);
        squares += glm::dvec3(texel) * glm::dvec3(texel);
    }
    const glm::dvec3 mean = sum / count;
    const glm::dvec3 deviation = glm::sqrt(squares / count - mean * mean);
    const glm::vec3 scale(static_cast<double>(GrainMap::deviation) / deviation);
    for (glm::vec3& texel : grain.samples()) {
        texel = (texel - glm::vec3(mean)) * scale;
    }
}

std::uint32_t packed(glm::vec3 grain) {
    const glm::vec3 share = glm::clamp(0.5F * grain + 0.5F, glm::vec3(0.0F), glm::vec3(1.0F));
    const auto bits = [](float channel) {
        return static_cast<std::uint32_t>(std::lround(channel * largest));
    };
    return bits(share.x) | bits(share.y) << 10U | bits(share.z) << 20U;
}

Grid<glm::vec3> half_of(const Grid<glm::vec3>& fine) {
    Grid<glm::vec3> coarse(fine.cols() / 2, fine.rows() / 2);
    for (int row = 0; row < coarse.rows(); ++row) {
        for (int col = 0; col < coarse.cols(); ++col) {
            const int x = 2 * col;
            const int y = 2 * row;
            coarse(col, row) =
                0.25F * (fine(x, y) + fine(x + 1, y) + fine(x, y + 1) + fine(x + 1, y + 1));
        }
    }
    return coarse;
}

void append_levels(Grid<glm::vec3> grain, std::vector<std::uint32_t>& texels) {
    for (int level = 0; level < GrainMap::level_count; ++level) {
        std::transform(grain.samples().begin(), grain.samples().end(), std::back_inserter(texels),
                       packed);
        grain = half_of(grain);
    }
}

template <class GroundAt> Grid<glm::vec3> pattern_of(const GroundAt& ground_at) {
    Grid<Ground> ground(GrainMap::side, GrainMap::side);
    parallel_for(GrainMap::side, [&](int row) {
        for (int col = 0; col < GrainMap::side; ++col) {
            ground(col, row) = ground_at(glm::vec2(col, row) / static_cast<float>(GrainMap::side));
        }
    });
    Grid<glm::vec3> grain = slopes_of(ground);
    normalize(grain);
    return grain;
}

} // namespace

GrainMap::GrainMap() {
    texels_.reserve(layer_count * grain_layer_texels);
    append_levels(pattern_of(soil_at), texels_);
    append_levels(pattern_of(rock_at), texels_);
    append_levels(pattern_of(grass_at), texels_);
    append_levels(pattern_of(scree_at), texels_);
    append_levels(pattern_of(snow_at), texels_);
}

std::span<const std::uint32_t> GrainMap::level(Layer layer, int level) const {
    return std::span(texels_).subspan(
        static_cast<std::size_t>(layer) * grain_layer_texels + begin(level), texels_of(level));
}

glm::vec3 grain_of(std::uint32_t texel) {
    const auto channel = [&](unsigned shift) {
        return 2.0F * static_cast<float>(texel >> shift & 1023U) / largest - 1.0F;
    };
    return {channel(0), channel(10), channel(20)};
}

} // namespace reljef::material
