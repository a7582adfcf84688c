#include "engine/session/scene_setup.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/cast/frame/driver.h"
#include "engine/io/formats/ramp_file.h"
#include "engine/scene/graph/ground_pick.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/session/gallery.h"
#include "engine/session/ground.h"
#include "engine/session/material_source.h"
#include "engine/session/objects/surface_shaders.h"
#include "engine/session/prepared_maps.h"
#include "engine/session/scene_daylight.h"
#include "engine/session/streaming.h"
#include "engine/session/terrain_index.h"
#include "engine/terrain/field/gradient.h"
#include "engine/terrain/field/tint.h"

namespace reljef::session {
namespace {

Result<terrain::ColorRamp> ramp_of(const SourceOptions& choice, const SceneOptions& view,
                                   const io::SceneDescription& description) {
    const std::string& name = choice.ramp ? *choice.ramp : description.ramp;
    const std::string_view usual = is_map(view) ? terrain::map_ramp : terrain::default_ramp;
    if (auto built_in = terrain::named_ramp(name.empty() ? usual : name)) {
        return std::move(*built_in);
    }
    std::error_code ignored;
    if (!std::filesystem::exists(name, ignored)) {
        const Error error{fmt::format("--ramp: '{}' found, a colour file or one of {} was expected",
                                      name, fmt::join(terrain::ramp_names(), ", "))};
        return choice.ramp ? usage_error(error.message) : error;
    }
    return io::read_ramp_file(name);
}

bool prefers_plane(const scene::Technique& technique, const terrain::Terrain& terrain) {
    constexpr double max_distortion = 0.1;
    return scene::needs_plane(technique.id()) ||
           (scene::is_faster_on_plane(technique.id()) &&
            terrain::plane_distortion(terrain.heightfield) <= max_distortion);
}

Result<scene::TerrainOptions> terrain_options(const SourceOptions& choice, const SceneOptions& view,
                                              const TerrainSource& source) {
    const io::SceneDescription& description = source.description;
    scene::TerrainOptions options;
    auto ramp = ramp_of(choice, view, description);
    if (!ramp) {
        return ramp.error();
    }
    options.ramp = std::move(*ramp);
    options.imagery_share = choice.imagery_share.value_or(description.imagery_share);
    options.exaggeration = choice.exaggeration.value_or(description.exaggeration);
    options.placement = choice.placement;
    if (!options.placement && description.placement) {
        options.placement = *description.placement == "plane" ? terrain::PlacementKind::plane
                                                              : terrain::PlacementKind::ellipsoid;
    }
    if (!options.placement && view.technique && prefers_plane(*view.technique, source.terrain)) {
        options.placement = terrain::PlacementKind::plane;
    }
    return options;
}

Result<scene::Camera> geodetic_camera(const scene::TerrainSurface& surface,
                                      const GeodeticView& view) {
    const terrain::Placement& placement = surface.placement();
    const auto eye = placement.world_from_geodetic({view.latitude, view.longitude, view.height});
    if (!eye && surface.heightfield().georeference) {
        return Error{fmt::format("--camera: {},{} found, which is too far away for {} on a plane; "
                                 "a nearer place was expected, or --placement ellipsoid",
                                 view.latitude, view.longitude, surface.terrain().name)};
    }
    if (!eye) {
        return Error{
            fmt::format("--camera: {} is not georeferenced, --eye and --look were expected",
                        surface.terrain().name)};
    }
    return scene::camera_from_angles(*eye, view.heading, view.pitch,
                                     {placement.up(*eye), placement.north(*eye)});
}

constexpr double map_margin = 1.02; // of Pose::map

Result<scene::Camera> choose_camera(const TerrainScene& scene,
                                    const io::SceneDescription& description,
                                    const SceneOptions& view) {
    scene::Camera camera;
    if (view.geodetic) {
        return geodetic_camera(*scene.terrain->get<scene::TerrainNode>()->surface, *view.geodetic);
    }
    const bool is_map = view.projection == scene::ProjectionKind::orthographic;
    const bool is_described = !view.pose && !is_map && description.eye && description.target;
    if (view.eye || is_described) {
        camera.eye = view.eye ? *view.eye : *description.eye;
        camera.target = view.eye ? *view.target : *description.target;
        return camera;
    }
    const double aspect = static_cast<double>(view.size.x) / view.size.y;
    if (!view.pose && !is_map) {
        return scene::whole_camera(whole_bounds(scene), view.vertical_fov, aspect);
    }
    camera = scene.pose_camera(view.pose.value_or(scene::Pose::map));
    if (!view.pose) { // also where the picture is narrower than that of the pose
        const double width = map_margin * scene.bounds.size().x;
        camera.view_height = std::max(camera.view_height, width / aspect);
    }
    return camera;
}

// The near plane: close enough to cut nothing, and far above the smallest normal float.
constexpr double near_in_widths = 1e-6;
constexpr double max_near_in_widths = 1e-5; // for terrains narrower than 100 m

} // namespace

double near_distance(const Box& bounds) {
    const double width = bounds.size().x;
    return std::min(std::clamp(near_in_widths * width, 1e-3, 0.1), max_near_in_widths * width);
}

namespace {

// To the ground in the middle of the picture; where it shows none, to the middle of the terrain.
double metres_ahead(const TerrainScene& scene, const scene::Camera& camera) {
    const auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    const auto hit = scene::pick_ground(terrain, {camera.eye, scene::view_axes(camera).forward});
    return hit ? hit->t : glm::distance(camera.eye, scene.bounds.center());
}

// A parallel view is as high as one in perspective is at the target.
void set_projection(scene::Camera& camera, const TerrainScene& scene, const SceneOptions& view) {
    camera.vertical_fov = view.vertical_fov;
    camera.near = near_distance(scene.bounds);
    if (view.projection == scene::ProjectionKind::orthographic &&
        camera.projection == scene::ProjectionKind::perspective) {
        if (view.geodetic) { // it has angles, but no target
            camera.target =
                camera.eye + metres_ahead(scene, camera) * scene::view_axes(camera).forward;
        }
        camera.projection = scene::ProjectionKind::orthographic;
        camera.view_height = 2.0 * glm::distance(camera.eye, camera.target) *
                             std::tan(0.5 * glm::radians(view.vertical_fov));
    }
}

// A usage error if an option names the technique.
Error refused_technique(const Error& reason, const SceneOptions& view) {
    return view.technique ? usage_error(reason.message) : reason;
}

// That of rays if no technique is named and they draw the terrain.
std::optional<scene::Technique> default_technique(const scene::TerrainNode& terrain,
                                                  const SceneOptions& view) {
    const scene::Technique exact{scene::Exact{}};
    const bool is_named = view.technique || view.max_error;
    const bool is_exact = view.rays != RayUse::none && !is_named && terrain.stream == nullptr &&
                          terrain.detail == nullptr && // which lies on polygons
                          terrain.surface->placement().kind() == terrain::PlacementKind::plane &&
                          cast::obstacle_of(terrain, exact).empty();
    return is_exact ? std::optional(exact) : std::nullopt;
}

Result<void> choose_technique(TerrainScene& scene, const SceneOptions& view) {
    if (view.mixed) {
        return usage_error(
            "--technique: mixed found, the gallery was expected: a terrain is drawn with one "
            "technique");
    }
    auto& node = *scene.terrain->get<scene::TerrainNode>();
    node.material.wireframe = view.wireframe;
    const scene::Technique technique = default_technique(node, view).value_or(technique_of(view));
    if (auto good = scene.check(technique); !good) {
        return refused_technique(good.error(), view);
    }
    node.material.technique = technique;
    return {};
}

Result<void> finish_materials(TerrainScene& scene, const io::SceneDescription& description,
                              const SceneOptions& view) {
    const auto& shader = view.surface_shader ? view.surface_shader : description.surface_shader;
    const auto set = shader ? set_surface_shader(*shader, scene.materials()) : Result<void>();
    return set && !scene.is_gallery ? choose_technique(scene, view) : set;
}

} // namespace

double TerrainScene::ground(double x, double y) const {
    return scene.height_at(x, y).value_or(bounds.low.z);
}

scene::Camera TerrainScene::pose_camera(scene::Pose pose) const {
    return scene::pose_camera(pose, shown_bounds(), [&](double x, double y) {
        return city_heights != nullptr
                   ? city_heights->height_at(x, y).value_or(city_heights->bounds().low.z)
                   : ground(x, y);
    });
}

std::vector<scene::Material*> TerrainScene::materials() const {
    std::vector<scene::Material*> materials;
    for (scene::Node* const model : models) {
        materials.push_back(&model->get<scene::MeshNode>()->material);
    }
    if (materials.empty()) {
        materials.push_back(&terrain->get<scene::TerrainNode>()->material);
    }
    return materials;
}

Result<void> TerrainScene::check(const scene::Technique& technique) const {
    if (models.empty()) {
        return scene::check_technique(technique, *terrain->get<scene::TerrainNode>()->surface);
    }
    for (const scene::Node* const model : models) {
        if (auto good = scene::check_technique(technique, *model->get<scene::MeshNode>()); !good) {
            return good;
        }
    }
    return {};
}

namespace {

// The models of a gallery; each draws its own technique.
Result<std::vector<scene::Node*>> checked_gallery(TerrainScene& result, const TerrainSource& source,
                                                  const SourceOptions& terrain,
                                                  const SceneOptions& view, Log& log,
                                                  const std::stop_token& stop) {
    auto models = add_gallery(result.scene, source.description, terrain, view, log, stop);
    if (!models) {
        return models;
    }
    for (const scene::Node* const model : *models) {
        const auto* const mesh = model->get<scene::MeshNode>();
        if (auto good = scene::check_technique(mesh->material.technique, *mesh); !good) {
            return refused_technique(good.error(), view);
        }
    }
    return models;
}

// The source's heights at places on Earth where the terrain is the overview of a stream.
SourceHeights heights_of(const TerrainSource& source) {
    if (!source.stream || !source.tiles || source.tiles->is_on_plane()) {
        return {};
    }
    return [&tiles = *source.tiles](std::span<const glm::dvec2> places) {
        std::vector<std::optional<double>> heights;
        for (const io::HeightSample& found : tiles.heights(places).answers) {
            const bool is_known = found.kind == io::HeightSample::Kind::height;
            heights.push_back(is_known ? std::optional(found.height) : std::nullopt);
        }
        return heights;
    };
}

SourceHeight height_of(SourceHeights heights) {
    return heights ? [heights = std::move(heights)](
                         glm::dvec2 place) { return heights(std::span(&place, 1)).front(); }
                   : SourceHeight();
}

// Those of the scene file, then those of the options.
Result<void> place_objects(TerrainScene& scene, const TerrainSource& source,
                           const SceneOptions& view, Log& log, const std::stop_token& stop) {
    std::vector<io::ObjectDescription> objects = source.description.objects;
    for (const io::ObjectDescription& object : view.objects) {
        if (object.at || !scene.is_gallery) { // else one of its models
            objects.push_back(object);
        }
    }
    auto placed = add_objects(scene.scene, *scene.terrain->get<scene::TerrainNode>()->surface,
                              objects, height_of(heights_of(source)), stop);
    if (!placed) {
        return placed.error();
    }
    for (const std::string& note : placed->notes) {
        log.note(note);
    }
    scene.objects = std::move(placed->objects);
    return {};
}

// Levels of detail of buildings are made where the ground has an error bound.
bool needs_levels(const TerrainScene& scene, const SceneOptions& view) {
    const auto& node = *scene.terrain->get<scene::TerrainNode>();
    const auto technique = default_technique(node, view).value_or(technique_of(view));
    return view.mesh_levels && scene::error_bound(technique) > 0.0;
}

Result<void> place_buildings(TerrainScene& scene, const TerrainSource& source,
                             const SceneOptions& view, Log& log, const std::stop_token& stop) {
    if (!source.buildings.empty()) {
        auto city = add_city(scene.scene, source.buildings, needs_levels(scene, view));
        if (!city) {
            return city.error();
        }
        scene.city = *city;
    }
    std::vector<io::FootprintsDescription> files = source.description.footprints;
    files.insert(files.end(), view.footprints.begin(), view.footprints.end());
    if (files.empty()) {
        return {};
    }
    const auto task = log.start("placing buildings");
    const BuildingGround ground{*scene.terrain->get<scene::TerrainNode>()->surface,
                                heights_of(source), needs_levels(scene, view)};
    auto placed = add_buildings(scene.scene, ground, files, stop);
    if (!placed) {
        return placed.error();
    }
    for (const std::string& note : placed->notes) {
        log.note(note);
    }
    scene.buildings = std::move(*placed);
    return {};
}

Result<void> place_point_lights(TerrainScene& scene, const TerrainSource& source,
                                const SceneOptions& view, Log& log) {
    std::vector<io::PointLightDescription> lights = source.description.point_lights;
    lights.insert(lights.end(), view.point_lights.begin(), view.point_lights.end());
    auto placed = add_point_lights(scene.scene, *scene.terrain->get<scene::TerrainNode>()->surface,
                                   lights, height_of(heights_of(source)));
    if (!placed) {
        return placed.error();
    }
    const std::size_t count =
        placed->size() + source.description.lights.size() + view.lights.size();
    if (count > scene::max_shown_point_lights) {
        log.note(fmt::format("of {} lights besides the sun, each picture shows the {} brightest at "
                             "the eye",
                             count, scene::max_shown_point_lights));
    }
    scene.point_lights = std::move(*placed);
    return {};
}

Result<void> place_meshes(TerrainScene& scene, const TerrainSource& source,
                          const SceneOptions& view, Log& log, const std::stop_token& stop) {
    auto placed = place_objects(scene, source, view, log, stop);
    placed = placed ? place_buildings(scene, source, view, log, stop) : placed;
    return placed ? place_point_lights(scene, source, view, log) : placed;
}

} // namespace

Result<TerrainScene> make_scene(TerrainSource source, const SourceOptions& terrain,
                                const SceneOptions& view, Log& log, const std::stop_token& stop) {
    TerrainScene result;
    result.is_gallery = source.description.generator == "gallery";
    result.failed_files = source.terrain.errors.size();
    const auto options = terrain_options(terrain, view, source);
    if (!options) {
        return options.error();
    }
    auto node = result.scene.add_terrain(std::move(source.terrain), *options);
    if (!node) {
        return node.error();
    }
    result.terrain = *node;
    auto& shown = *result.terrain->get<scene::TerrainNode>();
    set_stream_and_limits(shown, source, terrain.memory_megabytes);
    set_overlay(result, source.description, view);
    result.bounds = result.terrain->world_bounds();
    auto city = city_surface(std::move(source.city_heights), shown.surface->heightfield().spacing,
                             *options);
    if (!city) {
        return city.error();
    }
    result.city_heights = std::move(*city);
    result.rays = view.rays;
    result.mesh_levels = view.mesh_levels;
    auto detail = open_detail(source.description, terrain, view, log, stop);
    if (!detail) {
        return detail.error();
    }
    shown.detail = std::move(*detail);
    if (auto done = place_meshes(result, source, view, log, stop); !done) {
        return done.error();
    }
    if (result.is_gallery) {
        auto models = checked_gallery(result, source, terrain, view, log, stop);
        if (!models) {
            return models.error();
        }
        result.models = std::move(*models);
        if (view.rays == RayUse::only) { // which draw no floor of triangles
            shown.material.technique = {scene::Exact{}};
        }
        shadow_floor(shown, result.models);
    }
    auto finished = finish_materials(result, source.description, view);
    finished = finished ? add_daylight(result, source.description, view, log) : finished;
    if (!finished) {
        return finished.error();
    }
    auto camera = choose_camera(result, source.description, view);
    if (!camera) {
        return camera.error();
    }
    set_projection(*camera, result, view);
    result.camera = &result.scene.add_camera(*camera);
    if (shown.stream != nullptr) {
        source.terrain = {};
        result.source = std::make_shared<const TerrainSource>(std::move(source));
    }
    return result;
}

Result<TerrainSource> open_source(io::SceneDescription description, const SourceOptions& terrain,
                                  const SceneOptions& view, Log& log, const std::stop_token& stop) {
    if (auto good = check(view); !good) {
        return good.error();
    }
    auto source = open_terrain(std::move(description), streamed_for(terrain, view), log, stop);
    if (!source || terrain.index == IndexUse::none) {
        return source;
    }
    const bool makes_index = terrain.index == IndexUse::made && names_error_bound(view);
    const auto added = add_proofs(*source, makes_index, log, stop);
    return added ? std::move(source) : Result<TerrainSource>(added.error());
}

Result<TerrainSource> open_source(const SourceOptions& terrain, const SceneOptions& view, Log& log,
                                  const std::stop_token& stop) {
    auto description = describe(terrain.terrain);
    return description ? open_source(std::move(*description), terrain, view, log, stop)
                       : description.error();
}

Result<TerrainScene> open_scene(TerrainSource source, const SourceOptions& terrain,
                                const SceneOptions& view, Log& log, const std::stop_token& stop) {
    auto scene = make_scene(std::move(source), terrain, view, log, stop);
    if (!scene) {
        return scene;
    }
    if (const auto note = geoid_note(*scene, terrain)) {
        log.note(*note);
    }
    if (!view.prepares_maps) {
        return scene;
    }
    const auto maps = prepare_maps(missing_maps(*scene), terrain.threads, log, stop);
    if (!maps) {
        return maps.error();
    }
    apply_maps(*scene, *maps);
    auto added = add_levels(*scene, terrain.threads, log, stop);
    return added ? std::move(scene) : added.error();
}

Result<TerrainScene> open_scene(io::SceneDescription description, const SourceOptions& terrain,
                                const SceneOptions& view, Log& log, const std::stop_token& stop) {
    auto source = open_source(std::move(description), terrain, view, log, stop);
    return source ? open_scene(std::move(*source), terrain, view, log, stop) : source.error();
}

Result<TerrainScene> open_scene(const SourceOptions& terrain, const SceneOptions& view, Log& log,
                                const std::stop_token& stop) {
    auto source = open_source(terrain, view, log, stop);
    return source ? open_scene(std::move(*source), terrain, view, log, stop) : source.error();
}

} // namespace reljef::session
