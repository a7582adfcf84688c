#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/building/city_form.h"
#include "engine/core/result.h"
#include "engine/geo/georeference.h"
#include "engine/geo/sun_position.h"
#include "engine/io/formats/scene_file.h"
#include "engine/io/tile_set.h"
#include "engine/platform/context.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/motion/poses.h"
#include "engine/scene/technique/technique.h"
#include "engine/terrain/field/placement.h"

namespace reljef::session {

/// The index that proves the errors of streamed tiles (terrain_index.h): none, one that is there,
/// or one that open_scene() makes first if the user names an error bound.
enum class IndexUse { none, existing, made };

/// What draws frames: an OpenGL context of a kind, or rays on the CPU without OpenGL.
enum class BackendKind { osmesa, egl, glfw, cpu };
/// As on the command line.
std::string_view to_string(BackendKind kind);
std::optional<BackendKind> backend_from_string(std::string_view text);
/// Empty: rays need no context.
std::optional<platform::ContextKind> context_of(BackendKind kind);

/// Whether rays on the CPU draw: never, what they can draw, or all.
enum class RayUse { none, preferred, only };

struct SourceOptions {
    /// A built-in name, a scene file (.toml), a DEM file or its address, a folder of them, or web
    /// tiles.
    std::string terrain;
    std::vector<std::filesystem::path> imagery; ///< files, folders, addresses
    /// The gallery's materials: a built-in one, "mixed" or a folder; absent: the scene file's.
    std::optional<std::string> textures;
    /// The form of the city `urban`; absent: the scene file's, else heights.
    std::optional<building::CityForm> buildings;
    std::optional<building::CityWalls> walls; ///< of its heights; absent: the scene file's
    std::optional<double> exaggeration;       ///< absent: the scene file's, else 1
    /// Colours by height: a built-in ramp or a colour file; absent: the scene file's, else
    /// "relief", on maps "atlas".
    std::optional<std::string> ramp;
    std::optional<double> imagery_share; ///< [0, 1]; absent: the scene file's, else 1
    /// Absent: the scene file's, else the ellipsoid for georeferenced terrain.
    std::optional<terrain::PlacementKind> placement;
    std::optional<geo::GeodeticArea> area; ///< absent: the scene file's, else all
    std::optional<io::Gaps> gaps;          ///< absent: the scene file's, else holes
    std::string geoid;                     ///< a file, "none", or empty: the installed one
    /// Files may refer to files anywhere, and be in any format of GDAL; see io::allow_external.
    bool allow_external = false;
    int memory_megabytes = 512;
    int threads = 0; ///< 0: as many as the machine has
    /// Streams a terrain that does not fit in memory; otherwise it is read as one coarser terrain.
    /// open_scene() streams only for techniques that draw tiles.
    bool streamed = false;
    /// Also streams a terrain whose images are finer than one picture. open_scene() sets this.
    bool pictures_streamed = false;
    IndexUse index = IndexUse::none;
};

struct GeodeticView {
    double latitude = 0.0;
    double longitude = 0.0;
    double height = 0.0;  ///< metres above the DEM's zero
    double heading = 0.0; ///< degrees clockwise from north
    double pitch = 0.0;   ///< degrees above the horizon
};

struct DetailChoice {
    std::string textures;        ///< a built-in material or a folder
    std::optional<double> width; ///< metres; absent: the scene file's, else 4
    std::optional<double> scale; ///< absent: the scene file's, else the material's
};

/// What lies beyond the terrain's edge.
enum class BaseKind { plane, solid, none };
std::string_view to_string(BaseKind kind);

/// The default error bound if no technique is named either, pixels.
inline constexpr double default_max_error = 1.0;

/// Azimuth and altitude, degrees, or where the sun stands over the terrain's middle at a time.
using SunChoice = std::variant<glm::dvec2, geo::UniversalTime>;

struct SceneOptions {
    std::optional<scene::Technique> technique; ///< absent: polygons; in the gallery each model's
    bool mixed = false; ///< each model of the gallery has its own, despite the scene file
    /// Error bound of polygons, pixels; 0: none, every sample is drawn. Absent: the technique's, or
    /// default_max_error without a technique.
    std::optional<double> max_error;
    std::optional<DetailChoice> detail;               ///< absent: the scene file's, else none
    std::optional<scene::Technique> detail_technique; ///< absent: the scene file's, else relief
    bool wireframe = false;
    std::optional<io::SurfaceShaderDescription> surface_shader; ///< absent: the scene file's
    glm::ivec2 size{1024, 768}; ///< of the picture, pixels; the default camera fits its shape
    double vertical_fov = 57.3; ///< degrees
    scene::ProjectionKind projection = scene::ProjectionKind::perspective;
    std::optional<glm::dvec3> eye;    ///< scene metres; together with `target`
    std::optional<glm::dvec3> target; ///< scene metres
    std::optional<GeodeticView> geodetic;
    std::optional<scene::Pose> pose; ///< without any of these, the scene file's, else all is seen
    std::optional<SunChoice> sun;    ///< absent: the scene file's, else default_sun()
    std::optional<double> turbidity; ///< [1, 10]; absent: the scene file's, else clear air
    /// Metres; 0: no haze; absent: the scene file's, else by the size.
    std::optional<double> visibility;
    /// A picture of the sky (io::read_sky); absent: the scene file's, else the sun's own sky.
    std::optional<std::filesystem::path> sky;
    std::optional<double> sky_turn; ///< degrees clockwise; absent: the scene file's, else 0
    std::optional<BaseKind> base;   ///< absent: the scene file's, else default_base
    /// `solid`: a plane remains around islands, streams, the gallery, and more than 500 km.
    BaseKind default_base = BaseKind::plane;
    std::optional<bool> hides_sky;      ///< absent: the scene file's, else true
    std::optional<bool> contour_labels; ///< likewise
    std::optional<double> eye_dome;     ///< Scene::eye_dome(); absent: the scene file's, else 0
    /// TerrainNode::grain; absent: the scene file's, else default_grain, or none on one colour.
    std::optional<double> grain;
    double default_grain = 0.0;
    /// Of the pictures that `reljef render` writes; absent: the scene file's, else none.
    std::optional<io::MarksDescription> marks;
    std::optional<double> contours; ///< TerrainNode::contours; absent: the scene file's, else none
    std::vector<io::ObjectDescription> objects;          ///< besides the scene file's
    std::vector<io::FootprintsDescription> footprints;   ///< besides the scene file's
    std::vector<io::PointLightDescription> point_lights; ///< besides the scene file's
    std::vector<io::LightDescription> lights;            ///< besides the sun and the scene file's
    bool mesh_levels = true;   ///< of objects; they pay off over several frames
    bool prepares_maps = true; ///< open_scene() makes the technique's maps (prepared_maps.h)
    /// Without a named technique, rays draw a terrain in memory on a plane as `exact`; with
    /// RayUse::only, georeferenced terrain is on a plane, too.
    RayUse rays = RayUse::none;
};

/// Whether the start is a map: parallel rays from straight above.
bool is_map(const SceneOptions& options);

/// Azimuth and altitude, degrees: (300, 40); on maps (315, 35), the upper left that shaded maps
/// have.
glm::dvec2 default_sun(const SceneOptions& options);

/// The technique with its error bound. Precondition: check().
scene::Technique technique_of(const SceneOptions& options);

/// Whether the user names an error bound, by a technique or as such.
bool names_error_bound(const SceneOptions& options);

/// Usage errors: an error bound or a detail texture with a technique that has none, and a camera at
/// its target.
Result<void> check(const SceneOptions& options);

/// Streams the source only if the options allow it. A terrain that fits in memory is not streamed
/// with an error bound: in memory, its errors are proven without an index.
SourceOptions streamed_for(SourceOptions source, const SceneOptions& options);

} // namespace reljef::session
