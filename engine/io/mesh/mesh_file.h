#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/io/mesh/import_process.h"
#include "engine/scene/graph/mesh.h"

namespace reljef::io {

/// Triangles of one material, in metres, z up; seen from outside.
struct ColoredMesh {
    std::shared_ptr<const scene::Mesh> mesh;
    glm::vec3 color{0.8F};                ///< linear albedo where there is no picture
    std::shared_ptr<const Image> picture; ///< repeats; v = 0 is the upper edge of row 0. Null: none
};

struct MeshFile {
    std::vector<ColoredMesh> parts; ///< at least one triangle together
    Box bounds;                     ///< metres
    std::vector<std::string> notes; ///< at most one on pictures, and one on files of materials
};

inline constexpr std::size_t max_material_changes =
    20'000; ///< of an OBJ file: its importer is slow
inline constexpr std::uint64_t max_face_work = 2'000'000'000; ///< ObjContents::face_work: ~20 s
inline constexpr std::size_t max_mesh_texels = std::size_t{1} << 26U; ///< of a file's pictures

/// Reads an OBJ or glTF 2.0 file as import_mesh(), in a process of its own with limits. Pictures
/// must lie in or below the file's folder, or in the file, and have max_mesh_texels together;
/// without them a part has one colour.
/// Errors name the file, what was found and what was expected.
Result<MeshFile> read_mesh_file(const std::filesystem::path& file, const ImportLimits& limits = {},
                                const std::stop_token& stop = {});

} // namespace reljef::io
