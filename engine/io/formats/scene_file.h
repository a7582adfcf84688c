#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/building/city_form.h"
#include "engine/building/roof.h"
#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/geo/sun_position.h"
#include "engine/io/tile_set.h"

namespace reljef::io {

/// [detail]: a detail texture.
struct DetailDescription {
    std::string textures;             ///< a built-in set or a folder relative to the scene file
    std::filesystem::path folder;     ///< path of that folder; it may not exist
    double width = 4.0;               ///< tile width, metres
    std::optional<double> scale;      ///< maximum height in tile widths; absent: the set's own
    std::string technique = "relief"; ///< as --detail-technique
};

/// [[object]]: a mesh that stands on the terrain.
struct ObjectDescription {
    std::filesystem::path file; ///< OBJ or glTF (engine/io/mesh); relative to the scene file
    /// Latitude and longitude, degrees, on georeferenced terrain; on other terrain x and y, scene
    /// metres. Absent: among the models of the gallery.
    std::optional<glm::dvec2> at;
    double height = 0.0;  ///< of its lowest point above the ground, metres
    double heading = 0.0; ///< degrees clockwise, [-360, 360]; 0: the mesh's y points north
    double scale = 1.0;   ///< metres per metre of the file
};
inline constexpr double max_object_height = 1e5; ///< metres, also below the ground
inline constexpr double min_object_scale = 1e-6;
inline constexpr double max_object_scale = 1e4;
inline constexpr std::size_t max_objects = 10'000;

/// [[point_light]]: a lamp above the ground (scene::PointLight).
struct PointLightDescription {
    std::optional<glm::dvec2> at; ///< as ObjectDescription::at; set by every reader
    double height = 5.0;          ///< above the ground, metres
    double intensity = 25.0;      ///< scene::PointLight::intensity, over 0
    std::optional<double> range;  ///< metres, over 0; absent: see range_of()
    Rgba8 color{255, 255, 255, 255};
};
inline constexpr double max_intensity = 1e12;
inline constexpr double max_range = 1e6; ///< metres
inline constexpr std::size_t max_point_lights = 1000;

/// [surface_shader]: a shader of the user's (scene::SurfaceShader).
struct SurfaceShaderDescription {
    std::filesystem::path file;                           ///< GLSL; relative to the scene file
    std::map<std::string, std::vector<double>> constants; ///< one to four numbers each
};
inline constexpr double max_shader_constant = 1e30;

/// [[light]]: a light besides the sun whose rays are parallel.
struct LightDescription {
    double azimuth = 0.0;   ///< degrees clockwise from north, [-360, 360]; as the sun's
    double altitude = 45.0; ///< degrees above the horizon, [0, 90]
    double intensity = 0.5; ///< linear radiance of a white surface that faces the light, over 0
    Rgba8 color{255, 255, 255, 255};
};
inline constexpr double max_light_intensity = 1e3;
inline constexpr std::size_t max_lights = 16;

/// "#rrggbb", opaque; empty if it is none.
std::optional<Rgba8> color_from_hex(std::string_view text);
/// In small letters, without the alpha.
std::string to_hex(Rgba8 color);

/// Metres; by default to where the light would be 1 % of white.
double range_of(const PointLightDescription& light);

/// [picture] marks: what explains a picture, drawn over it.
struct MarksDescription {
    bool legend = false; ///< of the colours by height
    bool scale = false;  ///< a bar of a round length
    bool north = false;  ///< an arrow

    friend bool operator==(const MarksDescription&, const MarksDescription&) = default;
};
/// "legend,scale,north" or some of these, or "none"; empty: it is neither.
std::optional<MarksDescription> marks_from_text(std::string_view text);
inline constexpr const char* expected_marks =
    "some of legend, scale, north as legend,scale, or none";

/// [[footprints]]: buildings on outlines. Either `height` or `surface` is given.
struct FootprintsDescription {
    std::filesystem::path file; ///< vector file (engine/io/footprints); relative to the scene file
    std::string height;         ///< attribute: metres above the lowest ground at the outline
    /// Surface model, as TERRAIN: roofs are as high as its median within the outline.
    std::filesystem::path surface;
    building::RoofKind roof = building::RoofKind::flat;
};
inline constexpr std::size_t max_footprint_files = 100;

/// Content of a scene file (TOML). Only the source of the heights is required.
/// docs/scene_files.md lists the keys; each is in a file of the folder terrains.
struct SceneDescription {
    std::string name;

    // [terrain]: either `heights` or `generator`
    std::filesystem::path heights; ///< as TERRAIN on the command line; relative to the scene file
    std::string generator;         ///< "natural", "urban" or "gallery"
    int size = 1025;               ///< generator only, samples per side, 16 to 4096
    std::uint32_t seed = 1;        ///< generator only
    bool tileable = false;         ///< generator only
    building::CityForm buildings = building::CityForm::heights; ///< generator "urban" only
    building::CityWalls walls = building::CityWalls::straight;  ///< generator "urban" only
    std::optional<double> spacing; ///< metres; see RasterOptions::spacing
    double height_scale = 1.0;     ///< file only: metres = value · height_scale + height_offset
    double height_offset = 0.0;    ///< file only
    std::vector<std::filesystem::path> imagery; ///< file only; relative to the scene file
    std::string gaps = "holes";                 ///< folder only: "holes" or "sea" outside the tiles
    double exaggeration = 1.0;                  ///< (0, 1000]
    std::optional<std::string> placement;       ///< "plane" or "ellipsoid"; absent: by the data
    std::optional<double> grain; ///< fine structure of near ground, [0, 2]; absent: the program's
    double contours = 0.0;       ///< metres of height from one line to the next; 0: none
    bool contour_labels = true;
    /// Colours by height: a built-in ramp, or a colour file relative to the scene file.
    std::string ramp;
    double imagery_share = 1.0; ///< of the colours, [0, 1]; the rest are the ramp's

    // [area]: part of a folder to use
    std::optional<geo::GeodeticArea> area;

    // [gallery]: that generator only
    std::string gallery_textures = "mixed";  ///< as DetailDescription::textures, or "mixed"
    std::filesystem::path gallery_folder;    ///< as DetailDescription::folder
    std::string gallery_technique = "mixed"; ///< as --technique, or "mixed"

    std::optional<DetailDescription> detail;
    std::vector<ObjectDescription> objects;
    std::vector<FootprintsDescription> footprints;
    std::vector<PointLightDescription> point_lights;
    std::vector<LightDescription> lights;
    std::optional<SurfaceShaderDescription> surface_shader;

    // [sun]: degrees, or a time; absent: the program's
    std::optional<geo::UniversalTime> sun_time; ///< instead of azimuth and altitude
    std::optional<double> sun_azimuth;          ///< of the light, clockwise from north, [-360, 360]
    std::optional<double> sun_altitude;         ///< above the horizon, [-90, 90]

    // [air]: metres to 2 % contrast; absent: by the scene's size
    std::optional<double> visibility; ///< 0: no haze
    std::optional<double> turbidity;  ///< [1, 10]; absent: clear air
    std::filesystem::path sky;        ///< a picture of the sky (read_sky); empty: the sun's own sky
    double sky_turn = 0.0;            ///< its middle, degrees clockwise from north, [-360, 360]
    std::string base; ///< below the terrain's edge: "plane", "solid" or "none"; empty: plane
    double eye_dome =
        0.0; ///< how much pixels behind their surroundings lose of their light, [0, 1]
    bool hides_sky = true; ///< whether terrain keeps the sky's light from itself

    // [picture]
    std::optional<int> samples; ///< per pixel: 1, 2, 4, 8 or 16; absent: the program's
    MarksDescription marks;     ///< of pictures from `reljef render`

    // [camera]: scene metres; absent: all of the terrain is seen
    std::optional<glm::dvec3> eye;
    std::optional<glm::dvec3> target;
};

/// Unknown keys are errors.
Result<SceneDescription> read_scene_file(const std::filesystem::path& path);

/// Files and folders that a scene names, after what they are, for messages. Some may be empty.
std::vector<std::pair<std::string, std::filesystem::path>>
named_files(const SceneDescription& scene);

/// Parses a text. `name` is the file in messages; paths are relative to `folder`.
Result<SceneDescription> parse_scene(std::string_view text, const std::string& name,
                                     const std::filesystem::path& folder);

} // namespace reljef::io
