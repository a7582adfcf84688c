#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/result.h"
#include "engine/scene/graph/mesh.h"

namespace reljef::io {

/// The triangles of one material, as the importer passes them on.
struct MeshPart {
    scene::Mesh mesh;
    glm::vec3 color{0.8F};          ///< linear albedo
    std::string texture;            ///< path relative to the file; empty: none, or `picture`
    std::vector<std::byte> picture; ///< a picture file that lies in the mesh's own
};

inline constexpr std::size_t max_mesh_triangles = 2'000'000; ///< of all parts of a file
inline constexpr std::size_t max_mesh_parts = 10'000;
inline constexpr float max_mesh_coordinate = 1e5F; ///< metres; floats have steps of 8 mm there

/// The parts as bytes for decoded_parts().
std::vector<std::byte> encoded_parts(const std::vector<MeshPart>& parts);

/// Trusts nothing: fails on sizes that the bytes do not hold, on more than the limits above, and on
/// indices and coordinates out of range. Normals that are missing or not finite are computed.
Result<std::vector<MeshPart>> decoded_parts(std::span<const std::byte> bytes);

} // namespace reljef::io
