#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace reljef::test {

/// A file of the project.
struct SourceFile {
    std::string path; ///< from the root, "engine/core/grid.h"
    std::string text;
};

/// One sentence for each place where a rule is broken; empty where it holds.
using Complaints = std::vector<std::string>;

/// The text with comments and the insides of literals blanked: same length, same lines.
std::string code_of(std::string_view text);

/// What a file includes, as written, in order.
struct Include {
    std::string path;
    bool quoted = false;
};
std::vector<Include> includes_of(std::string_view text);

/// Includes of the project's files that the table does not allow, or that do not start at the root.
Complaints forbidden_includes(const SourceFile& file);

/// GeographicLib outside engine/geo, GDAL outside engine/io, OpenImageIO outside
/// engine/io/codec (the tests of these rooms may), CLI11 outside the programs.
Complaints libraries_outside_their_room(const SourceFile& file);

/// OpenGL's, EGL's and GLFW's headers, and calls of gl functions, outside engine/gl,
/// engine/platform, engine/render and the tests with a context.
Complaints gl_outside_its_rooms(const SourceFile& file);

/// What sets uniforms by their names, or binds to units and binding points by number, in
/// engine/render: engine/render/shaders alone declares them.
Complaints uniforms_by_string(const SourceFile& file);

/// Techniques and their parameters written as text, such as "polygons:error=1", and literals given
/// to parse_technique. Code holds scene::Technique values. Allowed in engine/scene/technique,
/// app/cli (help texts), terrains (descriptions of models) and tests.
Complaints techniques_by_string(const SourceFile& file);

/// Code of the library that prints, ends the process or throws. engine/core/check, which ends the
/// process on a broken precondition, may.
Complaints printing_exiting_or_throwing(const SourceFile& file);

/// Folders that exist on one machine only.
Complaints machine_paths(const SourceFile& file);

/// Names of the standard library, of fmt and of glm in headers that include what declares them
/// neither themselves nor through the project's headers: what all rooms have precompiled would hide
/// it.
Complaints missing_includes(std::span<const SourceFile> files);

/// Files that include each other in a circle, each circle once.
Complaints include_circles(std::span<const SourceFile> files);

/// Sources and headers that no CMakeLists.txt names: that of their folder, or the nearest above.
Complaints unlisted_files(std::span<const SourceFile> files);

/// Headers of the library that are installed (HEADERS of their CMakeLists.txt) and include one of
/// the project's that is not.
Complaints private_headers_in_public_ones(std::span<const SourceFile> files);

/// How many concepts a folder holds at most. A header, its source and its tests are one concept.
inline constexpr std::size_t max_concepts = 16;
Complaints crowded_folders(std::span<const SourceFile> files);

/// Lines of a file of code at most.
inline constexpr std::ptrdiff_t max_lines = 500;
Complaints long_file(const SourceFile& file);

} // namespace reljef::test
