#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/result.h"
#include "engine/io/tile_set.h"

namespace reljef::io {

/// A tile of surface detail that repeats over the terrain: [detail].
struct DetailDescription {
    std::string textures; ///< a built-in set, or a folder of pictures, relative to the scene file
    std::filesystem::path folder;     ///< where that folder is to be, whether it is there or not
    double width = 4.0;               ///< metres that a tile covers
    std::optional<double> scale;      ///< of its heights, in tile widths; absent: the set's own
    std::string technique = "relief"; ///< as --detail-technique has it
};

/// What a scene file (TOML) asks for; everything but where the heights come from has a default.
/// terrains/natural.toml, urban.toml and gallery.toml show every key.
struct SceneDescription {
    std::string name;

    // [terrain]: exactly one of `heights` (whatever TERRAIN may be on the command line) and
    // `generator`
    // ("natural", "urban", "gallery")
    std::filesystem::path heights; ///< relative to the scene file
    std::string generator;
    int size = 1025;        ///< generator only, samples a side, 16 to 4096
    std::uint32_t seed = 1; ///< generator only
    bool tileable = false;  ///< generator only
    /// Metres between samples; absent: the generator's or the file's own. Files that name a
    /// coordinate system have their own (RasterOptions::spacing).
    std::optional<double> spacing;
    double height_scale = 1.0;  ///< file only: metres = value · height_scale + height_offset
    double height_offset = 0.0; ///< file only
    std::vector<std::filesystem::path> imagery; ///< file only; relative to the scene file
    std::string gaps = "holes";           ///< folder only: "holes" or "sea" where it has no tile
    double exaggeration = 1.0;            ///< (0, 1000]
    std::optional<std::string> placement; ///< "plane" or "ellipsoid"; absent: by the data

    // [area]: south, west, north, east in degrees; a folder's part that is of use
    std::optional<geo::GeodeticArea> area;

    // [gallery]: its generator only
    /// A built-in set, "mixed", or a folder of pictures, relative to the scene file.
    std::string gallery_textures = "mixed";
    std::filesystem::path
        gallery_folder; ///< where that folder is to be, whether it is there or not
    std::string gallery_technique = "mixed"; ///< as --technique has it, or "mixed"

    std::optional<DetailDescription> detail; ///< absent: the terrain as it is

    // [sun]: degrees
    double sun_azimuth = 300.0; ///< [-360, 360], clockwise from north, where the light comes from
    double sun_altitude = 40.0; ///< above the horizon, (0, 90]

    // [air]
    std::optional<double>
        visibility; ///< metres at which 2 % of the contrast is left; absent: by the scene's size

    // [camera]: scene metres; absent: the overview pose
    std::optional<glm::dvec3> eye;
    std::optional<glm::dvec3> target;
};

/// Errors name the file, the key (with its line where TOML itself is broken), what was found and
/// what was expected; unknown keys are errors.
Result<SceneDescription> read_scene_file(const std::filesystem::path& path);

/// The same from text; `name` stands for the file in messages, `folder` is what paths start from.
Result<SceneDescription> parse_scene(std::string_view text, const std::string& name,
                                     const std::filesystem::path& folder);

/// One key of a fly path; scene metres, seconds.
struct PathKey {
    double time = 0.0;
    glm::dvec3 eye{0.0};
    glm::dvec3 target{0.0};
};

/// A path file (TOML): `[[key]]` tables with time, eye = [x,y,z], look = [x,y,z]; at least one key,
/// at most 100,000, all finite, each later than the one before.
Result<std::vector<PathKey>> read_path_file(const std::filesystem::path& path);

} // namespace reljef::io
