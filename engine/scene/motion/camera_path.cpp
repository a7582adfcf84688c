#include "engine/scene/motion/camera_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

namespace reljef::scene {
namespace {

bool is_finite(glm::dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Slope at the middle of three values: zero at an extremum, otherwise the harmonic mean of the two
// secants, which keeps both pieces monotone. One secant may be infinite.
double limited_slope(double before, double after) {
    const bool same_way = (before > 0.0 && after > 0.0) || (before < 0.0 && after < 0.0);
    return same_way ? 2.0 / (1.0 / before + 1.0 / after) : 0.0;
}

struct Knot {
    double time;
    double value;
};

// The piece between b and c with neighbours a and d. Times ascend; a may equal b, and c may equal
// d.
double hermite(Knot a, Knot b, Knot c, Knot d, double time) {
    const double length = c.time - b.time;
    const double rise = c.value - b.value;
    // Slopes are relative to the piece's length, so that they are finite for close neighbours.
    const auto secant = [&](Knot from, Knot to) {
        const double share = (to.time - from.time) / length;
        return share > 0.0 ? (to.value - from.value) / share : 0.0;
    };
    const double slope_b = limited_slope(secant(a, b), rise);
    const double slope_c = limited_slope(rise, secant(c, d));
    const double t = (time - b.time) / length;
    const double value = b.value + t * (slope_b + t * (3.0 * rise - 2.0 * slope_b - slope_c +
                                                       t * (slope_b + slope_c - 2.0 * rise)));
    return std::clamp(value, std::min(b.value, c.value), std::max(b.value, c.value));
}

} // namespace

Camera at_key(Camera camera, const Keyframe& key) {
    camera.eye = key.eye;
    camera.target = key.target;
    camera.up = {0.0, 0.0, 1.0};
    return camera;
}

Result<CameraPath> CameraPath::create(std::vector<Keyframe> keys) {
    if (keys.empty()) {
        return Error{"fly path: no key found, at least one was expected"};
    }
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (!std::isfinite(keys[i].time) || !is_finite(keys[i].eye) || !is_finite(keys[i].target)) {
            return Error{fmt::format("fly path: key {} is not finite", i + 1)};
        }
    }
    sort_by_time(keys);
    return CameraPath(std::move(keys));
}

Keyframe CameraPath::at(double time) const {
    if (!(time > begin())) {
        return keys_.front();
    }
    if (time >= end()) {
        return keys_.back();
    }
    const auto next = std::upper_bound(keys_.begin(), keys_.end(), time,
                                       [](double t, const Keyframe& key) { return t < key.time; });
    const Keyframe& b = *(next - 1);
    const Keyframe& c = *next;
    const Keyframe& a = next - 1 == keys_.begin() ? b : *(next - 2);
    const Keyframe& d = next + 1 == keys_.end() ? c : *(next + 1);
    Keyframe key{time, {}, {}};
    for (int axis = 0; axis < 3; ++axis) {
        const auto along = [&](glm::dvec3 Keyframe::*place) {
            const auto knot = [&](const Keyframe& k) { return Knot{k.time, (k.*place)[axis]}; };
            return hermite(knot(a), knot(b), knot(c), knot(d), time);
        };
        key.eye[axis] = along(&Keyframe::eye);
        key.target[axis] = along(&Keyframe::target);
    }
    return key;
}

namespace {

// At least the values, without their steps: means of the highest values nearby.
std::vector<double> smooth_above(const std::vector<double>& values, std::size_t reach) {
    const auto near = [&](const std::vector<double>& all, std::size_t index) {
        const std::size_t first = index - std::min(index, reach);
        const std::size_t end = std::min(index + reach + 1, all.size());
        return std::span(all).subspan(first, end - first);
    };
    std::vector<double> highest(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        highest[i] = std::ranges::max(near(values, i));
    }
    std::vector<double> means(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto around = near(highest, i);
        means[i] =
            std::accumulate(around.begin(), around.end(), 0.0) / static_cast<double>(around.size());
    }
    return means;
}

} // namespace

CameraPath orbit_path(const Box& bounds, double seconds) {
    constexpr int steps = 64;
    const glm::dvec3 middle = bounds.center();
    const double radius = 0.62 * std::max(bounds.size().x, bounds.size().y);
    std::vector<Keyframe> keys;
    for (int i = 0; i <= steps; ++i) {
        const double angle = glm::radians(360.0 * i / steps - 90.0);
        const glm::dvec3 eye{middle.x + radius * std::cos(angle),
                             middle.y + radius * std::sin(angle), bounds.high.z + 0.45 * radius};
        keys.push_back({seconds * i / steps, eye, {middle.x, middle.y, bounds.low.z}});
    }
    return CameraPath::create(std::move(keys)).value();
}

CameraPath flyover_path(const Box& bounds, const std::function<double(double, double)>& ground,
                        double seconds) {
    constexpr int steps = 48;
    constexpr double ahead = 0.3; // of the flight: what the eye looks at
    const glm::dvec3 size = bounds.size();
    const glm::dvec3 middle = bounds.center();
    const double width = std::max(size.x, size.y);
    const auto track = [&](double share) {
        const double bend = std::sin(share * std::numbers::pi);
        return glm::dvec2(middle.x + size.x * (-0.18 + 0.28 * share * share - 0.12 * bend),
                          middle.y + size.y * (-0.47 + 0.62 * share));
    };
    const auto highest_near = [&](glm::dvec2 at) {
        double highest = bounds.low.z;
        for (int j = -2; j <= 2; ++j) {
            for (int i = -2; i <= 2; ++i) {
                highest =
                    std::max(highest, ground(at.x + 0.02 * width * i, at.y + 0.02 * width * j));
            }
        }
        return highest;
    };
    std::vector<double> highest;
    for (int i = 0; i <= steps; ++i) {
        highest.push_back(highest_near(track(static_cast<double>(i) / steps)));
    }
    const std::vector<double> cleared = smooth_above(highest, 4);
    std::vector<Keyframe> keys;
    for (int i = 0; i <= steps; ++i) {
        const double share = static_cast<double>(i) / steps;
        const glm::dvec2 at = track(share);
        const glm::dvec2 seen = track(share + ahead);
        const double above = std::lerp(0.16, 0.05, std::min(1.0, 1.6 * share)) * width;
        const double eye_z = cleared[static_cast<std::size_t>(i)] + above;
        keys.push_back({seconds * share,
                        {at.x, at.y, eye_z},
                        {seen.x, seen.y, eye_z - 0.07 * width - 0.5 * above}});
    }
    return CameraPath::create(std::move(keys)).value();
}

} // namespace reljef::scene
