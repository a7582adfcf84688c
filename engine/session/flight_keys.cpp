#include "engine/session/flight_keys.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <variant>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geo/place.h"
#include "engine/io/checks/lowercase.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/motion/camera_gestures.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::session {
namespace {

constexpr double height_over_ground = 300.0; // metres, for keys without height
constexpr double look_ahead = 1000.0;        // metres
// Between keyframes at constant speed. Where the speed changes steps are at most twice as long;
// then a chord lies 0.7 m below its arc.
constexpr double max_metres_a_step = 3000.0;
constexpr double max_steps = 1e6;

// A place of the flight: at a key, or on the way to the next one.
struct Waypoint {
    double time = 0.0;
    std::size_t key = 0;
    double share = 0.0; // of the time to the next key, [0, 1)
    glm::dvec3 eye{0.0};
};

// The height for a key without one: above the ground, or above 0 outside the terrain.
double default_height(const terrain::Heightfield& heightfield, const geo::Geodetic& place) {
    if (!heightfield.georeference) {
        return height_over_ground;
    }
    const auto sample = heightfield.georeference->geodetic.sample(place.latitude, place.longitude);
    const glm::dvec2 last(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1);
    const bool is_inside = sample && sample->x >= 0.0 && sample->y >= 0.0 && sample->x <= last.x &&
                           sample->y <= last.y;
    return height_over_ground +
           (is_inside ? terrain::bilinear_height(heightfield.heights.view(), *sample) : 0.0);
}

class Route {
public:
    Route(const scene::TerrainSurface& surface, std::span<const io::GeodeticKey> keys)
        : surface_(surface), keys_(keys) {
        for (const io::GeodeticKey& key : keys) {
            const geo::Geodetic place{key.latitude, key.longitude, 0.0};
            places_.push_back(place);
            places_.back().height =
                key.height.value_or(default_height(surface.heightfield(), place));
            if (places_.size() > 1) {
                ways_.push_back(geo::geodesic_between(places_[places_.size() - 2], place));
                way_ += ways_.back().distance;
            }
            profile_.push_back({key.time, {way_, places_.back().height, 0.0}, {}});
        }
    }

    /// Fails if a key has no place in the scene. Skips such places between keys.
    [[nodiscard]] Result<std::vector<Waypoint>> waypoints(const std::string& name) const {
        const auto profile = scene::CameraPath::create(profile_);
        if (!profile) {
            return Error{fmt::format("{}: {}", name, profile.error().message)};
        }
        std::vector<Waypoint> found;
        for (std::size_t key = 0; key < keys_.size(); ++key) {
            const auto eye = surface_.placement().world_from_geodetic(places_[key]);
            if (!eye) {
                return Error{fmt::format("{}: a key at {},{} found, places near {} and a terrain "
                                         "with a place on Earth were expected",
                                         name, keys_[key].latitude, keys_[key].longitude,
                                         surface_.terrain().name)};
            }
            found.push_back({keys_[key].time, key, 0.0, *eye});
            const auto between = places_after(key, *profile);
            found.insert(found.end(), between.begin(), between.end());
        }
        return found;
    }

private:
    [[nodiscard]] std::vector<Waypoint> places_after(std::size_t key,
                                                     const scene::CameraPath& profile) const {
        std::vector<Waypoint> found;
        if (key + 1 == keys_.size()) {
            return found;
        }
        const double step = std::max(max_metres_a_step, way_ / max_steps);
        const int steps = static_cast<int>(std::ceil(ways_[key].distance / step));
        for (int i = 1; i < steps; ++i) {
            const double share = static_cast<double>(i) / steps;
            const double time = std::lerp(keys_[key].time, keys_[key + 1].time, share);
            const glm::dvec3 on_profile = profile.at(time).eye;
            geo::Geodetic place = geo::geodesic_end(places_[key], ways_[key].azimuth_start,
                                                    on_profile.x - profile_[key].eye.x);
            place.height = !keys_[key].height && !keys_[key + 1].height
                               ? default_height(surface_.heightfield(), place)
                               : on_profile.y;
            if (const auto eye = surface_.placement().world_from_geodetic(place)) {
                found.push_back({time, key, share, *eye});
            }
        }
        return found;
    }

    const scene::TerrainSurface& surface_;
    std::span<const io::GeodeticKey> keys_;
    std::vector<geo::Geodetic> places_;
    std::vector<geo::Geodesic> ways_;      // from each key to the next
    std::vector<scene::Keyframe> profile_; // x: metres since the first key, y: height
    double way_ = 0.0;
};

// Along the key's angles, or towards the next place, or at the end as before; look_ahead long.
glm::dvec3 direction_of_key(const terrain::Placement& placement, const io::GeodeticKey& key,
                            std::span<const Waypoint> places, std::size_t index) {
    const glm::dvec3 eye = places[index].eye;
    if (key.heading) {
        const auto camera = scene::camera_from_angles(eye, *key.heading, key.pitch.value_or(0.0),
                                                      {placement.up(eye), placement.north(eye)});
        return look_ahead * glm::normalize(camera.target - camera.eye);
    }
    const std::size_t from =
        index + 1 < places.size() ? index : index - std::min<std::size_t>(index, 1);
    const std::size_t to = std::min(from + 1, places.size() - 1);
    const glm::dvec3 way = places[to].eye - places[from].eye;
    const double length = glm::length(way);
    return length > 0.0 ? way * (look_ahead / length) : glm::dvec3(0.0, look_ahead, 0.0);
}

// Rotates a direction with the local up vector (Rodrigues' formula).
glm::dvec3 rotated_with_up(glm::dvec3 direction, glm::dvec3 from_up, glm::dvec3 to_up) {
    const glm::dvec3 axis = glm::cross(from_up, to_up);
    const glm::dvec3 turned = glm::cross(axis, direction);
    const double whole = std::max(1.0 + glm::dot(from_up, to_up), 1e-12);
    return direction + turned + glm::cross(axis, turned) / whole;
}

// Places between keys interpolate the directions of the keys.
std::vector<scene::Keyframe> with_targets(const terrain::Placement& placement,
                                          std::span<const io::GeodeticKey> keys,
                                          std::span<const Waypoint> places) {
    struct Orientation {
        glm::dvec3 forward{0.0};
        glm::dvec3 up{0.0};
    };
    std::vector<Orientation> of_keys;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (places[i].share == 0.0) {
            of_keys.push_back({direction_of_key(placement, keys[places[i].key], places, i),
                               placement.up(places[i].eye)});
        }
    }
    std::vector<scene::Keyframe> keyframes;
    for (const Waypoint& place : places) {
        const Orientation& key = of_keys[place.key];
        glm::dvec3 forward = key.forward;
        if (place.share > 0.0) {
            const glm::dvec3 up = placement.up(place.eye);
            const Orientation& next = of_keys[place.key + 1];
            forward = glm::mix(rotated_with_up(forward, key.up, up),
                               rotated_with_up(next.forward, next.up, up), place.share);
        }
        keyframes.push_back({place.time, place.eye, place.eye + forward});
    }
    return keyframes;
}

} // namespace

Result<std::vector<scene::Keyframe>> flight_keys(const scene::TerrainSurface& surface,
                                                 std::vector<io::GeodeticKey> keys,
                                                 const std::string& name) {
    scene::sort_by_time(keys);
    const auto places = Route(surface, keys).waypoints(name);
    return places ? Result<std::vector<scene::Keyframe>>(
                        with_targets(surface.placement(), keys, *places))
                  : places.error();
}

Result<io::Flight> flight_of(const scene::TerrainSurface& surface, const scene::CameraPath& path) {
    if (!surface.heightfield().georeference) {
        std::vector<io::PathKey> keys;
        for (const scene::Keyframe& key : path.keys()) {
            keys.push_back({key.time, key.eye, key.target});
        }
        return io::Flight{std::move(keys), {}};
    }
    scene::GestureWorld world;
    world.up = [&surface](glm::dvec3 at) { return surface.placement().up(at); };
    world.north = [&surface](glm::dvec3 at) { return surface.placement().north(at); };
    std::vector<io::GeodeticKey> keys;
    for (const scene::Keyframe& key : path.keys()) {
        const auto place = surface.placement().geodetic_from_world(key.eye);
        if (!place) {
            return Error{fmt::format("a keyframe at {} s beside the map of {} found, one on it was "
                                     "expected",
                                     key.time, surface.terrain().name)};
        }
        const scene::ViewAngles angles = scene::angles_of(scene::at_key({}, key), world);
        keys.push_back({key.time, place->latitude, place->longitude, place->height, angles.heading,
                        angles.pitch});
    }
    return io::Flight{std::move(keys), {}};
}

namespace {

Result<std::vector<scene::Keyframe>>
keyframes_of(const TerrainScene& scene, const io::Flight& flight, const std::string& name) {
    if (const auto* on_earth = std::get_if<std::vector<io::GeodeticKey>>(&flight.keys)) {
        return flight_keys(*scene.terrain->get<scene::TerrainNode>()->surface, *on_earth, name);
    }
    std::vector<scene::Keyframe> keyframes;
    for (const io::PathKey& key : *std::get_if<std::vector<io::PathKey>>(&flight.keys)) {
        keyframes.push_back({key.time, key.eye, key.target});
    }
    return keyframes;
}

} // namespace

Result<scene::CameraPath> open_path(const TerrainScene& scene, const std::string& name, Log& log) {
    if (name == "orbit") {
        return scene::orbit_path(scene.bounds);
    }
    if (name == "flyover") {
        return scene::flyover_path(scene.bounds,
                                   [&](double x, double y) { return scene.ground(x, y); });
    }
    std::error_code ignored;
    if (!std::filesystem::exists(name, ignored)) {
        return Error{
            fmt::format("--path: '{}' found, orbit, flyover or a path file was expected", name)};
    }
    const auto flight = io::read_flight(name);
    if (!flight) {
        return flight.error();
    }
    for (const std::string& note : flight->notes) {
        log.note(note);
    }
    auto keyframes = keyframes_of(scene, *flight, name);
    return keyframes ? scene::CameraPath::create(std::move(*keyframes)) : keyframes.error();
}

bool is_path_file(const std::string& name) {
    return io::extension_of(name) == ".toml";
}

void fly_to(TerrainScene& scene, const scene::CameraPath& path, int index, int frames) {
    const double share = frames > 1 ? static_cast<double>(index) / (frames - 1) : 0.0;
    auto& camera = *scene.camera->get<scene::Camera>();
    camera = scene::at_key(camera, path.at(path.begin() + share * path.duration()));
    camera.up = scene.terrain->get<scene::TerrainNode>()->surface->placement().up(camera.eye);
}

} // namespace reljef::session
