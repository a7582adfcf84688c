#include "engine/io/raster/web_tiles.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <fmt/format.h>

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view terrarium_name = "terrarium+";
constexpr std::string_view terrain_rgb_name = "terrain-rgb+";
constexpr int usual_levels = 15; // public tile sets
constexpr int max_levels = 22;   // 2^30 samples per side

std::string address_of(const fs::path& path) {
    const std::string name = path.string();
    return name.substr(name.find('+') + 1);
}

bool is_address(const std::string& address) {
    return address.find("://") != std::string::npos;
}

std::optional<int> whole_number(const std::string& text) {
    int number = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool whole = code == std::errc{} && end == text.data() + text.size() && number >= 0;
    return whole ? std::optional<int>(number) : std::nullopt;
}

struct TileNumbers {
    int low = std::numeric_limits<int>::max();
    int high = -1;

    void add(int number) {
        low = std::min(low, number);
        high = std::max(high, number);
    }
};

/// A folder entry whose stem is a number.
struct NumberedEntry {
    int number = 0;
    fs::path path;
};

/// Entries with numbers below `end`, unordered.
std::vector<NumberedEntry> numbered_entries(const fs::path& folder, int end) {
    std::vector<NumberedEntry> entries;
    std::error_code code;
    for (fs::directory_iterator entry(folder, code); !code && entry != fs::directory_iterator();
         entry.increment(code)) {
        const auto number = whole_number(entry->path().stem().string());
        if (number && *number < end) {
            entries.push_back({*number, entry->path()});
        }
    }
    return entries;
}

TileNumbers numbers_in(const fs::path& folder, int end) {
    TileNumbers range;
    for (const NumberedEntry& entry : numbered_entries(folder, end)) {
        range.add(entry.number);
    }
    return range;
}

struct FolderLevel {
    int level = -1; ///< −1: none
    TileNumbers x;
    TileNumbers y;
};

FolderLevel finest_level(const fs::path& folder) {
    FolderLevel found;
    const int level = numbers_in(folder, max_levels + 1).high;
    const int count = level < 0 ? 0 : 1 << level; // tiles per side
    for (const NumberedEntry& column : numbered_entries(folder / std::to_string(level), count)) {
        const TileNumbers rows = numbers_in(column.path, count);
        if (rows.high >= 0) {
            found.level = level;
            found.x.add(column.number);
            found.y.add(rows.low);
            found.y.add(rows.high);
        }
    }
    return found;
}

/// Replaces the last `part` of a text.
void replace_last(std::string& text, std::string_view part, int number) {
    const auto at = text.rfind(part);
    if (at != std::string::npos) {
        text.replace(at, part.size(), std::to_string(number));
    }
}

Result<WebTileSource> source_of_address(const std::string& address) {
    WebTileSource source{address, usual_levels, true};
    std::string& text = source.pattern;
    const auto at = text.find("{z:");
    if (at != std::string::npos) {
        const auto end = text.find('}', at);
        const auto level = whole_number(text.substr(at + 3, end - at - 3));
        source.level = level && *level <= max_levels ? *level : -1;
        text.erase(at + 2, end - at - 2);
    }
    const auto lacks = [&](const char* part) { return text.find(part) == std::string::npos; };
    if (source.level < 0 || lacks("{z}") || lacks("{x}") || lacks("{y}")) {
        return Error{fmt::format("{}: found as the address of tiles, one with {{z}} (or {{z:15}}, "
                                 "at most {{z:{}}}), {{x}} and {{y}} was expected",
                                 address, max_levels)};
    }
    return source;
}

/// Latitude in degrees at `y` of `count` tiles from the north.
double latitude_at(double y, double count) {
    return std::atan(std::sinh(std::numbers::pi * (1.0 - 2.0 * y / count))) * 180.0 /
           std::numbers::pi;
}

} // namespace

std::string WebTileSource::name(glm::ivec2 tile, int at_level) const {
    std::string name = pattern;
    replace_last(name, "{y}", tile.y);
    replace_last(name, "{x}", tile.x);
    replace_last(name, "{z}", at_level);
    return name;
}

Result<WebTileSource> web_tile_source(const fs::path& path) {
    const std::string address = address_of(path);
    if (is_address(address)) {
        return source_of_address(address);
    }
    std::error_code ignored;
    if (!fs::is_directory(address, ignored)) {
        return Error{
            fmt::format("{}: is no folder, one of tiles as z/x/y.png was expected", address)};
    }
    const FolderLevel finest = finest_level(address);
    if (finest.level < 0) {
        return Error{
            fmt::format("{}: holds no tiles, a folder of them as z/x/y.png was expected", address)};
    }
    return WebTileSource{fs::absolute(address).string() + "/{z}/{x}/{y}.png", finest.level, false};
}

double encoded_height(HeightEncoding encoding, double red, double green, double blue) {
    if (red == 0.0 && green == 0.0 && blue == 0.0) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    return encoding == HeightEncoding::terrarium
               ? red * 256.0 + green + blue / 256.0 - 32768.0
               : (red * 65536.0 + green * 256.0 + blue) / 10.0 - 10000.0;
}

bool may_be_heights(std::span<const double> red, std::span<const double> green,
                    std::span<const double> blue) {
    // Only level ground has that many grey heights in a row.
    constexpr int max_grey = 32;
    constexpr int max_steps = 2;
    int grey = 0;
    int steps = 0;
    for (std::size_t i = 0; i < red.size(); ++i) {
        const bool is_grey = red[i] == green[i] && red[i] == blue[i] && red[i] > 0.0;
        steps = is_grey && grey > 0 ? steps + (red[i] == red[i - 1] ? 0 : 1) : 0;
        grey = is_grey ? grey + 1 : 0;
        if (grey > max_grey && steps > max_steps) {
            return false;
        }
    }
    return true;
}

FileError web_tiles_error(const fs::path& path, glm::ivec2 tile, int level) {
    const std::string name = fmt::format("{}/{}/{}", level, tile.x, tile.y);
    return {path / name, fmt::format("{}: its tile {} cannot be read, a whole picture of heights "
                                     "in red, green and blue was expected",
                                     path.string(), name)};
}

HeightEncoding height_encoding_of(std::string_view name) {
    return name.starts_with(terrarium_name)     ? HeightEncoding::terrarium
           : name.starts_with(terrain_rgb_name) ? HeightEncoding::terrain_rgb
                                                : HeightEncoding::none;
}

std::optional<geo::GeodeticArea> web_tiles_area(const fs::path& path) {
    const std::string address = address_of(path);
    if (is_address(address)) {
        return std::nullopt;
    }
    const FolderLevel finest = finest_level(address);
    if (finest.level < 0) {
        return std::nullopt;
    }
    const double count = std::ldexp(1.0, finest.level);
    constexpr double half_pixel = 0.5 / 256.0; // of a tile
    return geo::GeodeticArea{latitude_at(finest.y.high + 1 - half_pixel, count),
                             360.0 * (finest.x.low + half_pixel) / count - 180.0,
                             latitude_at(finest.y.low + half_pixel, count),
                             360.0 * (finest.x.high + 1 - half_pixel) / count - 180.0};
}

} // namespace reljef::io
