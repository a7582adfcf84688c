#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/geo/georeference.h"

namespace reljef::io {

/// A file that could not be read, and why: one sentence that names it.
struct FileError {
    std::filesystem::path file;
    std::string message;
    friend bool operator==(const FileError&, const FileError&) = default;
};

// Heights as pictures: square tiles z/x/y.png of 256 pixels in web mercator (EPSG:3857), a level z
// of 2^z tiles a side, x from the antimeridian on east, y from the north. Named by how colours
// stand for heights, and where they are: "terrarium+FOLDER" or
// "terrain-rgb+https://host/{z}/{x}/{y}.png".

enum class HeightEncoding { none, terrarium, terrain_rgb };

/// Metres; NaN for black, which stands for nothing. Precondition: an encoding.
/// Terrarium: Tilezen, "joerd", docs/formats.md. Terrain-RGB: Mapbox, "Access elevation data".
double encoded_height(HeightEncoding encoding, double red, double green, double blue);

/// Whether colours can be heights: not where they are grey, along many pixels of several shades.
/// Channels 0 to 255, of the same size.
bool may_be_heights(std::span<const double> red, std::span<const double> green,
                    std::span<const double> blue);

/// Pixels along a tile.
inline constexpr int web_tiles_side = 256;

/// Of one tile (x, y) of a level that cannot be read.
FileError web_tiles_error(const std::filesystem::path& path, glm::ivec2 tile, int level);

/// By how the name begins; none: it names no such tiles.
HeightEncoding height_encoding_of(std::string_view name);
inline bool is_web_tiles(const std::filesystem::path& path) {
    return height_encoding_of(path.string()) != HeightEncoding::none;
}

/// What GDAL's driver for tiles on servers (WMS, service TMS) opens: a raster of all the Earth with
/// each level as an overview. Levels go to that of `{z:12}`, else 15; in a folder to the highest
/// that is there. Black where there is no tile. Fails where a folder has no tiles, or an address
/// lacks {z}, {x} or {y}. Precondition: is_web_tiles.
Result<std::string> web_tiles_description(const std::filesystem::path& path);

/// Where a folder has tiles of its finest level, from their outermost pixels' middles on; nothing
/// for addresses.
std::optional<geo::GeodeticArea> web_tiles_area(const std::filesystem::path& path);

} // namespace reljef::io
