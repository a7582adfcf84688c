#include "engine/material/noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::material {
namespace {

float fade(float t) {
    return t * t * t * (t * (t * 6.0F - 15.0F) + 10.0F);
}

// Cheaper than std::lerp, which has branches for exact ends.
float mix(float a, float b, float t) {
    return a + t * (b - a);
}

std::int32_t wrap(std::int32_t cell, std::int32_t period) {
    if (period <= 0 || (cell >= 0 && cell < period)) { // mostly: a division takes longer
        return cell;
    }
    const std::int32_t rest = cell % period;
    return rest < 0 ? rest + period : rest;
}

// One of eight unit directions; a table keeps the bits the same on every machine.
float corner(std::uint32_t seed, std::int32_t x, std::int32_t y, glm::vec2 offset) {
    constexpr float diagonal = 0.70710678F;
    constexpr glm::vec2 directions[8] = {
        {1.0F, 0.0F},  {diagonal, diagonal},   {0.0F, 1.0F},  {-diagonal, diagonal},
        {-1.0F, 0.0F}, {-diagonal, -diagonal}, {0.0F, -1.0F}, {diagonal, -diagonal}};
    const glm::vec2 direction = directions[hash(seed, x, y) >> 29U];
    return direction.x * offset.x + direction.y * offset.y;
}

glm::ivec2 wrap(glm::ivec2 cell, int period) {
    return {wrap(cell.x, period), wrap(cell.y, period)};
}

glm::vec2 seed_point(std::uint32_t seed, glm::ivec2 cell, int period, float jitter) {
    const glm::ivec2 id = wrap(cell, period);
    const glm::vec2 random(unit_hash(seed, id.x, id.y), unit_hash(seed + 1, id.x, id.y));
    return glm::vec2(cell) + 0.5F + jitter * (random - 0.5F);
}

// Calls `visit(cell)` for the squares up to `reach` squares away from `middle`.
template <class Visit> void for_each_near(glm::ivec2 middle, int reach, const Visit& visit) {
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            visit(middle + glm::ivec2(x, y));
        }
    }
}

} // namespace

std::uint32_t hash(std::uint32_t seed, std::int32_t x, std::int32_t y) {
    std::uint32_t bits = seed * 0x9E3779B1U;
    bits = (bits ^ static_cast<std::uint32_t>(x)) * 0x85EBCA77U;
    bits ^= bits >> 15U;
    bits = (bits ^ static_cast<std::uint32_t>(y)) * 0xC2B2AE3DU;
    bits ^= bits >> 16U;
    bits *= 0x85EBCA6BU;
    bits ^= bits >> 13U;
    bits *= 0xC2B2AE35U;
    bits ^= bits >> 16U;
    return bits;
}

float unit_hash(std::uint32_t seed, std::int32_t x, std::int32_t y) {
    return static_cast<float>(hash(seed, x, y) >> 8U) * 0x1p-24F;
}

float gradient_noise(std::uint32_t seed, glm::vec2 point, std::int32_t period) {
    const float floor_x = std::floor(point.x);
    const float floor_y = std::floor(point.y);
    const glm::vec2 f{point.x - floor_x, point.y - floor_y};
    const auto cell_x = static_cast<std::int32_t>(floor_x);
    const auto cell_y = static_cast<std::int32_t>(floor_y);
    const std::int32_t x0 = wrap(cell_x, period);
    const std::int32_t y0 = wrap(cell_y, period);
    const std::int32_t x1 = wrap(cell_x + 1, period);
    const std::int32_t y1 = wrap(cell_y + 1, period);
    const float u = fade(f.x);
    const float v = fade(f.y);
    const float north = mix(corner(seed, x0, y0, f), corner(seed, x1, y0, {f.x - 1.0F, f.y}), u);
    const float south = mix(corner(seed, x0, y1, {f.x, f.y - 1.0F}),
                            corner(seed, x1, y1, {f.x - 1.0F, f.y - 1.0F}), u);
    return 1.5F * mix(north, south, v);
}

float fractal_noise(std::uint32_t seed, glm::vec2 point, const FractalOptions& options) {
    float sum = 0.0F;
    float amplitude = 1.0F;
    float amplitudes = 0.0F;
    std::int32_t period = options.period;
    for (int octave = 0; octave < options.octaves; ++octave) {
        sum += amplitude * gradient_noise(seed + static_cast<std::uint32_t>(octave), point, period);
        amplitudes += amplitude;
        amplitude *= options.gain;
        point *= 2.0F;
        period *= 2;
    }
    return sum / amplitudes;
}

VoronoiCell voronoi(std::uint32_t seed, glm::vec2 point, int period, float jitter) {
    const glm::ivec2 square(glm::floor(point));
    glm::ivec2 nearest = square;
    glm::vec2 place = seed_point(seed, square, period, jitter);
    float distance = glm::distance(point, place);
    for_each_near(square, 1, [&](glm::ivec2 cell) {
        const glm::vec2 other = seed_point(seed, cell, period, jitter);
        const float other_distance = glm::distance(point, other);
        if (other_distance < distance) {
            nearest = cell;
            place = other;
            distance = other_distance;
        }
    });
    float to_edge = std::numeric_limits<float>::max();
    for_each_near(nearest, 2, [&](glm::ivec2 cell) {
        if (cell != nearest) {
            const glm::vec2 other = seed_point(seed, cell, period, jitter);
            const glm::vec2 across = glm::normalize(other - place);
            to_edge = std::min(to_edge, glm::dot(0.5F * (place + other) - point, across));
        }
    });
    return {wrap(nearest, period), point - place, to_edge};
}

} // namespace reljef::material
