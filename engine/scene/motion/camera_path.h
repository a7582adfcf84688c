#pragma once

#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/core/result.h"

namespace reljef::scene {

/// Where the camera is at a time, and what it looks at. Seconds, world metres.
struct Keyframe {
    double time = 0.0;
    glm::dvec3 eye{0.0};
    glm::dvec3 target{0.0};
};

/// A camera flight through keys: cubic Hermite pieces with tangents limited per coordinate so that
/// no piece leaves the range of its two keys (Fritsch & Carlson 1980): it never overshoots, and
/// stays finite with coincident keys. Before the first key and after the last it stands still; a
/// time that is not a number counts as the beginning.
class CameraPath {
public:
    /// Keys in any order; of keys at one time the last counts. Fails without a key, or with one
    /// that is not finite.
    static Result<CameraPath> create(std::vector<Keyframe> keys);

    [[nodiscard]] Keyframe at(double time) const;
    [[nodiscard]] double begin() const { return keys_.front().time; }
    [[nodiscard]] double end() const { return keys_.back().time; }
    [[nodiscard]] double duration() const { return end() - begin(); }

private:
    explicit CameraPath(std::vector<Keyframe> keys) : keys_(std::move(keys)) {}

    std::vector<Keyframe> keys_; // ascending, distinct times
};

/// Once around the bounds, looking at their middle from above; `seconds` long.
CameraPath orbit_path(const Box& bounds, double seconds = 20.0);

/// In from the south over the middle and on to the north-east, low over the ground: `ground` gives
/// the height of the surface, metres, at x, y.
CameraPath flyover_path(const Box& bounds, const std::function<double(double, double)>& ground,
                        double seconds = 20.0);

} // namespace reljef::scene
