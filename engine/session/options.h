#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/result.h"
#include "engine/geo/georeference.h"
#include "engine/io/tile_set.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/motion/poses.h"
#include "engine/scene/technique/technique.h"
#include "engine/terrain/field/placement.h"

namespace reljef::session {

/// Which terrain to open, and how to read it.
struct SourceOptions {
    /// A built-in name, a scene file (.toml), a DEM file, a folder of them, the address of one, or
    /// web tiles.
    std::string terrain;
    std::vector<std::filesystem::path> imagery; ///< files, folders, addresses
    /// The gallery's detail textures: a built-in set, "mixed" or a folder; absent: the scene
    /// file's.
    std::optional<std::string> textures;
    std::optional<double> exaggeration; ///< absent: the scene file's, else 1
    /// Absent: the scene file's, else the ellipsoid for georeferenced terrain.
    std::optional<terrain::PlacementKind> placement;
    std::optional<geo::GeodeticArea> area; ///< absent: the scene file's, else all
    std::optional<io::Gaps> gaps;          ///< absent: the scene file's, else holes
    std::string geoid;                     ///< a file, "none", or empty: the installed one
    int memory_megabytes = 512;
    int threads = 0; ///< 0: as many as the machine has
    /// Reads a terrain that does not fit the memory tile by tile; else as one coarser terrain.
    /// open_scene() does so only for techniques that draw tiles.
    bool streamed = false;
    /// Streams a terrain that fits the memory, too, if its images are finer than one picture holds.
    /// open_scene() decides this itself.
    bool pictures_streamed = false;
};

/// A camera on Earth.
struct GeodeticView {
    double latitude = 0.0;
    double longitude = 0.0;
    double height = 0.0;  ///< metres above the DEM's zero
    double heading = 0.0; ///< degrees clockwise from north
    double pitch = 0.0;   ///< degrees above the horizon
};

/// A detail texture over the terrain.
struct DetailChoice {
    std::string textures;        ///< a built-in one or a folder
    std::optional<double> width; ///< metres; absent: the scene file's, else 4
    std::optional<double> scale; ///< absent: the scene file's, else the texture's own
};

/// The error bound of a terrain for which neither a technique nor a bound is named, pixels.
inline constexpr double default_max_error = 1.0;

/// How a terrain is drawn, and from where.
struct SceneOptions {
    /// Absent: polygons; in the gallery each model's own.
    std::optional<scene::Technique> technique;
    bool mixed = false; ///< each of the gallery's models has its own, whatever the scene file says
    /// Pixels that polygons may be off; 0: none, every sample is drawn. Absent: default_max_error
    /// where no technique is named either, else as the technique says.
    std::optional<double> max_error;
    std::optional<DetailChoice> detail;               ///< absent: the scene file's, else none
    std::optional<scene::Technique> detail_technique; ///< absent: the scene file's, else relief
    bool wireframe = false;
    double vertical_fov = 57.3; ///< degrees
    scene::ProjectionKind projection = scene::ProjectionKind::perspective;
    std::optional<glm::dvec3> eye;    ///< scene metres; with `look`
    std::optional<glm::dvec3> target; ///< what the camera looks at, scene metres
    std::optional<GeodeticView> geodetic;
    std::optional<scene::Pose> pose;
    std::optional<glm::dvec2> sun; ///< azimuth, altitude, degrees; absent: the scene file's
    /// Makes the maps that the technique needs when the scene is opened (prepared_maps.h).
    bool prepares_maps = true;
};

/// The technique with its error bound. Precondition: check().
scene::Technique technique_of(const SceneOptions& options);

/// Usage errors, which name the program's options: an error bound or a detail texture beside a
/// technique that has none, a camera that looks at itself.
Result<void> check(const SceneOptions& options);

/// The same source, streamed only if these options allow it. Images make a stream of a terrain that
/// fits the memory only if no error bound is named: the error of streamed tiles is an estimate.
SourceOptions streamed_for(SourceOptions source, const SceneOptions& options);

} // namespace reljef::session
