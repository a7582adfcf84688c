#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

#include "engine/scene/technique/technique.h"

namespace reljef::scene {

/// The techniques that draw terrains.
inline std::vector<TechniqueInfo> terrain_techniques() {
    std::vector<TechniqueInfo> infos;
    std::copy_if(technique_catalogue().begin(), technique_catalogue().end(),
                 std::back_inserter(infos),
                 [](const TechniqueInfo& info) { return draws_terrain(info.id); });
    return infos;
}

} // namespace reljef::scene
