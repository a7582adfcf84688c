#pragma once

#include <array>
#include <string_view>

namespace reljef::building {

/// What the buildings of a generated city are: heights of its terrain, meshes on the bare ground,
/// or meshes on a level plane, which nothing else rises from.
enum class CityForm { heights, meshes, meshes_only };

/// By CityForm.
inline constexpr std::array<std::string_view, 3> city_form_names{"heights", "meshes",
                                                                 "meshes-only"};

/// How the walls of a generated city's heights meet its samples.
enum class CityWalls {
    straight, ///< samples have the mean height of their squares; steep ground shows façades
    stepped ///< samples lie inside or outside, as in surface models: walls follow rows and columns
};

/// By CityWalls.
inline constexpr std::array<std::string_view, 2> city_wall_names{"straight", "stepped"};

} // namespace reljef::building
