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

} // namespace reljef::building
