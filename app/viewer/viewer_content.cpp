#include "app/viewer/viewer_content.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

#include "engine/session/ground.h"
#include "engine/session/scene_daylight.h"
#include "engine/terrain/field/color_ramp.h"
#include "engine/terrain/field/placement.h"
#include "engine/terrain/measure/profile.h"

namespace reljef::app {
namespace {

const scene::TerrainNode& terrain_of(const session::TerrainScene& scene) {
    return *scene.terrain->get<scene::TerrainNode>();
}

std::optional<CrsPlace> crs_place(const scene::TerrainSurface& surface, glm::dvec3 sample) {
    const auto& georeference = surface.heightfield().georeference;
    if (!georeference) {
        return std::nullopt;
    }
    return CrsPlace{georeference->crs_from_pixel.crs_from_pixel(glm::dvec2(sample)),
                    georeference->crs_name, georeference->horizontal_unit != "degree"};
}

AppearanceContent appearance_of(const Viewer& viewer, const session::TerrainScene& scene) {
    AppearanceContent appearance;
    appearance.turbidity = scene.surroundings.turbidity;
    if (const auto sky = scene.scene.sky()) {
        appearance.visibility = sky->visibility;
    }
    if (terrain_of(scene).surface->heightfield().georeference) {
        appearance.on_earth =
            terrain_of(scene).surface->placement().geodetic_from_world(scene.bounds.center());
        appearance.true_north = session::true_north(scene).value_or(0.0);
    }
    if (scene.models.empty()) {
        appearance.ramp = viewer.ramp().name;
        for (const std::string_view name : terrain::ramp_names()) {
            appearance.ramps.emplace_back(name);
        }
    }
    if (scene.models.empty() && !terrain_of(scene).surface->terrain().color.empty()) {
        appearance.imagery_share = viewer.imagery_share();
    }
    appearance.grain = static_cast<double>(terrain_of(scene).grain);
    appearance.eye_dome = scene.scene.eye_dome();
    appearance.contours = terrain_of(scene).contours;
    appearance.faded_contours = viewer.faded_contours();
    appearance.labels_contours = terrain_of(scene).labels_contours;
    appearance.light = viewer.light();
    appearance.sun_time = scene.surroundings.sun_time;
    appearance.exaggeration = viewer.exaggeration();
    appearance.max_exaggeration = terrain::max_exaggeration;
    appearance.fixed_exaggeration = viewer.exaggeration_obstacle();
    appearance.shows_map = viewer.is_map();
    appearance.plays_path = viewer.is_playing();
    appearance.follows_ground = viewer.follows_ground();
    return appearance;
}

constexpr std::size_t plotted_heights = 256;

std::optional<ProfileContent> profile_of(const Measuring& measuring) {
    const auto points = measuring.profile();
    if (points.empty()) {
        return std::nullopt;
    }
    const terrain::ProfileSummary summary = terrain::summarize(points);
    ProfileContent profile;
    profile.distance = summary.distance;
    profile.over_ground = summary.over_ground;
    profile.climb = summary.climb;
    profile.descent = summary.descent;
    profile.lowest = summary.lowest;
    profile.highest = summary.highest;
    profile.in_sight = measuring.is_in_sight();
    for (std::size_t i = 0; i < plotted_heights; ++i) {
        const double height = points[i * (points.size() - 1) / (plotted_heights - 1)].height;
        profile.heights.push_back(static_cast<float>(std::isnan(height) ? summary.lowest : height));
    }
    return profile;
}

MeasureContent measure_of(const Viewer& viewer, const scene::Camera& camera, glm::ivec2 window) {
    const Measuring& measuring = viewer.measuring();
    MeasureContent measure;
    measure.is_on = measuring.is_on();
    for (std::size_t i = 0; i < measuring.points().size(); ++i) {
        const scene::Projected at =
            scene::project(camera, glm::max(window, glm::ivec2(1)), measuring.points()[i]);
        const bool is_before =
            at.depth > 0.0 || camera.projection == scene::ProjectionKind::orthographic;
        const std::string& line = measuring.texts()[i]; // "place: ground"
        const std::size_t colon = std::min(line.find(": "), line.size());
        measure.points.push_back({line.substr(0, colon),
                                  line.substr(std::min(colon + 2, line.size())),
                                  is_before ? std::optional(at.pixel) : std::nullopt});
    }
    measure.profile = profile_of(measuring);
    if (measuring.seen() != nullptr) {
        measure.viewshed = viewer.shows_viewshed();
    }
    if (viewer.shows_viewshed()) {
        measure.ground_colors = {{"seen from the point", Measuring::visible_color},
                                 {"hidden", Measuring::hidden_color}};
    }
    return measure;
}

// Around the corners of a node's own bounds; empty if the eye is beside or in them.
std::optional<PixelBox> box_of(const scene::Node& node, const scene::Camera& camera,
                               glm::ivec2 window) {
    const Box bounds = node.local_bounds();
    const glm::dmat4 world_from_local = node.world_from_local();
    if (bounds.empty()) {
        return std::nullopt;
    }
    PixelBox box{glm::dvec2(std::numeric_limits<double>::infinity()),
                 glm::dvec2(-std::numeric_limits<double>::infinity())};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::bvec3 is_high((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
        const glm::dvec4 local(glm::mix(bounds.low, bounds.high, is_high), 1.0);
        const scene::Projected at = scene::project(camera, glm::max(window, glm::ivec2(1)),
                                                   glm::dvec3(world_from_local * local));
        if (!(at.depth > 0.0) && camera.projection == scene::ProjectionKind::perspective) {
            return std::nullopt;
        }
        box = {glm::min(box.low, at.pixel), glm::max(box.high, at.pixel)};
    }
    return box;
}

void mark_model(TechniqueContent& technique, const session::TerrainScene& scene,
                const scene::Camera& camera, glm::ivec2 window) {
    if (technique.model && *technique.model < scene.models.size()) {
        technique.models.at(*technique.model).box =
            box_of(*scene.models[*technique.model], camera, window);
    }
}

PathContent path_of(const Viewer& viewer) {
    const scene::CameraPath& path = viewer.path_desk().path();
    PathContent content;
    for (const scene::Keyframe& key : path.keys()) {
        content.keys.push_back(key.time - path.begin());
    }
    content.time = viewer.path_time();
    content.is_playing = viewer.is_playing();
    content.is_recording = viewer.path_desk().is_recording();
    return content;
}

} // namespace

PlaceContent place_of(const session::TerrainScene& scene, const session::PickedPlace& picked) {
    const scene::TerrainSurface& surface = *terrain_of(scene).surface;
    const glm::dvec3 world = picked.world;
    PlaceContent place;
    place.world = world;
    place.on_earth = surface.placement().geodetic_from_world(world);
    const auto sample = surface.placement().sample_from_world(world);
    place.height = session::height_of(terrain_of(scene), picked);
    place.object = picked.object;
    place.in_crs = sample ? crs_place(surface, *sample) : std::nullopt;
    return place;
}

PanelContent content_of(const Viewer& viewer, const session::TerrainScene& scene,
                        glm::ivec2 window) {
    const auto& camera = *scene.camera->get<scene::Camera>();
    PanelContent content;
    content.terrain = terrain_of(scene).surface->terrain().name;
    content.frame.window = window;
    content.technique = viewer.techniques().content();
    content.technique.is_as_at_start = viewer.keeps_techniques();
    mark_model(content.technique, scene, camera, window);
    content.appearance = appearance_of(viewer, scene);
    content.measure = measure_of(viewer, camera, window);
    content.path = path_of(viewer);
    content.bookmarks = viewer.known_bookmarks();
    content.compare = viewer.comparison().content(viewer.technique());
    content.eye = place_of(scene, {viewer.is_map() ? camera.target : camera.eye});
    if (!viewer.is_map() && scene.models.empty()) {
        content.eye.above_ground = session::height_above_ground(terrain_of(scene), camera.eye);
    }
    content.heading = viewer.heading();
    content.metres_per_pixel =
        session::metres_per_pixel(terrain_of(scene), camera, std::max(window.y, 1));
    content.speed = viewer.speed();
    const auto progress = viewer.progress();
    content.task = {progress.label, progress.fraction};
    content.keys = Viewer::key_list();
    return content;
}

ShownState shown_state(const Viewer& viewer, const session::TerrainScene& scene, glm::ivec2 size,
                       std::optional<int> samples) {
    const bool has_named_ramp = scene.models.empty() && terrain::named_ramp(viewer.ramp().name);
    return {.technique = viewer.technique(),
            .light = viewer.light(),
            .exaggeration = viewer.exaggeration(),
            .size = size,
            .samples = samples,
            .keeps_techniques = viewer.keeps_techniques(),
            .ramp = has_named_ramp ? viewer.ramp().name : std::string(),
            .compare = viewer.comparison().option(),
            .wipe = viewer.comparison().share(),
            .shows_viewshed = viewer.shows_viewshed()};
}

} // namespace reljef::app
