#include "engine/io/formats/scene_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/core/atomic_file.h"
#include "engine/io/formats/toml_reader.h"
#include "engine/material/relief_material.h"
#include "engine/terrain/field/color_ramp.h"
#include "engine/terrain/field/placement.h"

namespace reljef::io {
namespace {

constexpr double unlimited = std::numeric_limits<double>::max();
constexpr NumberRange positive{0.0, unlimited, true};
constexpr NumberRange not_negative{0.0, unlimited, false};
constexpr NumberRange any_number{-unlimited, unlimited, false};
constexpr NumberRange height_scales{-1e6, 1e6, false};
constexpr NumberRange height_offsets{-1e6, 1e6, false};
constexpr NumberRange spacings{terrain::min_spacing, terrain::max_spacing, false};
constexpr NumberRange sizes{16.0, 4096.0, false};
constexpr NumberRange seeds{0.0, 4294967295.0, false};
constexpr NumberRange exaggerations{0.0, terrain::max_exaggeration, true};
constexpr NumberRange azimuths{-360.0, 360.0, false};
constexpr NumberRange altitudes{-90.0, 90.0, false};
constexpr NumberRange tile_widths{material::min_tile_width, material::max_tile_width, false};
constexpr NumberRange tile_scales{0.0, material::max_tile_scale, true};
constexpr std::array<std::string_view, 3> generators{"natural", "urban", "gallery"};
constexpr NumberRange turbidities{1.0, 10.0, false};
constexpr NumberRange shares{0.0, 1.0, false};
constexpr NumberRange grains{0.0, 2.0, false};
constexpr NumberRange contour_intervals{0.0, 1e6, false};
constexpr std::array<std::string_view, 3> bases{"plane", "solid", "none"};
constexpr NumberRange latitudes{-90.0, 90.0, false};
constexpr NumberRange longitudes{-360.0, 720.0, false};
constexpr NumberRange object_heights{-max_object_height, max_object_height, false};
constexpr NumberRange object_scales{min_object_scale, max_object_scale};
constexpr NumberRange intensities{0.0, max_intensity, true};
constexpr NumberRange light_altitudes{0.0, 90.0, false};
constexpr NumberRange light_intensities{0.0, max_light_intensity, true};
constexpr NumberRange ranges{0.0, max_range, true};
constexpr std::array<std::string_view, 2> roofs{"flat", "hipped"};
constexpr std::array<std::string_view, 2> kinds_of_gaps{"holes", "sea"};
constexpr std::array<std::string_view, 2> placements{"plane", "ellipsoid"};

/// Rejects keys that do not apply to the source of heights.
void fail_usage(TomlTable& table, std::initializer_list<std::string_view> keys,
                std::string_view owner) {
    for (const std::string_view key : keys) {
        if (table.has(key)) {
            table.fail(key,
                       fmt::format("is given, but it belongs to {} and was not expected", owner));
        }
    }
}

void check_source(TomlTable& table) {
    const bool file = table.has("heights");
    const bool generator = table.has("generator");
    if (file == generator) {
        table.fail("heights", fmt::format("and generator are {} given, exactly one was expected",
                                          file ? "both" : "neither"));
    } else if (file) {
        fail_usage(table, {"size", "seed", "tileable"}, "a generator");
    } else {
        fail_usage(table, {"imagery", "height_scale", "height_offset", "gaps"},
                   "a file of heights");
    }
}

// One of the names, by which an enumeration counts.
template <class Value, class Names>
void read_named(TomlTable& table, const char* key, const Names& names, Value& value) {
    std::string name;
    table.read(key, name, names);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) {
        value = static_cast<Value>(found - names.begin());
    }
}

void read_city(TomlTable& table, SceneDescription& scene) {
    read_named(table, "buildings", building::city_form_names, scene.buildings);
    read_named(table, "walls", building::city_wall_names, scene.walls);
    if (scene.generator != "urban") {
        fail_usage(table, {"buildings", "walls"}, "the generator urban");
    }
}

void read_terrain_keys(TomlTable& table, const std::filesystem::path& folder,
                       SceneDescription& scene) {
    table.read("heights", scene.heights, folder);
    table.read("generator", scene.generator, generators);
    table.read("size", scene.size, sizes);
    table.read("seed", scene.seed, seeds);
    table.read("tileable", scene.tileable);
    read_city(table, scene);
    table.read("spacing", scene.spacing, spacings);
    table.read("height_scale", scene.height_scale, height_scales);
    table.read("height_offset", scene.height_offset, height_offsets);
    table.read("imagery", scene.imagery, folder);
    table.read("gaps", scene.gaps, kinds_of_gaps);
    table.read("exaggeration", scene.exaggeration, exaggerations);
    table.read("grain", scene.grain, grains);
    table.read("contours", scene.contours, contour_intervals);
    table.read("contour_labels", scene.contour_labels);
    std::string placement;
    table.read("placement", placement, placements);
    if (!placement.empty()) {
        scene.placement = placement;
    }
    table.read("ramp", scene.ramp);
    table.read("imagery_share", scene.imagery_share, shares);
    if (!scene.ramp.empty() && !terrain::named_ramp(scene.ramp)) {
        scene.ramp = (folder / scene.ramp).string();
    }
    if (scene.height_scale == 0.0) {
        table.fail("height_scale", "is 0, another number was expected");
    }
    check_source(table);
}

void read_area_keys(TomlTable& table, SceneDescription& scene) {
    constexpr std::array keys{"south", "west", "north", "east"};
    if (std::none_of(keys.begin(), keys.end(), [&](const char* key) { return table.has(key); })) {
        return;
    }
    geo::GeodeticArea area;
    table.read("south", area.south, latitudes);
    table.read("west", area.west, longitudes);
    table.read("north", area.north, latitudes);
    table.read("east", area.east, longitudes);
    table.require({"south", "west", "north", "east"});
    if (!(area.south < area.north)) {
        table.fail("north", "is not above south, a latitude north of it was expected");
    }
    if (!(area.west < area.east && area.east - area.west <= 360.0)) {
        table.fail("east", "is not east of west, a longitude at most 360 beyond it was expected");
    }
    scene.area = area;
}

void read_camera_keys(TomlTable& table, SceneDescription& scene) {
    table.read("eye", scene.eye);
    table.read("look", scene.target);
    if (table.has("eye") != table.has("look")) {
        table.fail(table.has("eye") ? "eye" : "look",
                   "stands alone, both eye and look were expected");
    } else if (scene.eye && scene.target && *scene.eye == *scene.target) {
        table.fail("look", "is where eye is, another point was expected");
    }
}

// Reads the name of a built-in set or of a folder; returns the folder's path.
std::filesystem::path read_textures(TomlTable& table, const std::filesystem::path& folder,
                                    std::string& textures) {
    table.read("textures", textures);
    std::filesystem::path beside = folder / textures;
    std::error_code ignored;
    if (!textures.empty() && std::filesystem::is_directory(beside, ignored)) {
        textures = beside.string();
    }
    return beside;
}

void read_gallery_keys(TomlTable& table, const std::filesystem::path& folder,
                       SceneDescription& scene) {
    if (scene.generator != "gallery") {
        fail_usage(table, {"textures", "technique"}, "the generator gallery");
    }
    scene.gallery_folder = read_textures(table, folder, scene.gallery_textures);
    table.read("technique", scene.gallery_technique);
}

void read_detail_keys(TomlTable& table, const std::filesystem::path& folder,
                      SceneDescription& scene) {
    DetailDescription detail;
    detail.folder = read_textures(table, folder, detail.textures);
    table.read("width", detail.width, tile_widths);
    table.read("scale", detail.scale, tile_scales);
    table.read("technique", detail.technique);
    if (table.has("textures")) {
        scene.detail = std::move(detail);
    } else if (table.has("width") || table.has("scale") || table.has("technique")) {
        table.fail("textures", "is missing, the name of a tile or its folder was expected");
    }
}

void read_object_keys(TomlTable& table, const std::filesystem::path& folder,
                      SceneDescription& scene) {
    ObjectDescription object;
    table.require({"file", "at"});
    table.read("file", object.file, folder);
    table.read("at", object.at);
    table.read("height", object.height, object_heights);
    table.read("heading", object.heading, azimuths);
    table.read("scale", object.scale, object_scales);
    scene.objects.push_back(std::move(object));
}

void read_color(TomlTable& table, Rgba8& color) {
    std::string text;
    table.read("color", text);
    const auto parsed = color_from_hex(text);
    if (!text.empty() && !parsed) {
        table.fail("color",
                   fmt::format("is \"{}\", a color such as \"#ffcc88\" was expected", text));
    }
    color = parsed.value_or(color);
}

void read_light_keys(TomlTable& table, SceneDescription& scene) {
    LightDescription light;
    table.require({"azimuth", "altitude"});
    table.read("azimuth", light.azimuth, azimuths);
    table.read("altitude", light.altitude, light_altitudes);
    table.read("intensity", light.intensity, light_intensities);
    read_color(table, light.color);
    scene.lights.push_back(light);
}

Result<void> read_surface_shader(TomlTable& root, const std::filesystem::path& folder,
                                 SceneDescription& scene) {
    TomlTable table = root.table("surface_shader");
    if (auto good = root.finish(); !good) {
        return good; // it is no table
    }
    SurfaceShaderDescription shader;
    if (root.has("surface_shader") && !table.has("file")) {
        table.fail("file", "is missing, a shader file was expected");
    }
    table.read("file", shader.file, folder);
    TomlTable constants = table.table("constants");
    constexpr std::size_t max_numbers = 4;
    constants.read_all(shader.constants, max_numbers, max_shader_constant);
    if (!shader.file.empty()) {
        scene.surface_shader = std::move(shader);
    }
    const auto good = constants.finish();
    return good ? table.finish() : good;
}

void read_point_light_keys(TomlTable& table, SceneDescription& scene) {
    PointLightDescription light;
    if (!table.has("at")) {
        table.fail("at", "is missing, a latitude and a longitude or x and y were expected");
    }
    table.read("at", light.at);
    table.read("height", light.height, object_heights);
    table.read("intensity", light.intensity, intensities);
    table.read("range", light.range, ranges);
    read_color(table, light.color);
    scene.point_lights.push_back(light);
}

void read_footprint_keys(TomlTable& table, const std::filesystem::path& folder,
                         SceneDescription& scene) {
    FootprintsDescription footprints;
    std::string roof;
    table.require({"file"});
    table.read("file", footprints.file, folder);
    table.read("height", footprints.height);
    table.read("surface", footprints.surface, folder);
    table.read("roof", roof, roofs);
    footprints.roof = roof == "hipped" ? building::RoofKind::hipped : building::RoofKind::flat;
    if (footprints.height.empty() == footprints.surface.empty()) {
        table.fail("height", fmt::format("and surface are {} given, exactly one was expected",
                                         footprints.height.empty() ? "neither" : "both"));
    }
    scene.footprints.push_back(std::move(footprints));
}

void read_sun_keys(TomlTable& table, SceneDescription& scene) {
    table.read("azimuth", scene.sun_azimuth, azimuths);
    table.read("altitude", scene.sun_altitude, altitudes);
    table.read("occlusion", scene.hides_sky);
    table.read("eye_dome", scene.eye_dome, shares);
    std::string text;
    table.read("time", text);
    if (!table.has("time")) {
        return;
    }
    if (table.has("azimuth") || table.has("altitude")) {
        table.fail("time", "stands beside azimuth or altitude, one of both was expected");
    }
    const auto time = geo::universal_time(text);
    if (!time) {
        table.fail("time", "is " + time.error().message);
        return;
    }
    scene.sun_time = *time;
}

void read_picture_keys(TomlTable& table, SceneDescription& scene) {
    constexpr std::array counts{1, 2, 4, 8, 16};
    constexpr NumberRange range{1.0, 16.0, false};
    int samples = counts.front();
    table.read("samples", samples, range);
    if (std::find(counts.begin(), counts.end(), samples) == counts.end()) {
        table.fail("samples",
                   fmt::format("is {}, one of {} was expected", samples, fmt::join(counts, ", ")));
    } else if (table.has("samples")) {
        scene.samples = samples;
    }
    std::string words;
    table.read("marks", words);
    const auto marks = marks_from_text(words);
    if (table.has("marks") && !marks) {
        table.fail("marks", fmt::format("is \"{}\", {} was expected", words, expected_marks));
    }
    scene.marks = marks.value_or(MarksDescription());
}

// [[KEY]], each by `read`.
template <class Read>
Result<void> read_each(TomlTable& root, std::string_view key, std::size_t max, const Read& read) {
    std::vector<TomlTable> tables = root.tables(key);
    if (tables.size() > max) {
        root.fail(key,
                  fmt::format("is given {} times, at most {} were expected", tables.size(), max));
    }
    for (TomlTable& table : tables) {
        read(table);
        if (auto good = table.finish(); !good) {
            return good;
        }
    }
    return {};
}

Result<void> read_arrays(TomlTable& root, const std::filesystem::path& folder,
                         SceneDescription& scene) {
    auto good = read_each(root, "object", max_objects,
                          [&](TomlTable& table) { read_object_keys(table, folder, scene); });
    good = good ? read_each(root, "point_light", max_point_lights,
                            [&](TomlTable& table) { read_point_light_keys(table, scene); })
                : good;
    good = good ? read_each(root, "light", max_lights,
                            [&](TomlTable& table) { read_light_keys(table, scene); })
                : good;
    return good ? read_each(root, "footprints", max_footprint_files,
                            [&](TomlTable& table) { read_footprint_keys(table, folder, scene); })
                : good;
}

} // namespace

std::optional<MarksDescription> marks_from_text(std::string_view text) {
    MarksDescription marks;
    if (text == "none") {
        return marks;
    }
    while (true) {
        const std::string_view word = text.substr(0, text.find(','));
        if (word == "legend") {
            marks.legend = true;
        } else if (word == "scale") {
            marks.scale = true;
        } else if (word == "north") {
            marks.north = true;
        } else {
            return std::nullopt;
        }
        if (word.size() == text.size()) {
            return marks;
        }
        text.remove_prefix(word.size() + 1);
    }
}

std::optional<Rgba8> color_from_hex(std::string_view text) {
    std::uint32_t bits = 0;
    constexpr std::size_t digits = 6;
    const bool has_length = text.size() == digits + 1 && text.front() == '#';
    if (!has_length) {
        return std::nullopt;
    }
    const auto [end, code] = std::from_chars(text.data() + 1, text.data() + text.size(), bits, 16);
    if (code != std::errc{} || end != text.data() + text.size()) {
        return std::nullopt;
    }
    return Rgba8{static_cast<std::uint8_t>(bits >> 16U), static_cast<std::uint8_t>(bits >> 8U),
                 static_cast<std::uint8_t>(bits), 255};
}

std::string to_hex(Rgba8 color) {
    return fmt::format("#{:02x}{:02x}{:02x}", color.r, color.g, color.b);
}

double range_of(const PointLightDescription& light) {
    constexpr double faint = 0.01;
    return light.range.value_or(std::min(std::sqrt(light.intensity / faint), max_range));
}

Result<SceneDescription> parse_scene(std::string_view text, const std::string& name,
                                     const std::filesystem::path& folder) {
    const auto document = parse_toml(text, name);
    if (!document) {
        return document.error();
    }
    SceneDescription scene;
    TomlTable root(*document, name, "");
    root.read("name", scene.name);
    TomlTable terrain = root.table("terrain");
    TomlTable area = root.table("area");
    TomlTable gallery = root.table("gallery");
    TomlTable detail = root.table("detail");
    TomlTable sun = root.table("sun");
    TomlTable air = root.table("air");
    TomlTable picture = root.table("picture");
    TomlTable camera = root.table("camera");
    read_terrain_keys(terrain, folder, scene);
    read_area_keys(area, scene);
    read_gallery_keys(gallery, folder, scene);
    read_detail_keys(detail, folder, scene);
    read_sun_keys(sun, scene);
    air.read("visibility", scene.visibility, not_negative);
    air.read("turbidity", scene.turbidity, turbidities);
    air.read("base", scene.base, bases);
    air.read("sky", scene.sky, folder);
    air.read("sky_turn", scene.sky_turn, azimuths);
    if (air.has("sky_turn") && !air.has("sky")) {
        air.fail("sky_turn", "stands alone, sky was expected, too");
    }
    read_picture_keys(picture, scene);
    read_camera_keys(camera, scene);
    if (auto good = read_arrays(root, folder, scene); !good) {
        return good.error();
    }
    if (auto good = read_surface_shader(root, folder, scene); !good) {
        return good.error();
    }
    for (const TomlTable* table :
         {&root, &terrain, &area, &gallery, &detail, &sun, &air, &picture, &camera}) {
        if (auto good = table->finish(); !good) {
            return good.error();
        }
    }
    return scene;
}

Result<SceneDescription> read_scene_file(const std::filesystem::path& path) {
    const auto text = read_text_file(path);
    if (!text) {
        return text.error();
    }
    auto scene = parse_scene(*text, path.string(), path.parent_path());
    if (scene && scene->name.empty()) {
        scene->name = path.stem().string();
    }
    return scene;
}

std::vector<std::pair<std::string, std::filesystem::path>>
named_files(const SceneDescription& scene) {
    std::vector<std::pair<std::string, std::filesystem::path>> files{
        {"the terrain's heights", scene.heights},
        {"the gallery's textures", scene.gallery_textures},
        {"the detail texture", scene.detail.value_or(DetailDescription{}).textures},
        {"the terrain's ramp", scene.ramp},
        {"the sky", scene.sky},
        {"the surface shader", scene.surface_shader.value_or(SurfaceShaderDescription{}).file}};
    for (const std::filesystem::path& image : scene.imagery) {
        files.emplace_back("the terrain's imagery", image);
    }
    for (const ObjectDescription& object : scene.objects) {
        files.emplace_back("an object", object.file);
    }
    for (const FootprintsDescription& footprints : scene.footprints) {
        files.emplace_back("the footprints", footprints.file);
        files.emplace_back("the footprints' surface", footprints.surface);
    }
    return files;
}

} // namespace reljef::io
