#pragma once

#include <span>
#include <string_view>

namespace reljef::terrains {

/// A scene file that is part of the program.
struct BuiltInScene {
    std::string_view name; ///< TERRAIN on the command line
    std::string_view text; ///< the scene file
};

/// gallery, natural and urban.
std::span<const BuiltInScene> built_in_scenes();

} // namespace reljef::terrains
