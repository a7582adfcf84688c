// Camera paths and free flight with times and keys that make no sense.
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "bench/stress/stress_run.h"
#include "engine/scene/motion/camera_path.h"
#include "engine/scene/motion/free_flight.h"

namespace reljef::bench {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// Keys that coincide in time or place, or nearly.
std::vector<scene::Keyframe> odd_keys(std::mt19937& random) {
    const auto pick = [&](auto... values) {
        const std::array<double, sizeof...(values)> all{values...};
        return all[random() % all.size()];
    };
    std::vector<scene::Keyframe> keys(1 + random() % 6);
    for (scene::Keyframe& key : keys) {
        key.time = pick(0.0, 0.0, 1.0, 1.0 + 1e-15, 2.0, -3.0, 1e6, 1e-300);
        for (glm::dvec3* const place : {&key.eye, &key.target}) {
            *place = {pick(0.0, 0.0, 1.0, 1e9, -1e9, 1e-300), pick(0.0, 5.0, 5.0 + 1e-12),
                      pick(0.0, 1e-9, 4000.0)};
        }
    }
    return keys;
}

bool is_inside(glm::dvec3 place, const Box& box) {
    // A cubic piece is evaluated to a few units of the last place of its largest term.
    const glm::dvec3 margin = 8.0 * std::numeric_limits<double>::epsilon() *
                              glm::max(glm::abs(box.low), glm::abs(box.high));
    return glm::all(glm::greaterThanEqual(place, box.low - margin)) &&
           glm::all(glm::lessThanEqual(place, box.high + margin));
}

Result<double> count_outside(const std::vector<scene::Keyframe>& keys) {
    const auto path = scene::CameraPath::create(keys);
    if (!path) {
        return path.error();
    }
    Box eyes;
    Box targets;
    for (const scene::Keyframe& key : keys) {
        eyes.add(key.eye);
        targets.add(key.target);
    }
    double outside = 0.0;
    for (const double time : {0.5, 1.0, 0.2, -1e6, 1e6, 0.999999, 1.5, 1e300, -1e300, infinite,
                              -infinite, not_a_number, path->begin(), path->end()}) {
        const scene::Keyframe key = path->at(time);
        outside += is_inside(key.eye, eyes) && is_inside(key.target, targets) ? 0.0 : 1.0;
    }
    return outside;
}

bool is_finite(const scene::Camera& camera) {
    const glm::dvec3 sum = camera.eye + camera.target + camera.up;
    return std::isfinite(sum.x + sum.y + sum.z);
}

double count_bad_flights(int steps) {
    scene::FreeFlightOptions options;
    options.ground = [](glm::dvec3 eye) { return scene::GroundBelow{eye.z - 10.0, 1.0}; };
    scene::FreeFlight flight({.eye = {0.0, 0.0, 20.0}, .target = {0.0, 1.0, 20.0}}, options);
    flight.receive(KeyEvent{.key = Key::w, .pressed = true});
    double bad = 0.0;
    for (int i = 0; i < steps; ++i) {
        constexpr std::array seconds{0.0, 1e6, -1.0, 1e-300, 0.02, infinite, not_a_number};
        static_cast<void>(flight.advance(seconds[static_cast<std::size_t>(i) % seconds.size()]));
        const scene::Camera camera = flight.camera();
        bad += is_finite(camera) && camera.eye.z >= 11.0 ? 0.0 : 1.0;
    }
    return bad;
}

} // namespace

Result<void> stress_paths(StressRun& run) {
    std::mt19937 random(run.options().seed);
    double outside = 0.0;
    for (int i = 0; i < run.cases(2000, 100'000) && !run.stopped(); ++i) {
        const auto count = count_outside(odd_keys(random));
        if (!count) {
            return count.error();
        }
        outside += *count;
    }
    run.add({.stress = "camera path",
             .figure = "places not finite or outside the keys",
             .value = outside,
             .limit = 0.0,
             .at = "coincident keys, times backwards"});
    run.add({.stress = "camera path",
             .figure = "free flights not finite or under the ground",
             .value = count_bad_flights(run.cases(700, 70'000)),
             .limit = 0.0,
             .at = "steps of 0 s to 1e6 s"});
    return {};
}

} // namespace reljef::bench
