#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include "engine/scene/graph/mesh.h"

namespace reljef::session {

/// Where the indices of one building end in the meshes of a square. They begin where those of the
/// building before end.
struct BuildingEnd {
    std::size_t walls = 0;
    std::size_t others = 0;
};

/// Levels of detail of a square of buildings. They belong together: seen from afar both change.
struct BuildingLevels {
    scene::MeshLevels walls;
    scene::MeshLevels others;
};

/// Joins places of each building that edges of up to a tolerance connect, and leaves out parts that
/// are smaller. So each point of a level is within the tolerance of a point of the same colour and
/// normal; how far the square is from the level is proven (scene/levels). A level's walls show the
/// façade at the same size, but elsewhere, so they are for views in which windows are too small to
/// be seen (MeshLevel::repeat). Other faces keep their colours: a texture coordinate for each face.
/// Each level has at most seven eighths of the triangles of the one before.
BuildingLevels building_levels(const scene::Mesh& walls, const scene::Mesh& others,
                               std::span<const BuildingEnd> buildings);
inline constexpr std::array<double, 4> building_tolerances{0.45, 0.9, 1.8, 3.6}; ///< metres

} // namespace reljef::session
