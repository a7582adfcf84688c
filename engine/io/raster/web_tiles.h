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

// Web tiles of heights encoded as colours: z/x/y.png with 256×256 pixels in web mercator
// (EPSG:3857). Level z has 2^z tiles per side; x counts from the antimeridian, y from the north.
// The name is the encoding and the location: "terrarium+FOLDER" or
// "terrain-rgb+https://host/{z}/{x}/{y}.png".

enum class HeightEncoding { none, terrarium, terrain_rgb };

/// Metres; NaN for black (no data). Precondition: not HeightEncoding::none.
/// Terrarium: Tilezen, "joerd", docs/formats.md. Terrain-RGB: Mapbox, "Access elevation data".
double encoded_height(HeightEncoding encoding, double red, double green, double blue);

/// False for a grey picture: many neighbouring grey pixels of several shades. Channels: 0 to 255.
bool may_be_heights(std::span<const double> red, std::span<const double> green,
                    std::span<const double> blue);

inline constexpr int web_tiles_side = 256; // pixels

/// The error of one unreadable tile (x, y).
FileError web_tiles_error(const std::filesystem::path& path, glm::ivec2 tile, int level);

/// The encoding in a name; none: not web tiles.
HeightEncoding height_encoding_of(std::string_view name);
inline bool is_web_tiles(const std::filesystem::path& path) {
    return height_encoding_of(path.string()) != HeightEncoding::none;
}

/// Where the tiles are.
struct WebTileSource {
    std::string pattern; ///< a path or an address with {z}, {x} and {y}
    int level = 0;       ///< the finest: that of `{z:12}`, else 15, or the highest one in a folder
    bool on_server = false;

    [[nodiscard]] std::string name(glm::ivec2 tile, int at_level) const;
};

/// Fails for a folder without tiles or an address without {z}, {x} and {y}.
Result<WebTileSource> web_tile_source(const std::filesystem::path& path);

/// The area of a folder's finest level, between the outermost pixel centres; absent for addresses.
std::optional<geo::GeodeticArea> web_tiles_area(const std::filesystem::path& path);

} // namespace reljef::io
