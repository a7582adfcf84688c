#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/result.h"

namespace reljef::io {

/// What the lines of an OBJ file say.
struct ObjContents {
    std::uint64_t triangles = 0;        ///< of all faces; a face of n corners has n - 2
    std::uint64_t max_corners = 0;      ///< of one face
    std::uint64_t face_work = 0;        ///< squares of the corners of faces with over four
    std::uint64_t material_changes = 0; ///< lines that name another material than the one before
    std::vector<std::string>
        libraries; ///< the first max_obj_libraries files of materials, as named
};
inline constexpr std::size_t max_obj_libraries = 100;

/// Reads an OBJ file once, in a memory of a megabyte. Fails if the file cannot be read; the error
/// begins with the file.
Result<ObjContents> obj_contents(const std::filesystem::path& file);

} // namespace reljef::io
