#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

namespace reljef::material {

/// 32 well-mixed bits of three integers (the finalizer of MurmurHash3 over a chain of products).
/// They are the same on every machine.
std::uint32_t hash(std::uint32_t seed, std::int32_t x, std::int32_t y);

/// The hash as a number in [0, 1).
float unit_hash(std::uint32_t seed, std::int32_t x, std::int32_t y);

/// Gradient noise with unit cells (Perlin 2002), about [-1, 1]; `period` > 0 repeats every `period`
/// cells in both directions.
float gradient_noise(std::uint32_t seed, glm::vec2 point, std::int32_t period = 0);

struct FractalOptions {
    int octaves = 6;
    float gain = 0.5F;       ///< amplitude of an octave over the one before
    std::int32_t period = 0; ///< of the first octave, see gradient_noise
};
/// Octaves of gradient noise at doubled frequencies, divided by the sum of their amplitudes.
float fractal_noise(std::uint32_t seed, glm::vec2 point, const FractalOptions& options = {});

/// The cell of a periodic Voronoi diagram that contains a point.
struct VoronoiCell {
    glm::ivec2 id{0};          ///< in [0, period)
    glm::vec2 from_seed{0.0F}; ///< from the cell's seed to the point
    float to_edge = 0.0F;      ///< distance to the nearest border, exact
};

/// Each unit square has one seed, up to `jitter` / 2 off its middle. The diagram repeats every
/// `period` squares (Worley 1996).
VoronoiCell voronoi(std::uint32_t seed, glm::vec2 point, int period, float jitter);

} // namespace reljef::material
