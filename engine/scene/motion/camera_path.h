#pragma once

#include <algorithm>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/core/result.h"
#include "engine/scene/graph/camera.h"

namespace reljef::scene {

/// Seconds, world metres.
struct Keyframe {
    double time = 0.0;
    glm::dvec3 eye{0.0};
    glm::dvec3 target{0.0};
};

/// The camera at a keyframe, upright.
Camera at_key(Camera camera, const Keyframe& key);

/// Sorts keys by time and keeps the last one at each time.
template <class Key> void sort_by_time(std::vector<Key>& keys) {
    std::stable_sort(keys.begin(), keys.end(),
                     [](const Key& a, const Key& b) { return a.time < b.time; });
    const auto kept = std::unique(keys.rbegin(), keys.rend(), [](const Key& a, const Key& b) {
                          return a.time == b.time;
                      }).base();
    keys.erase(keys.begin(), kept);
}

/// Cubic Hermite pieces through keyframes, with tangents limited per coordinate so that no piece
/// leaves the range of its two keys (Fritsch & Carlson 1980). Never overshoots; finite for
/// coincident keys. Stands still before the first and after the last key. A time that is not a
/// number is the beginning.
class CameraPath {
public:
    /// Keys in any order; the last one at a time counts. Fails without keys, and on keys that are
    /// not finite.
    static Result<CameraPath> create(std::vector<Keyframe> keys);

    [[nodiscard]] Keyframe at(double time) const;
    /// At least one; ascending, distinct times.
    [[nodiscard]] std::span<const Keyframe> keys() const { return keys_; }
    [[nodiscard]] double begin() const { return keys_.front().time; }
    [[nodiscard]] double end() const { return keys_.back().time; }
    [[nodiscard]] double duration() const { return end() - begin(); }

private:
    explicit CameraPath(std::vector<Keyframe> keys) : keys_(std::move(keys)) {}

    std::vector<Keyframe> keys_; // ascending, distinct times
};

/// Once around the bounds, looking down at their middle.
CameraPath orbit_path(const Box& bounds, double seconds = 20.0);

/// From the south over the middle to the north-east, low above the ground. Eye and target stay
/// within the bounds. `ground`: height of the surface at x, y, metres.
CameraPath flyover_path(const Box& bounds, const std::function<double(double, double)>& ground,
                        double seconds = 20.0);

} // namespace reljef::scene
