#include "app/scene_setup.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/io/scene_file.h"

namespace reljef::app {
namespace {

// The air of a clear day over a scene: a fifth of the contrast is gone after one and a half widths.
constexpr double visibility_in_widths = 25.0;

scene::TerrainOptions terrain_options(const TerrainChoice& choice, const ViewChoice& view,
                                      const io::SceneDescription& description) {
    scene::TerrainOptions options;
    options.exaggeration = choice.exaggeration.value_or(description.exaggeration);
    options.placement = choice.placement;
    if (!options.placement && description.placement) {
        options.placement = *description.placement == "plane" ? terrain::PlacementKind::plane
                                                              : terrain::PlacementKind::ellipsoid;
    }
    if (!options.placement && scene::geometry_of(view.technique.id) == scene::Geometry::box) {
        options.placement = terrain::PlacementKind::plane; // the only one it draws
    }
    return options;
}

Result<scene::Camera> geodetic_camera(const scene::TerrainSurface& surface,
                                      const GeodeticView& view) {
    const terrain::Placement& placement = surface.placement();
    const auto eye = placement.world_from_geodetic({view.latitude, view.longitude, view.height});
    if (!eye) {
        return Error{
            fmt::format("--camera: {} is not georeferenced, --eye and --look were expected",
                        surface.terrain().name)};
    }
    return scene::camera_from_angles(*eye, view.heading, view.pitch, placement.up(*eye));
}

Result<scene::Camera> choose_camera(const TerrainScene& scene,
                                    const io::SceneDescription& description,
                                    const ViewChoice& view) {
    scene::Camera camera;
    if (view.geodetic) {
        return geodetic_camera(*scene.terrain->get<scene::TerrainNode>()->surface, *view.geodetic);
    }
    if (view.eye) {
        camera.eye = *view.eye;
        camera.look = *view.look;
        return camera;
    }
    const bool is_map = view.projection == scene::ProjectionKind::orthographic;
    if (!view.pose && !is_map && description.eye && description.look) {
        camera.eye = *description.eye;
        camera.look = *description.look;
        return camera;
    }
    const auto ground = [&](double x, double y) { return scene.ground(x, y); };
    return scene::pose_camera(view.pose.value_or(is_map ? scene::Pose::map : scene::Pose::overview),
                              scene.bounds, ground);
}

// The nearest depth drawn: so close that nothing in reach of the eye is cut, and far above the
// smallest normal float.
constexpr double near_in_widths = 1e-6;

void set_projection(scene::Camera& camera, const Box& bounds, const ViewChoice& view) {
    camera.vertical_fov = view.vertical_fov;
    camera.near = std::clamp(near_in_widths * bounds.size().x, 1e-3, 0.1);
    if (view.projection == scene::ProjectionKind::orthographic &&
        camera.projection == scene::ProjectionKind::perspective) {
        camera.projection = scene::ProjectionKind::orthographic;
        camera.view_height = 2.0 * glm::distance(camera.eye, camera.look) *
                             std::tan(0.5 * glm::radians(view.vertical_fov));
    }
}

} // namespace

double TerrainScene::ground(double x, double y) const {
    return scene.height_at(x, y).value_or(bounds.low.z);
}

Result<TerrainScene> make_scene(TerrainSource source, const TerrainChoice& terrain,
                                const ViewChoice& view) {
    TerrainScene result;
    const auto options = terrain_options(terrain, view, source.description);
    auto node = result.scene.add_terrain(std::move(source.terrain), options);
    if (!node) {
        return node.error();
    }
    result.terrain = *node;
    result.bounds = result.terrain->world_bounds();
    auto& material = result.terrain->get<scene::TerrainNode>()->material;
    if (auto good = scene::check_technique(view.technique,
                                           *result.terrain->get<scene::TerrainNode>()->surface);
        !good) {
        return good.error();
    }
    material.technique = technique_of(view);
    material.wireframe = view.wireframe;

    scene::Light sun;
    sun.azimuth = view.sun ? view.sun->x : source.description.sun_azimuth;
    sun.altitude = view.sun ? view.sun->y : source.description.sun_altitude;
    result.scene.add_light(sun);
    scene::Sky sky;
    const glm::dvec3 size = result.bounds.size();
    sky.visibility = source.description.visibility.value_or(visibility_in_widths *
                                                            std::max({size.x, size.y, size.z}));
    result.scene.set_sky(sky);

    auto camera = choose_camera(result, source.description, view);
    if (!camera) {
        return camera.error();
    }
    set_projection(*camera, result.bounds, view);
    result.camera = &result.scene.add_camera(*camera);
    return result;
}

Result<std::optional<scene::FlyPath>> open_path(const TerrainScene& scene, const ViewChoice& view) {
    using Path = std::optional<scene::FlyPath>;
    if (view.path.empty()) {
        return Path();
    }
    if (view.path == "orbit") {
        return Path(scene::orbit_path(scene.bounds));
    }
    if (view.path == "flyover") {
        return Path(scene::flyover_path(scene.bounds,
                                        [&](double x, double y) { return scene.ground(x, y); }));
    }
    std::error_code ignored;
    if (!std::filesystem::exists(view.path, ignored)) {
        return Error{fmt::format("--path: '{}' found, orbit, flyover or a path file was expected",
                                 view.path)};
    }
    const auto keys = io::read_path_file(view.path);
    if (!keys) {
        return keys.error();
    }
    std::vector<scene::FlyKey> fly_keys;
    std::transform(keys->begin(), keys->end(), std::back_inserter(fly_keys), [](const auto& key) {
        return scene::FlyKey{key.time, key.eye, key.look};
    });
    auto path = scene::FlyPath::create(std::move(fly_keys));
    if (!path) {
        return path.error();
    }
    return Path(std::move(*path));
}

} // namespace reljef::app
