#include "app/cli/options.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "app/cli/appearance_options.h"
#include "app/cli/parsed_option.h"
#include "engine/building/city_form.h"
#include "engine/core/geometry.h"
#include "engine/view/error_view.h"

namespace reljef::cli {
namespace {

constexpr int max_picture_side = 1'000'000; // of a PNG, see io/image/picture_writer.h

auto point_of(const char* option) {
    return [=](const std::string& text) -> Result<glm::dvec3> {
        const auto numbers = parse_numbers<3>(option, text, "x,y,z in scene metres");
        if (!numbers) {
            return numbers.error();
        }
        const glm::dvec3 point((*numbers)[0], (*numbers)[1], (*numbers)[2]);
        if (glm::any(glm::greaterThan(glm::abs(point), glm::dvec3(max_world_coordinate)))) {
            return Error{
                fmt::format("{}: '{}' found, at most {} metres from the middle were expected",
                            option, text, max_world_coordinate)};
        }
        return point;
    };
}

Result<session::GeodeticView> parse_geodetic_view(const std::string& text) {
    constexpr const char* expected = "LAT,LON,HEIGHT,HEADING,PITCH in degrees and metres";
    const auto numbers = parse_numbers<5>("--camera", text, expected);
    if (!numbers) {
        return numbers.error();
    }
    const auto [latitude, longitude, height, heading, pitch] = *numbers;
    if (std::abs(latitude) > 90.0 || std::abs(pitch) > 90.0) {
        return Error{fmt::format("--camera: '{}' found, a latitude and a pitch from -90 to 90 were "
                                 "expected",
                                 text)};
    }
    if (std::abs(height) > max_world_coordinate) {
        return Error{fmt::format("--camera: height {} found, at most {} metres were expected",
                                 height, max_world_coordinate)};
    }
    return session::GeodeticView{latitude, longitude, height, heading, pitch};
}

Result<geo::GeodeticArea> parse_area(const std::string& text) {
    const auto numbers = parse_numbers<4>("--area", text, "SOUTH,WEST,NORTH,EAST in degrees");
    if (!numbers) {
        return numbers.error();
    }
    const auto [south, west, north, east] = *numbers;
    if (!(south >= -90.0 && south < north && north <= 90.0 && west < east && east - west <= 360.0 &&
          std::abs(west) <= 360.0)) {
        return Error{fmt::format("--area: '{}' found, SOUTH below NORTH in -90 to 90 and WEST "
                                 "below EAST, at most 360 apart, were expected",
                                 text)};
    }
    return geo::GeodeticArea{south, west, north, east};
}

Result<scene::Technique> parse_detail_technique(const std::string& text) {
    auto technique = scene::parse_technique(text);
    if (technique) {
        if (auto good = scene::check_terrain_detail_technique(*technique); !good) {
            return Error{"--detail-technique: " + good.error().message};
        }
    }
    return technique;
}

// Parses width=METRES or scale=S.
Result<void> set_detail_number(session::DetailChoice& choice, const std::string& assignment) {
    const auto equals = assignment.find('=');
    const std::string key = assignment.substr(0, equals);
    const std::string text =
        equals == std::string::npos ? std::string() : assignment.substr(equals + 1);
    if (key != "width" && key != "scale") {
        return Error{
            fmt::format("--detail: '{}' found, width=METRES or scale=S was expected", assignment)};
    }
    const bool is_width = key == "width";
    const auto value =
        is_width
            ? number_in("--detail: width", material::min_tile_width, material::max_tile_width)(text)
            : number_in("--detail: scale", 0.0, material::max_tile_scale, true)(text);
    if (!value) {
        return value.error();
    }
    auto& chosen = is_width ? choice.width : choice.scale;
    if (chosen) {
        return Error{fmt::format("--detail: {} found twice, once was expected", key)};
    }
    chosen = *value;
    return {};
}

// Parses NAME or NAME:width=METRES,scale=S with the name of a texture or a folder.
Result<session::DetailChoice> parse_detail(const std::string& text) {
    const auto colon = text.rfind(':');
    const bool has_numbers =
        colon != std::string::npos && text.find('=', colon) != std::string::npos;
    session::DetailChoice choice{has_numbers ? text.substr(0, colon) : text, {}, {}};
    if (choice.textures.empty() || choice.textures.back() == ':') {
        return Error{fmt::format("--detail: '{}' found, the name or folder of a detail texture, "
                                 "then :width=W,scale=S was expected",
                                 text)};
    }
    std::string rest = has_numbers ? text.substr(colon + 1) : std::string();
    while (!rest.empty()) {
        const auto comma = std::min(rest.find(','), rest.size());
        if (auto set = set_detail_number(choice, rest.substr(0, comma)); !set) {
            return set.error();
        }
        rest = rest.substr(std::min(comma + 1, rest.size()));
    }
    return choice;
}

// 0 for "none".
Result<std::optional<double>> parse_max_error(const std::string& text) {
    if (text == "none") {
        return std::optional(0.0);
    }
    const auto bound = number_from<double>(text);
    if (!bound || !(*bound >= view::min_error && *bound <= view::max_error)) {
        return Error{fmt::format("--max-error: '{}' found, a number from {} to {} or none was "
                                 "expected",
                                 text, view::min_error, view::max_error)};
    }
    return std::optional(*bound);
}

Result<std::optional<session::BackendKind>> parse_context(const std::string& text) {
    const auto kind = session::backend_from_string(text);
    if (!kind && text != "auto") {
        return Error{fmt::format(
            "--context: '{}' found, one of auto, glfw, egl, osmesa, cpu was expected", text)};
    }
    return kind;
}

CLI::Validator existing_folder() {
    return {[](const std::string& text) {
                std::error_code code;
                return std::filesystem::is_directory(text, code)
                           ? std::string()
                           : fmt::format("'{}' found, a folder was expected", text);
            },
            ""};
}

void add_backend_options(CLI::App& command, ViewChoice& choice) {
    add_parsed(
        command, "--context", choice.context, parse_context,
        "what draws: OpenGL with glfw (window), egl (GPU without a window) or osmesa (CPU); cpu: "
        "exact rays without OpenGL, for one terrain with objects; auto: a GPU if there is one, "
        "else "
        "cpu for what it draws, and osmesa (view: glfw) for all else (auto)",
        "KIND");
    command
        .add_option("--simd", choice.simd,
                    "cpu: instruction set of the rays: avx512, avx2, sse4, neon or scalar (the "
                    "fastest of the machine)")
        ->type_name("TARGET");
    command
        .add_option("--calibration", choice.calibration,
                    "auto: costs of triangles and rays by 'reljef calibrate' on this machine "
                    "(those of a software renderer)")
        ->type_name("FILE");
    command
        .add_option("--shader-dir", choice.shader_dir,
                    "use shader files of this folder instead of the built-in ones")
        ->type_name("FOLDER")
        ->check(existing_folder());
}

void add_picture_options(CLI::App& command, ViewChoice& choice) {
    add_backend_options(command, choice);
    add_parsed(
        command, "--size", choice.size,
        [](const std::string& text) { return parse_size(text, max_picture_side); },
        "size of the picture, pixels (1024x768); more than 16384 a side need one .png or .tif "
        "picture",
        "WxH");
    add_parsed(
        command, "--technique", choice.technique,
        [&choice](const std::string& text) -> Result<std::optional<scene::Technique>> {
            choice.mixed = text == "mixed";
            if (choice.mixed) {
                return std::optional<scene::Technique>();
            }
            const auto technique = scene::parse_technique(text);
            return technique ? Result<std::optional<scene::Technique>>(*technique)
                             : technique.error();
        },
        "how to draw the surface; 'reljef techniques' lists all (polygons; in the gallery, each "
        "model has its own)",
        "ID[:key=value,...]");
    add_parsed(
        command, "--max-error", choice.max_error, parse_max_error,
        "polygons: at most PX pixels of error (0.02 to 16), with as few triangles as possible; "
        "none draws every sample (1 if no technique is named)",
        "PX|none");
    add_parsed(
        command, "--detail", choice.detail, parse_detail,
        "polygons: repeat a detail texture over the terrain: brick, rock, cobble, fence, rings, "
        "copper or a folder of pictures; W is its width in metres (4), S its height in widths",
        "NAME|FOLDER[:width=W,scale=S]");
    add_parsed(command, "--detail-technique", choice.detail_technique, parse_detail_technique,
               "how to draw the detail texture near the camera (relief)", "ID[:key=value,...]");
    command.add_flag("--wireframe", choice.wireframe, "draw only the edges of triangles");
    add_parsed(command, "--projection", choice.projection,
               word_of<scene::ProjectionKind>(
                   "--projection", {{"perspective", scene::ProjectionKind::perspective},
                                    {"orthographic", scene::ProjectionKind::orthographic}}),
               "perspective or orthographic; orthographic without a camera draws a map "
               "(perspective)",
               "KIND");
}

void add_camera_options(CLI::App& command, ViewChoice& choice) {
    add_parsed(command, "--fov", choice.vertical_fov, number_in("--fov", 1e-3, 179.0),
               "vertical field of view, degrees (57.3)", "DEG");
    auto* eye = add_parsed(command, "--eye", choice.eye, point_of("--eye"),
                           "position of the camera, scene metres", "x,y,z");
    auto* look = add_parsed(command, "--look", choice.target, point_of("--look"),
                            "point that the camera looks at, scene metres", "x,y,z");
    look->needs(eye);
    eye->needs(look);
    auto* camera = add_parsed(command, "--camera", choice.geodetic, parse_geodetic_view,
                              "position and direction of the camera on Earth, degrees and metres",
                              "LAT,LON,HEIGHT,HEADING,PITCH");
    camera->excludes(eye);
    auto* pose = add_parsed(
        command, "--pose", choice.pose, parse_pose,
        "camera pose: overview, oblique, low, grazing, valley or map (by default, all of the "
        "terrain is seen)",
        "NAME");
    pose->excludes(eye)->excludes(camera);
    command
        .add_option(
            "--path", choice.path,
            "camera path: orbit, flyover, a path file (TOML: [[key]] time, eye, look; or time, "
            "latitude, longitude, height) or a GPX, KML or GeoJSON file, whose first track or "
            "line is flown")
        ->type_name("NAME|FILE")
        ->excludes(eye)
        ->excludes(camera);
    command.add_flag(
        "--allow-underground", choice.allow_underground,
        "do not lift cameras that are below the ground. By default they are lifted, with a note; "
        "if a scene or path file placed them, the exit status is 1. Orthographic cameras are "
        "never lifted");
    add_parsed(command, "--frames", choice.frames, number_in<int>("--frames", 1, 1'000'000),
               "number of pictures along the path (1)", "N");
    add_parsed(command, "--fps", choice.frames_per_second, number_in("--fps", 0.01, 1000.0),
               "frames per second of a video (25)", "F");
}

} // namespace

Result<scene::Pose> parse_pose(std::string_view text) {
    const auto pose = scene::pose_from_string(text);
    if (!pose) {
        return Error{fmt::format(
            "--pose: '{}' found, one of overview, oblique, low, grazing, valley, map was expected",
            text)};
    }
    return *pose;
}

Result<glm::ivec2> parse_size(std::string_view text, int max_side) {
    const auto cross = text.find('x');
    const auto width = number_from<int>(text.substr(0, cross));
    const auto height =
        cross == std::string_view::npos ? std::nullopt : number_from<int>(text.substr(cross + 1));
    const auto fits = [&](std::optional<int> side) {
        return side && *side >= 1 && *side <= max_side;
    };
    if (!fits(width) || !fits(height)) {
        return Error{fmt::format("--size: '{}' found, WxH with each from 1 to {} was expected",
                                 text, max_side)};
    }
    return glm::ivec2(*width, *height);
}

void add_source_options(CLI::App& command, TerrainChoice& choice) {
    command
        .add_option(
            "TERRAIN", choice.terrain,
            "natural, urban, gallery, a scene file (.toml), a DEM file, a "
            "folder of DEM files, an https:// address, or web tiles with heights in colours: "
            "terrarium+FOLDER, terrain-rgb+https://host/{z}/{x}/{y}.png; - for a DEM file from "
            "standard input")
        ->required();
    add_parsed(command, "--area", choice.area, parse_area,
               "use only this part of a folder of files, degrees", "SOUTH,WEST,NORTH,EAST");
    add_parsed(
        command, "--memory", choice.memory_megabytes, number_in<int>("--memory", 1, 1'000'000),
        "memory for the terrain, megabytes; larger terrains are read tile by tile (512)", "MB");
    add_parsed(command, "--threads", choice.threads, number_in<int>("--threads", 0, 1024),
               "number of threads; 0: one per processor (0)", "N");
    command.add_flag("--allow-external", choice.allow_external,
                     "read files in any format of GDAL, and follow what they refer to. By default, "
                     "a file is in a common format of elevation or pictures, and a virtual raster "
                     "(VRT) refers only to files in or below its folder. /vsis3, /vsigs and /vsiaz "
                     "need this option, too: GDAL reads them without deadlines");
    command.add_flag("--quiet", choice.quiet, "print no progress and no notes");
}

void add_index_option(CLI::App& command, TerrainChoice& choice, session::IndexUse use) {
    choice.index = use;
    command.parse_complete_callback([&choice] {
        if (choice.terrain == "-") { // read from a temporary copy
            choice.index = session::IndexUse::none;
        }
    });
    command.add_flag_callback(
        "--no-index", [&choice] { choice.index = session::IndexUse::none; },
        "neither make nor use the index of a terrain that does not fit --memory. By default, the "
        "tiles that 'reljef index' proved are drawn with proven errors. render makes the index "
        "first if an error bound is named, by --max-error or the technique; view makes it in the "
        "background. Standard input has none");
}

void add_gaps_option(CLI::App& command, TerrainChoice& choice) {
    add_parsed(command, "--gaps", choice.gaps,
               word_of<io::Gaps>("--gaps", {{"holes", io::Gaps::holes}, {"sea", io::Gaps::sea}}),
               "areas between the files of a folder: holes, or sea at 0 m (holes)", "KIND");
}

void add_terrain_options(CLI::App& command, TerrainChoice& choice) {
    add_source_options(command, choice);
    command
        .add_option("--imagery", choice.imagery,
                    "picture or folder of pictures to drape over the terrain; may be repeated. "
                    "Pictures with more than 4096 pixels along a side of the terrain are read "
                    "tile by tile, unless --max-error is given")
        ->allow_extra_args(false)
        ->type_name("FILE");
    command
        .add_option("--textures", choice.textures,
                    "gallery only: brick, rock, cobble, fence, rings, copper, mixed, or a folder "
                    "of pictures (colour, height, normal)")
        ->type_name("NAME|FOLDER");
    using building::CityForm;
    add_parsed(command, "--buildings", choice.buildings,
               word_of<CityForm>("--buildings", {{"heights", CityForm::heights},
                                                 {"meshes", CityForm::meshes},
                                                 {"meshes-only", CityForm::meshes_only}}),
               "urban only: its buildings are heights of the terrain (default), meshes on the bare "
               "ground, or meshes alone on a level plane",
               "FORM");
    using building::CityWalls;
    add_parsed(
        command, "--walls", choice.walls,
        word_of<CityWalls>("--walls",
                           {{"straight", CityWalls::straight}, {"stepped", CityWalls::stepped}}),
        "urban only, as heights: straight walls with windows (default), or walls that follow "
        "the rows and columns of samples, without windows",
        "KIND");
    command
        .add_option(
            "--ramp", choice.ramp,
            "colours by height: relief, natural, swiss, desert, clay, stretched, atlas, or a "
            "colour file of gdaldem color-relief (relief; on maps atlas)")
        ->type_name("NAME|FILE");
    add_parsed(command, "--imagery-share", choice.imagery_share,
               number_in("--imagery-share", 0.0, 1.0),
               "share of imagery in the colours; the rest are those by height (1)", "S");
    add_parsed(command, "--exaggeration", choice.exaggeration,
               number_in("--exaggeration", 0.0, terrain::max_exaggeration, true),
               "factor for the heights, in the picture only (1)", "X");
    add_parsed(
        command, "--placement", choice.placement,
        word_of<terrain::PlacementKind>("--placement",
                                        {{"plane", terrain::PlacementKind::plane},
                                         {"ellipsoid", terrain::PlacementKind::ellipsoid}}),
        "plane, or ellipsoid: on the curved Earth (ellipsoid for georeferenced terrains; plane "
        "for techniques that search, if it distorts the terrain by at most a tenth)",
        "KIND");
    add_gaps_option(command, choice);
    command
        .add_option(
            "--geoid", choice.geoid,
            "geoid model: a file (.gtx, .tif, .pgm) or none (the installed EGM96, for heights "
            "above EGM96)")
        ->type_name("FILE");
}

std::string camera_source(const ViewChoice& view, const TerrainChoice& terrain) {
    if (view.eye) {
        return "--eye";
    }
    if (view.geodetic) {
        return "--camera";
    }
    return view.pose ? "--pose" : terrain.terrain;
}

void check_view_options(const ViewChoice& choice) {
    if (auto good = session::check(choice); !good) {
        throw CLI::ValidationError(good.error().message);
    }
    if (choice.pose == scene::Pose::map && !choice.path.empty()) {
        throw CLI::ValidationError("--pose: map found beside --path, which flies in perspective; "
                                   "another pose or none was expected");
    }
}

void add_samples_option(CLI::App& command, ViewChoice& choice) {
    add_parsed(
        command, "--samples", choice.samples,
        word_of<int>("--samples", {{"1", 1}, {"2", 2}, {"4", 4}, {"8", 8}, {"16", 16}}),
        "samples per pixel, for smooth edges: 1, 2, 4, 8 or 16. Techniques that trace rays trace "
        "this many. Default: 4 if the picture has triangles and at most 4096x4096 pixels, else 1; "
        "view then uses fewer while a slow view moves",
        "N");
}

void add_marks_option(CLI::App& command, ViewChoice& choice) {
    const auto parse = [](const std::string& text) -> Result<io::MarksDescription> {
        const auto marks = io::marks_from_text(text);
        return marks ? Result<io::MarksDescription>(*marks)
                     : Error{fmt::format("--marks: '{}' found, {} was expected", text,
                                         io::expected_marks)};
    };
    add_parsed(command, "--marks", choice.marks, parse,
               "drawn over the finished picture: legend of the colours by height, scale bar (in "
               "perspective right on the ground in the picture's middle, which gets a mark), north "
               "arrow (up: ahead), as legend,scale,north; hits and errors are without them (none)",
               "LIST|none");
}

void add_view_options(CLI::App& command, ViewChoice& choice) {
    add_picture_options(command, choice);
    add_appearance_options(command, choice);
    add_camera_options(command, choice);
}

} // namespace reljef::cli
