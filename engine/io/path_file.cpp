#include <limits>

#include <fmt/format.h>

#include "engine/core/atomic_file.h"
#include "engine/io/scene_file.h"
#include "engine/io/toml_reader.h"

namespace reljef::io {
namespace {

constexpr std::size_t most_keys = 100'000;
constexpr NumberRange any_time{-std::numeric_limits<double>::max(),
                               std::numeric_limits<double>::max(), false};

Result<PathKey> key_of(TomlTable& table) {
    std::optional<double> time;
    std::optional<glm::dvec3> eye;
    std::optional<glm::dvec3> look;
    table.read("time", time, any_time);
    table.read("eye", eye);
    table.read("look", look);
    for (const char* key : {"time", "eye", "look"}) {
        if (!table.has(key)) {
            table.fail(key, "is missing, time, eye and look were expected");
        }
    }
    if (eye && look && *eye == *look) {
        table.fail("look", "is where eye is, another point was expected");
    }
    if (auto good = table.finish(); !good) {
        return good.error();
    }
    return PathKey{*time, *eye, *look};
}

} // namespace

Result<std::vector<PathKey>> read_path_file(const std::filesystem::path& path) {
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
    if (tables.empty() || tables.size() > most_keys) {
        return Error{fmt::format("{}: has {} tables [[key]], 1 to {} were expected", name,
                                 tables.size(), most_keys)};
    }
    std::vector<PathKey> keys;
    for (TomlTable& table : tables) {
        auto key = key_of(table);
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
    return keys;
}

} // namespace reljef::io
