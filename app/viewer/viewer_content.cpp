#include "app/viewer/viewer_content.h"

#include "engine/session/ground.h"
#include "engine/terrain/field/tint.h"

namespace reljef::app {
namespace {

constexpr int legend_stops = 33;

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

AppearanceContent appearance_of(const Viewer& viewer) {
    AppearanceContent appearance;
    appearance.light = viewer.light();
    appearance.exaggeration = viewer.exaggeration();
    appearance.fixed_exaggeration = viewer.exaggeration_obstacle();
    appearance.shows_map = viewer.is_map();
    appearance.plays_path = viewer.is_playing();
    appearance.follows_ground = viewer.follows_ground();
    return appearance;
}

} // namespace

PlaceContent place_of(const session::TerrainScene& scene, glm::dvec3 world) {
    const scene::TerrainSurface& surface = *terrain_of(scene).surface;
    PlaceContent place;
    place.world = world;
    place.on_earth = surface.placement().geodetic_from_world(world);
    const auto sample = surface.placement().sample_from_world(world);
    place.height = sample ? sample->z : world.z;
    place.in_crs = sample ? crs_place(surface, *sample) : std::nullopt;
    return place;
}

std::vector<LegendStop> legend_of(const session::TerrainScene& scene) {
    const scene::TerrainSurface& surface = *terrain_of(scene).surface;
    const terrain::Terrain& terrain = surface.terrain();
    const bool has_images =
        !terrain.color.empty() || (scene.source != nullptr && scene.source->imagery != nullptr);
    const terrain::HeightRange range = terrain.heightfield.range;
    if (has_images || !scene.models.empty() || !(range.low < range.high)) {
        return {};
    }
    const terrain::HeightTint tint(surface.ramp(), terrain.heightfield);
    std::vector<LegendStop> stops;
    for (int i = 0; i < legend_stops; ++i) {
        const double height = range.low + (range.high - range.low) * i / (legend_stops - 1);
        stops.push_back({height, tint.at(height, glm::vec2(0.0F))});
    }
    return stops;
}

PanelContent content_of(const Viewer& viewer, const session::TerrainScene& scene,
                        glm::ivec2 window) {
    const auto& camera = *scene.camera->get<scene::Camera>();
    PanelContent content;
    content.terrain = terrain_of(scene).surface->terrain().name;
    content.frame.window = window;
    content.technique = viewer.techniques().content();
    content.appearance = appearance_of(viewer);
    content.compare = viewer.comparison().content(viewer.technique());
    content.eye = place_of(scene, viewer.is_map() ? camera.target : camera.eye);
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

} // namespace reljef::app
