#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"

namespace reljef::terrain {

/// A flat wall of a building, or a part of one, with windows.
struct Facade {
    glm::dvec2 begin{0.0}; ///< col, row; the building lies on the right of the way to the end
    glm::dvec2 end{1.0, 0.0};
    glm::dvec2 windows{0.0, 1.0}; ///< counted along the wall, at its begin and end
    double foot = 0.0;            ///< metres, as heights
    double eaves = 3.0;           ///< above the foot; windows end there
    double storeys = 1.0;         ///< between the two
    double rise = 0.0;            ///< of the wall above the eaves: of a gable, a parapet
    Rgba8 plaster{206, 198, 184, 255};
};

/// The façades that steep ground of a heightfield shows.
struct Facades {
    std::vector<Facade> walls;
    Grid<std::uint32_t> wall_at; ///< 1 + index of the wall near a sample, or 0; empty without walls
};

} // namespace reljef::terrain
