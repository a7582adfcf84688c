#include <limits>

#include <fmt/format.h>

#include "engine/core/atomic_file.h"
#include "engine/core/geometry.h"
#include "engine/io/checks/lowercase.h"
#include "engine/io/formats/flight_file.h"
#include "engine/io/formats/toml_reader.h"

namespace reljef::io {
namespace {

constexpr std::size_t max_keys = 100'000;
constexpr NumberRange any_time{-std::numeric_limits<double>::max(),
                               std::numeric_limits<double>::max(), false};

Result<PathKey> key_of(TomlTable& table) {
    std::optional<double> time;
    std::optional<glm::dvec3> eye;
    std::optional<glm::dvec3> look;
    table.read("time", time, any_time);
    table.read("eye", eye);
    table.read("look", look);
    table.require({"time", "eye", "look"});
    if (eye && look && *eye == *look) {
        table.fail("look", "is where eye is, another point was expected");
    }
    if (auto good = table.finish(); !good) {
        return good.error();
    }
    return PathKey{*time, *eye, *look};
}

constexpr NumberRange any_latitude{-90.0, 90.0, false};
constexpr NumberRange any_longitude{-720.0, 720.0, false};
constexpr NumberRange any_height{-max_world_coordinate, max_world_coordinate, false};
constexpr NumberRange any_heading{-720.0, 720.0, false};
constexpr NumberRange any_pitch{-90.0, 90.0, false};

Result<GeodeticKey> geodetic_key_of(TomlTable& table) {
    GeodeticKey key;
    table.read("time", key.time, any_time);
    table.read("latitude", key.latitude, any_latitude);
    table.read("longitude", key.longitude, any_longitude);
    table.read("height", key.height, any_height);
    table.read("heading", key.heading, any_heading);
    table.read("pitch", key.pitch, any_pitch);
    table.require({"time", "latitude", "longitude", "height"});
    if (key.pitch && !key.heading) {
        table.fail("pitch", "stands without heading, both or neither were expected");
    }
    if (auto good = table.finish(); !good) {
        return good.error();
    }
    return key;
}

/// A flight along all keys; times must increase.
template <class Key, class KeyOf>
Result<Flight> flight_along(std::vector<TomlTable>& tables, const std::string& name,
                            const KeyOf& key_from) {
    if (tables.empty() || tables.size() > max_keys) {
        return Error{fmt::format("{}: has {} tables [[key]], 1 to {} were expected", name,
                                 tables.size(), max_keys)};
    }
    std::vector<Key> keys;
    for (TomlTable& table : tables) {
        auto key = key_from(table);
        if (key && !keys.empty() && key->time <= keys.back().time) {
            table.fail("time", fmt::format("is {}, a time after the last one's {} was expected",
                                           key->time, keys.back().time));
            return table.finish().error();
        }
        if (!key) {
            return key.error();
        }
        keys.push_back(*key);
    }
    return Flight{std::move(keys), {}};
}

} // namespace

Result<Flight> read_flight(const std::filesystem::path& path, double metres_a_second) {
    if (extension_of(path) != ".toml") {
        return read_track(path, metres_a_second);
    }
    const std::string name = path.string();
    const auto text = read_text_file(path);
    if (!text) {
        return text.error();
    }
    const auto document = parse_toml(*text, name);
    if (!document) {
        return document.error();
    }
    TomlTable root(*document, name, "");
    std::vector<TomlTable> tables = root.tables("key");
    if (auto good = root.finish(); !good) {
        return good.error();
    }
    const bool on_earth =
        !tables.empty() && (tables.front().has("latitude") || tables.front().has("longitude"));
    return on_earth ? flight_along<GeodeticKey>(tables, name, geodetic_key_of)
                    : flight_along<PathKey>(tables, name, key_of);
}

} // namespace reljef::io
