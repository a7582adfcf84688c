#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/result.h"
#include "engine/io/tile_set.h"
#include "engine/platform/context.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/motion/poses.h"
#include "engine/scene/technique/technique.h"
#include "engine/terrain/field/placement.h"

namespace CLI {
class App;
}

namespace reljef::cli {

/// Which terrain, and how it is read.
struct TerrainChoice {
    std::string terrain; ///< a built-in name, a scene file (.toml), a DEM file or a folder of them
    std::vector<std::filesystem::path> imagery; ///< files, folders, addresses
    /// The gallery's tiles: a built-in set, "mixed" or a folder; absent: the scene file's.
    std::optional<std::string> textures;
    std::optional<double> exaggeration; ///< absent: the scene file's, else 1
    std::optional<terrain::PlacementKind> placement;
    std::optional<geo::GeodeticArea> area; ///< absent: the scene file's, else all
    std::optional<io::Gaps> gaps;          ///< absent: the scene file's, else holes
    std::string geoid;                     ///< a file, "none", or empty: the installed one
    int memory_megabytes = 512;
    int threads = 0; ///< 0: as many as the machine has
    bool quiet = false;
    /// Whether what does not fit the memory may be read part by part; a program's choice.
    bool streamed = false;
    /// Whether what does may be, too, where images are finer than one picture over it all holds.
    bool pictures_streamed = false;
};

/// From where on Earth, and whereto: --camera.
struct GeodeticView {
    double latitude = 0.0;
    double longitude = 0.0;
    double height = 0.0;  ///< metres above the DEM's zero
    double heading = 0.0; ///< degrees clockwise from north
    double pitch = 0.0;   ///< degrees above the horizon
};

/// A tile of detail over the terrain: --detail.
struct DetailChoice {
    std::string textures;        ///< a built-in tile or a folder
    std::optional<double> width; ///< metres; absent: the scene file's, else 4
    std::optional<double> scale; ///< absent: the scene file's, else the tile's own
};

/// Where the camera stands and what the picture is like.
struct ViewChoice {
    std::optional<platform::ContextKind> context; ///< absent: auto
    glm::ivec2 size{1024, 768};
    std::optional<scene::Technique>
        technique;      ///< absent: polygons; the gallery's own on its models
    bool mixed = false; ///< the technique of each of the gallery's models is its own, whatever the
                        ///< scene file says
    std::optional<double> max_error;    ///< pixels, of polygons; absent: as the technique says
    std::optional<DetailChoice> detail; ///< absent: the scene file's, else none
    std::optional<scene::Technique> detail_technique; ///< absent: the scene file's, else relief
    bool wireframe = false;
    std::optional<int> samples; ///< of a pixel; absent: 4 where the picture has triangles, else 1
    double vertical_fov = 57.3;
    scene::ProjectionKind projection = scene::ProjectionKind::perspective;
    std::optional<glm::dvec3> eye;
    std::optional<glm::dvec3> look;
    std::optional<GeodeticView> geodetic;
    std::optional<scene::Pose> pose;
    std::optional<glm::dvec2> sun; ///< azimuth, altitude, degrees; absent: the scene file's
    std::string path; ///< a built-in path ("orbit", "flyover") or a path file; empty: none
    int frames = 1;
    double frames_per_second = 25.0;
    std::filesystem::path shader_dir;
};

/// The largest picture side that may be asked for, pixels.
inline constexpr int largest_picture_side = 16384;

/// A pose by its name; the error names the option --pose.
Result<scene::Pose> parse_pose(std::string_view text);
/// Parses "1024x768". Each side 1 … largest_picture_side.
Result<glm::ivec2> parse_size(std::string_view text);

/// Parses "NAME", or "NAME:width=METRES,scale=S", NAME a built-in tile or a folder.
Result<DetailChoice> parse_detail(const std::string& text);

/// Parses exactly `N` finite numbers separated by commas; `option` is named in the error.
template <std::size_t N>
Result<std::array<double, N>> parse_numbers(std::string_view option, std::string_view text,
                                            std::string_view expected);

/// Adds the options of a group to a command; they are checked as they are parsed (CLI::ParseError).
void add_terrain_options(CLI::App& command, TerrainChoice& choice);
/// Of these, what says which heights there are and how they are read, not how they are drawn.
void add_source_options(CLI::App& command, TerrainChoice& choice);
void add_view_options(CLI::App& command, ViewChoice& choice);
/// --samples, for what draws pictures to be looked at.
void add_samples_option(CLI::App& command, ViewChoice& choice);
/// The technique with --max-error.
scene::Technique technique_of(const ViewChoice& choice);
/// Whether the technique draws a terrain that is read part by part.
bool may_stream(const ViewChoice& choice);
/// Whether images may make a terrain a stream of tiles: not where its error is promised, which is
/// an estimate there.
bool may_stream_pictures(const ViewChoice& choice);
/// What only all options together show to be wrong (CLI::ParseError). For the command's callback.
void check_view_options(const ViewChoice& choice);

} // namespace reljef::cli
