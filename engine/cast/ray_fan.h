#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/cast/beam.h"
#include "engine/cast/picture_rays.h"
#include "engine/core/geometry.h"

namespace reljef::cast {

/// How the rays of a block of pixels depend on the pixel. Constant: all are that of the middle.
enum class FanDegree { constant, linear, second };

inline constexpr std::size_t max_fan_places = 13;

/// The rays of a block of pixels at a depth, in samples (col, row, height in true metres).
struct RayFan {
    double t = 0.0;
    std::size_t count = 0; ///< of the places in the block at which the rays are known
    std::array<glm::dvec3, max_fan_places> samples{};
    PictureRays::Vectors vectors; ///< through the samples
    glm::dvec3 misfit{0.0};       ///< between the vectors and the samples, at most
    Box box;                      ///< around the vectors in the block and the samples

    /// The index of the block's middle.
    [[nodiscard]] std::size_t middle() const { return count > 1 ? 4 : 0; }
};

/// The sample of a pixel's ray at a depth; empty where there is none.
using SampleOfRay = std::function<std::optional<glm::dvec3>(glm::dvec2 pixel, double t)>;

/// Empty if a ray has no finite sample.
std::optional<RayFan> ray_fan(const PixelBlock& block, FanDegree degree, double t,
                              const SampleOfRay& sample_of);

/// The rays of a block between two depths, as polynomials of degree 6 in the depth. Over the curved
/// Earth they are good for hundreds of kilometres.
class FanTrack {
public:
    /// Whether one cannot see at a depth that a sample is not the right one.
    using IsUnseen = std::function<bool(glm::dvec3 found, glm::dvec3 sample, double t)>;

    /// Empty if a ray has no finite sample, or if at depths between its nodes a polynomial is off
    /// by what can be seen. Precondition: depths.begin < depths.end.
    static std::optional<FanTrack> create(const PixelBlock& block, FanDegree degree,
                                          Interval depths, const SampleOfRay& sample_of,
                                          const IsUnseen& is_unseen);

    [[nodiscard]] bool has(double t) const { return t >= depths_.begin && t <= depths_.end; }
    /// The same as ray_fan() with the track's block and degree. Precondition: has(t).
    [[nodiscard]] RayFan fan(double t) const;

private:
    static constexpr std::size_t nodes = 7;
    using Powers = std::array<glm::dvec3, nodes>;

    FanTrack(const PixelBlock& block, FanDegree degree, Interval depths)
        : block_(block), degree_(degree), depths_(depths) {}
    static const std::array<double, nodes>& chebyshev_nodes();
    [[nodiscard]] double depth_of(double part) const;
    [[nodiscard]] glm::dvec3 at(std::size_t place, double t) const;
    [[nodiscard]] bool is_precise(std::size_t place, const SampleOfRay& sample_of,
                                  const IsUnseen& is_unseen) const;

    PixelBlock block_;
    FanDegree degree_;
    Interval depths_;
    std::array<Powers, max_fan_places> powers_{}; // of the place among the depths, -1 to 1
};

} // namespace reljef::cast
