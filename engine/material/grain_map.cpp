#include "engine/material/grain_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"
#include "engine/material/noise.h"

namespace reljef::material {
namespace {

// Cycles along a side. Primes, so that the octaves' lattices of equal zeros do not coincide.
constexpr std::array<int, 4> frequencies{5, 11, 23, 47};
constexpr float largest = 1023.0F;

struct ReliefSample {
    float height = 0.0F;
    float brightness = 0.0F;
};

// The noise of a place: `wave` shapes all kinds of ground, and `mottle` colours them, so that lines
// between two kinds do not show as seams.
struct Octave {
    float frequency = 1.0F;
    float wave = 0.0F;
    float mottle = 0.0F;
};
using Octaves = std::array<Octave, frequencies.size()>;

Octaves octaves_at(glm::vec2 place) {
    Octaves octaves;
    std::uint32_t seed = 10;
    std::transform(frequencies.begin(), frequencies.end(), octaves.begin(), [&](int frequency) {
        const glm::vec2 point = place * static_cast<float>(frequency);
        const Octave octave{static_cast<float>(frequency), gradient_noise(seed, point, frequency),
                            gradient_noise(seed + 10, point, frequency)};
        ++seed;
        return octave;
    });
    return octaves;
}

// Rounded hollows and clods.
ReliefSample soil_of(const Octave& octave) {
    return {octave.wave / octave.frequency, 0.4F * octave.wave + octave.mottle};
}

// Stones of all sizes between dark gaps.
ReliefSample scree_of(const Octave& octave) {
    const float stone = std::abs(octave.wave);
    return {stone / octave.frequency, 2.0F * stone + octave.mottle};
}

// Tufts, dark between them.
ReliefSample grass_of(const Octave& octave) {
    return {octave.wave / octave.frequency, 0.8F * octave.wave + octave.mottle};
}

// Ridges between clefts, which are dark.
ReliefSample rock_of(const Octave& octave) {
    const float cleft = std::abs(octave.wave);
    return {-cleft / octave.frequency, 0.5F * octave.mottle - 2.0F * cleft};
}

// Drifts, of which few are small.
ReliefSample snow_of(const Octave& octave) {
    const float drift = octave.wave / std::sqrt(octave.frequency);
    return {drift / octave.frequency, drift};
}

using SampleOf = ReliefSample (*)(const Octave& octave);
constexpr std::array<SampleOf, GrainMap::layer_count> kinds{soil_of, scree_of, grass_of, rock_of,
                                                            snow_of};

// Slopes along x and y, and brightness.
Grid<glm::vec3> slopes_of(const Grid<ReliefSample>& ground) {
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

// Gives the three channels the mean 0 and their standard deviation.
void normalize(Grid<glm::vec3>& grain, glm::vec2 deviation) {
    const auto count = static_cast<double>(grain.size());
    glm::dvec3 sum(0.0);
    glm::dvec3 squares(0.0);
    for (const glm::vec3& texel : grain.samples()) {
        sum += glm::dvec3(texel);
        squares += glm::dvec3(texel) * glm::dvec3(texel);
    }
    const glm::dvec3 mean = sum / count;
    const glm::dvec3 found = glm::sqrt(squares / count - mean * mean);
    const glm::vec3 scale(glm::dvec3(deviation.x, deviation.x, deviation.y) / found);
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

Grid<Octaves> all_octaves() {
    Grid<Octaves> octaves(GrainMap::side, GrainMap::side);
    parallel_for(GrainMap::side, [&](int row) {
        for (int col = 0; col < GrainMap::side; ++col) {
            octaves(col, row) =
                octaves_at(glm::vec2(col, row) / static_cast<float>(GrainMap::side));
        }
    });
    return octaves;
}

ReliefSample sum_of(const Octaves& octaves, SampleOf sample_of) {
    ReliefSample sum;
    for (const Octave& octave : octaves) {
        const ReliefSample ground = sample_of(octave);
        sum.height += ground.height;
        sum.brightness += ground.brightness;
    }
    return sum;
}

Grid<glm::vec3> pattern_of(const Grid<Octaves>& octaves, GrainMap::Layer layer) {
    Grid<ReliefSample> ground(GrainMap::side, GrainMap::side);
    std::transform(octaves.samples().begin(), octaves.samples().end(), ground.samples().begin(),
                   [&](const Octaves& at) { return sum_of(at, kinds.at(layer)); });
    Grid<glm::vec3> grain = slopes_of(ground);
    normalize(grain, GrainMap::deviation(layer));
    return grain;
}

} // namespace

GrainMap::GrainMap() {
    texels_.reserve(layer_count * grain_layer_texels);
    const Grid<Octaves> octaves = all_octaves();
    for (int layer = 0; layer < layer_count; ++layer) {
        append_levels(pattern_of(octaves, static_cast<Layer>(layer)), texels_);
    }
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
