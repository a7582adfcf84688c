#include "app/viewer/camera_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "engine/core/geometry.h"
#include "engine/scene/motion/camera_gestures.h"

namespace reljef::app {
namespace {

constexpr double target_distance = 100.0; // metres, of --look

scene::GestureWorld world_of(const scene::TerrainSurface& surface) {
    scene::GestureWorld world;
    world.up = [&surface](glm::dvec3 at) { return surface.placement().up(at); };
    world.north = [&surface](glm::dvec3 at) { return surface.placement().north(at); };
    return world;
}

// Finite numbers separated by commas; empty if there are others.
std::vector<double> numbers_of(std::string_view text) {
    std::vector<double> numbers;
    while (true) {
        const std::string_view first = text.substr(0, text.find(','));
        double value = 0.0;
        const auto [end, code] = std::from_chars(first.data(), first.data() + first.size(), value);
        if (code != std::errc{} || end != first.data() + first.size() || !std::isfinite(value)) {
            return {};
        }
        numbers.push_back(value);
        if (first.size() == text.size()) {
            return numbers;
        }
        text.remove_prefix(first.size() + 1);
    }
}

std::vector<std::string_view> words_of(std::string_view text) {
    std::vector<std::string_view> words;
    while (!text.empty()) {
        const std::string_view word = text.substr(0, text.find(' '));
        if (!word.empty()) {
            words.push_back(word);
        }
        text.remove_prefix(std::min(text.size(), word.size() + 1));
    }
    return words;
}

bool is_point(const std::vector<double>& numbers) {
    return numbers.size() == 3 && std::all_of(numbers.begin(), numbers.end(), [](double number) {
               return std::abs(number) <= max_world_coordinate;
           });
}

std::optional<scene::Camera> on_earth(const scene::TerrainSurface& surface,
                                      const std::vector<double>& numbers,
                                      const scene::Camera& camera) {
    const bool is_place = numbers.size() == 5 && std::abs(numbers[0]) <= 90.0 &&
                          std::abs(numbers[2]) <= max_world_coordinate &&
                          std::abs(numbers[4]) <= 90.0;
    const auto eye =
        is_place && surface.heightfield().georeference
            ? surface.placement().world_from_geodetic({numbers[0], numbers[1], numbers[2]})
            : std::nullopt;
    return eye ? std::optional(
                     scene::upright(camera, *eye, {numbers[3], numbers[4]}, world_of(surface)))
               : std::nullopt;
}

std::string rounded_text(glm::dvec3 point) {
    return fmt::format("{:.4f},{:.4f},{:.4f}", point.x, point.y, point.z);
}

} // namespace

std::string camera_text(const scene::TerrainSurface& surface, const scene::Camera& camera) {
    const auto place = surface.heightfield().georeference
                           ? surface.placement().geodetic_from_world(camera.eye)
                           : std::nullopt;
    if (!place) {
        const glm::dvec3 target = camera.eye + target_distance * scene::view_axes(camera).forward;
        return fmt::format("--eye {} --look {}", rounded_text(camera.eye), rounded_text(target));
    }
    const scene::ViewAngles angles = scene::angles_of(camera, world_of(surface));
    const double heading = angles.heading - 360.0 * std::floor(angles.heading / 360.0);
    return fmt::format("--camera {:.9f},{:.9f},{:.4f},{:.5f},{:.5f}", place->latitude,
                       place->longitude, place->height, heading, angles.pitch);
}

std::optional<scene::Camera> camera_from_text(const scene::TerrainSurface& surface,
                                              std::string_view text, scene::Camera camera) {
    const auto words = words_of(text);
    if (words.size() == 2 && words[0] == "--camera") {
        return on_earth(surface, numbers_of(words[1]), camera);
    }
    if (words.size() != 4 || words[0] != "--eye" || words[2] != "--look") {
        return std::nullopt;
    }
    const auto eye = numbers_of(words[1]);
    const auto target = numbers_of(words[3]);
    if (!is_point(eye) || !is_point(target) || eye == target) {
        return std::nullopt;
    }
    camera.eye = {eye[0], eye[1], eye[2]};
    camera.target = {target[0], target[1], target[2]};
    camera.up = {0.0, 0.0, 1.0};
    return camera;
}

} // namespace reljef::app
