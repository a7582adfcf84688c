#include "engine/session/scene_daylight.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/geo/georeference.h"
#include "engine/io/image/sky_file.h"
#include "engine/scene/graph/terrain_base.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/session/objects/placed_lights.h"
#include "engine/terrain/field/color_ramp.h"
#include "engine/terrain/field/tint.h"

namespace reljef::session {
namespace {

// A third of the contrast is gone after one width, at the height of the lowest ground.
constexpr double visibility_in_widths = 10.0;
constexpr double min_visibility = 30e3; // metres: shadows of a city are not blue

// Whether most of the border is level with the sea.
bool is_in_sea(const terrain::Heightfield& heightfield) {
    const Grid<float>& heights = heightfield.heights;
    std::size_t sea = 0;
    std::size_t count = 0;
    const auto add = [&](int col, int row) {
        sea += heights(col, row) == 0.0F ? 1U : 0U;
        ++count;
    };
    for (int col = 0; col < heights.cols(); ++col) {
        add(col, 0);
        add(col, heights.rows() - 1);
    }
    for (int row = 0; row < heights.rows(); ++row) {
        add(0, row);
        add(heights.cols() - 1, row);
    }
    return 2 * sea > count;
}

// Whether the plane goes on with the sea around the terrain. The floor of the gallery and the plane
// of a city, level at 0, are no sea.
bool is_island(const TerrainScene& scene) {
    const auto& surface = *scene.terrain->get<scene::TerrainNode>()->surface;
    return !scene.is_gallery && scene.city == nullptr && is_in_sea(surface.heightfield());
}

// The samples above or below the sea, from their lowest to their highest col, row and height.
Box land_samples(const Grid<float>& heights) {
    Box land;
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            if (heights(col, row) != 0.0F) {
                land.add({col, row, heights(col, row)});
            }
        }
    }
    return land;
}

// With sea around it, within the terrain.
Box with_coast(Box land, const Grid<float>& heights) {
    constexpr double in_sizes = 0.2;
    constexpr double in_terrains = 0.05;
    const glm::dvec3 last(heights.cols() - 1, heights.rows() - 1, 0.0);
    const double margin = std::max(in_sizes * std::max(land.size().x, land.size().y),
                                   in_terrains * std::max(last.x, last.y));
    land.low =
        glm::max(land.low - glm::dvec3(margin, margin, 0.0), glm::dvec3(0.0, 0.0, land.low.z));
    land.high = glm::min(land.high + glm::dvec3(margin, margin, 0.0),
                         glm::dvec3(last.x, last.y, land.high.z));
    land.low.z = std::min(land.low.z, 0.0);
    return land;
}

// Beyond, the Earth is no plane.
bool has_plane_below(const TerrainScene& scene) {
    constexpr double max_width = 5e5; // metres
    const glm::dvec3 size = scene.bounds.size();
    return std::max(size.x, size.y) <= max_width;
}

// Of the sea; else pale and of no colour, so that the terrain stands out from it.
glm::vec3 base_albedo(const TerrainScene& scene, bool is_sea) {
    constexpr float table_albedo = 0.56F; // on which a block lies
    if (scene.surroundings.base == BaseKind::solid) {
        return glm::vec3(table_albedo);
    }
    return is_sea ? linear_from_rgba8(terrain::HeightTint::water) : glm::vec3(0.42F, 0.42F, 0.41F);
}

constexpr glm::vec3 wall_albedo{0.42F, 0.375F, 0.32F}; // light rock, linear

std::shared_ptr<const scene::MeshNode> walls_below(const scene::TerrainSurface& surface,
                                                   double bottom) {
    auto mesh = scene::terrain_base(surface, bottom);
    if (!mesh) {
        return nullptr;
    }
    scene::MeshNode node{std::make_shared<const scene::Mesh>(std::move(*mesh)), {}};
    node.material.color = wall_albedo;
    return std::make_shared<const scene::MeshNode>(std::move(node));
}

// Air gets thinner with the terrain's own heights, or with a part of its width.
scene::Sky sky_over(const TerrainScene& scene, scene::Sky sky) {
    const glm::dvec3 size = scene.bounds.size();
    const double width = std::max(size.x, size.y);
    sky.visibility = scene.surroundings.visibility.value_or(
        std::max(visibility_in_widths * std::max(width, size.z), min_visibility));
    constexpr double in_heights = 1.5;
    constexpr double in_widths = 0.05;
    sky.air_height = std::max(in_heights * size.z, in_widths * width);
    sky.base = scene.bounds.low.z;
    return sky;
}

// The plane is the sea around an island, and bends like the Earth. The air over it is low and so
// thick that the sea fades before its horizon, seen from near it; hills rise above most of the air.
void lay_sea(const TerrainScene& scene, scene::Sky& sky) {
    constexpr double usual_visibility = 80e3; // metres
    constexpr double air_height = 400.0;      // metres
    const auto& surface = *scene.terrain->get<scene::TerrainNode>()->surface;
    const Grid<float>& heights = surface.heightfield().heights;
    const terrain::Placement& placement = surface.placement();
    const glm::dvec2 middle = 0.5 * glm::dvec2(heights.cols() - 1, heights.rows() - 1);
    sky.is_plane_sea = true;
    sky.base = placement.world_from_sample({middle, 0.0}).z;
    if (placement.kind() == terrain::PlacementKind::ellipsoid) {
        sky.radius = geo::mean_radius_of_earth;
    }
    sky.air_height = std::min(sky.air_height, air_height * placement.exaggeration());
    if (!scene.surroundings.visibility) {
        sky.visibility = std::min(sky.visibility, usual_visibility);
    }
}

} // namespace

std::optional<double> true_north(const TerrainScene& scene) {
    const scene::TerrainSurface& surface = *scene.terrain->get<scene::TerrainNode>()->surface;
    const glm::dvec3 middle = scene.bounds.center();
    if (!surface.heightfield().georeference || !surface.placement().geodetic_from_world(middle)) {
        return std::nullopt;
    }
    const glm::dvec3 north = surface.placement().north(middle);
    return glm::degrees(std::atan2(north.x, north.y));
}

namespace {

// Walls follow all samples of the border; a stream shows coarser ones, too.
BaseKind base_kind(const TerrainScene& scene, const io::SceneDescription& description,
                   const SceneOptions& view, Log& log) {
    const bool is_named = view.base || !description.base.empty();
    const BaseKind described = description.base == "none"    ? BaseKind::none
                               : description.base == "solid" ? BaseKind::solid
                                                             : BaseKind::plane;
    const BaseKind kind = view.base.value_or(is_named ? described : view.default_base);
    if (kind != BaseKind::solid) {
        return kind;
    }
    if (scene.terrain->get<scene::TerrainNode>()->stream != nullptr) {
        if (is_named) {
            log.note("a terrain that is read tile by tile has no walls: it lies on a plane; a "
                     "larger --memory shows --base solid");
        }
        return BaseKind::plane;
    }
    const bool is_usual = !scene.is_gallery && !is_island(scene) && has_plane_below(scene);
    return is_named || is_usual ? kind : BaseKind::plane;
}

Result<std::shared_ptr<const material::SkyPicture>>
sky_picture(const io::SceneDescription& description, const SceneOptions& view) {
    const std::filesystem::path file = view.sky.value_or(description.sky);
    if (file.empty()) {
        return view.sky_turn
                   ? Result<std::shared_ptr<const material::SkyPicture>>(usage_error(
                         "--sky-turn: no picture of a sky found, --sky FILE was expected"))
                   : std::shared_ptr<const material::SkyPicture>();
    }
    auto picture = io::read_sky(file, view.sky_turn.value_or(description.sky_turn));
    if (!picture) {
        return picture.error();
    }
    return std::make_shared<const material::SkyPicture>(std::move(*picture));
}

// When the sun stands where it was placed; absent: angles place it.
std::optional<geo::UniversalTime> sun_time(const io::SceneDescription& description,
                                           const SceneOptions& view) {
    if (!view.sun) {
        return description.sun_time;
    }
    const auto* const time = std::get_if<geo::UniversalTime>(&*view.sun);
    return time != nullptr ? std::optional(*time) : std::nullopt;
}

Result<Surroundings> surroundings_of(const TerrainScene& scene,
                                     const io::SceneDescription& description,
                                     const SceneOptions& view, Log& log) {
    Surroundings found;
    found.turbidity =
        view.turbidity.value_or(description.turbidity.value_or(scene::default_turbidity));
    found.visibility = view.visibility ? view.visibility : description.visibility;
    found.base = base_kind(scene, description, view, log);
    auto sky = sky_picture(description, view);
    if (!sky) {
        return sky.error();
    }
    found.sky = std::move(*sky);
    found.sun_time = sun_time(description, view);
    return found;
}

// Azimuth, [0, 360), and altitude over the terrain's middle, degrees. `subject`: what named the
// time, for messages.
Result<glm::dvec2> sun_angles(const TerrainScene& scene, const geo::UniversalTime& time,
                              std::string_view subject) {
    const scene::TerrainSurface& surface = *scene.terrain->get<scene::TerrainNode>()->surface;
    const auto north = true_north(scene);
    if (!north) {
        return usage_error(
            fmt::format("{}: {} has no place on Earth, which the sun of a time needs; "
                        "the sun's azimuth and altitude need none",
                        subject, surface.terrain().name));
    }
    const auto middle = surface.placement().geodetic_from_world(scene.bounds.center());
    const auto sun = geo::sun_by_day(time, middle->latitude, middle->longitude);
    if (!sun) {
        return usage_error(
            fmt::format("{}: over {}, {}", subject, surface.terrain().name, sun.error().message));
    }
    return glm::dvec2(std::fmod(sun->azimuth + *north + 360.0, 360.0), sun->altitude);
}

Result<scene::Light> chosen_sun(const TerrainScene& scene, const io::SceneDescription& description,
                                const SceneOptions& view) {
    const glm::dvec2 usual = default_sun(view);
    const SunChoice choice = view.sun.value_or(glm::dvec2(
        description.sun_azimuth.value_or(usual.x), description.sun_altitude.value_or(usual.y)));
    const auto& time = scene.surroundings.sun_time;
    const std::string subject =
        view.sun
            ? std::string("--sun")
            : scene.terrain->get<scene::TerrainNode>()->surface->terrain().name + ": [sun] time";
    const auto angles =
        time ? sun_angles(scene, *time, subject) : Result<glm::dvec2>(std::get<glm::dvec2>(choice));
    if (!angles) {
        return angles.error();
    }
    scene::Light sun;
    sun.azimuth = angles->x;
    sun.altitude = angles->y;
    sun.is_sky_hidden = view.hides_sky.value_or(description.hides_sky);
    return sun;
}

// Of a spire, the heights around the median; else all.
Box without_spires(const TerrainScene& scene, Box shown) {
    const glm::dvec2 size(scene.bounds.size());
    const double width = glm::length(size);
    if (scene.is_gallery || scene.bounds.size().z <= max_spire * width) {
        return shown;
    }
    constexpr int steps = 32;
    std::vector<double> heights;
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; j <= steps; ++j) {
            const glm::dvec2 place =
                glm::dvec2(scene.bounds.low) + size * glm::dvec2(i, j) / double{steps};
            heights.push_back(scene.ground(place.x, place.y));
        }
    }
    const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
    std::nth_element(heights.begin(), middle, heights.end());
    shown.low.z = std::max(shown.low.z, *middle - 0.5 * width);
    shown.high.z = std::max(shown.low.z, std::min(shown.high.z, *middle + 0.5 * width));
    return shown;
}

} // namespace

std::vector<std::string> shape_notes(const terrain::Terrain& terrain, double exaggeration) {
    const terrain::Heightfield& field = terrain.heightfield;
    const glm::dvec2 samples(field.heights.cols(), field.heights.rows());
    const double width = glm::length(samples * field.spacing);
    const double height = exaggeration * (field.range.high - field.range.low);
    std::vector<std::string> notes;
    if (height > max_spire * width) {
        notes.push_back(fmt::format("{}: heights over {:.0f} m found on {:.0f} m of ground: a "
                                    "picture of all of it is a line, so pictures without a camera "
                                    "show the heights around the median",
                                    terrain.name, height, width));
    }
    const std::size_t valid = field.heights.size() - field.void_count;
    constexpr std::size_t few = 4; // of a square
    if (valid < few && field.heights.size() >= few) {
        notes.push_back(fmt::format("{}: {} valid sample{} found: no ground lies between so few",
                                    terrain.name, valid, valid == 1 ? "" : "s"));
    }
    return notes;
}

Box whole_bounds(const TerrainScene& scene) {
    const auto& surface = *scene.terrain->get<scene::TerrainNode>()->surface;
    const Grid<float>& heights = surface.heightfield().heights;
    const bool shows_edges = scene.surroundings.base != BaseKind::plane;
    const Box land = !shows_edges && is_island(scene) ? land_samples(heights) : Box();
    if (land.empty()) {
        return without_spires(scene, scene.shown_bounds());
    }
    // On the ellipsoid, its sides and the middle bulge.
    const Box samples = with_coast(land, heights);
    constexpr int steps = 8;
    Box shown;
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; j <= steps; ++j) {
            for (const double height : {samples.low.z, samples.high.z}) {
                const glm::dvec2 place = glm::mix(glm::dvec2(samples.low), glm::dvec2(samples.high),
                                                  glm::dvec2(i, j) / double{steps});
                shown.add(surface.placement().world_from_sample({place, height}));
            }
        }
    }
    return without_spires(scene, shown);
}

Result<void> add_daylight(TerrainScene& scene, const io::SceneDescription& description,
                          const SceneOptions& view, Log& log) {
    auto surroundings = surroundings_of(scene, description, view, log);
    if (!surroundings) {
        return surroundings.error();
    }
    scene.surroundings = std::move(*surroundings);
    scene.light = &scene.scene.add_light();
    const auto sun = chosen_sun(scene, description, view);
    if (!sun) {
        return sun.error();
    }
    set_daylight(scene, *sun);
    for (const auto* const lights : {&description.lights, &view.lights}) {
        for (const io::LightDescription& light : *lights) {
            scene.scene.add_light(light_of(light));
        }
    }
    const auto& node = *scene.terrain->get<scene::TerrainNode>();
    if (!scene.is_gallery && !scene.scene.point_lights().empty() &&
        node.material.technique.id() == scene::TechniqueId::prewarp) {
        log.note("the technique prewarp shows no light on terrain but that of the sun and the sky");
    }
    if (!scene.is_gallery) {
        for (const std::string& note :
             shape_notes(node.surface->terrain(), node.surface->placement().exaggeration())) {
            log.note(note);
        }
    }
    return {};
}

void set_daylight(TerrainScene& scene, scene::Light sun) {
    const scene::Daylight daylight = scene::daylight_at(sun.altitude, scene.surroundings.turbidity);
    sun.color = daylight.sun;
    sun.ambient = daylight.ambient;
    *scene.light->get<scene::Light>() = sun;

    scene::Sky sky = sky_over(scene, daylight.sky);
    if (const auto& picture = scene.surroundings.sky) {
        sky.picture = picture;
        sky.horizon = picture->horizon();
        sky.glow = glm::vec3(0.0F);
    }
    const BaseKind base = scene.surroundings.base;
    if (base != BaseKind::none && has_plane_below(scene)) {
        if (base == BaseKind::plane && is_island(scene)) {
            lay_sea(scene, sky);
        }
        const auto level = static_cast<float>(std::max(scene::to_light(sun).z, 0.0));
        sky.plane = base_albedo(scene, sky.is_plane_sea) * (level * sun.color + sun.ambient);
    }
    auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    if (base == BaseKind::solid && !scene.is_gallery) {
        terrain.base = walls_below(*terrain.surface, scene::block_bottom(*terrain.surface));
    } else {
        // Else land that the border cuts would show the sea behind it.
        terrain.base = sky.is_plane_sea ? walls_below(*terrain.surface, 0.0) : nullptr;
    }
    scene.scene.set_sky(sky);
}

void follow_ramp(TerrainScene& scene) {
    auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    const bool has_images = !terrain.surface->terrain().color.empty() ||
                            (terrain.stream != nullptr && terrain.stream->maker().has_images());
    const bool is_plain = !has_images && terrain::has_one_color(terrain.surface->ramp());
    if (scene.usual_grain) {
        terrain.grain = is_plain ? 0.0F : static_cast<float>(*scene.usual_grain);
    }
}

void set_overlay(TerrainScene& scene, const io::SceneDescription& description,
                 const SceneOptions& view) {
    scene.scene.set_eye_dome(view.eye_dome.value_or(description.eye_dome));
    if (scene.is_gallery) {
        return;
    }
    auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    const std::optional<double> grain = view.grain ? view.grain : description.grain;
    terrain.grain = static_cast<float>(grain.value_or(view.default_grain));
    scene.usual_grain = grain ? std::nullopt : std::optional(view.default_grain);
    follow_ramp(scene);
    const double contours = view.contours.value_or(description.contours);
    terrain.contours = contours > 0.0 ? std::max(contours, scene::min_contours) : 0.0;
    terrain.labels_contours = view.contour_labels.value_or(description.contour_labels);
}

} // namespace reljef::session
