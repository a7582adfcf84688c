// The title of the window.
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "app/viewer/panels/panel_text.h"
#include "app/viewer/viewer.h"
#include "engine/geo/place.h"
#include "engine/session/ground.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::app {
namespace {

constexpr double heading_length = 100.0; // metres ahead that define the heading

/// Heading in degrees clockwise from true north, [0, 360): the forward direction, or the up
/// direction of a steep view. Empty outside the map's domain.
std::optional<double> heading_at(const terrain::Placement& placement, const scene::Camera& camera) {
    const scene::ViewAxes axes = scene::view_axes(camera);
    const glm::dvec3 up = placement.up(camera.eye);
    const bool steep = std::abs(glm::dot(axes.forward, up)) > std::abs(glm::dot(axes.up, up));
    const glm::dvec3 ahead = camera.eye + heading_length * (steep ? axes.up : axes.forward);
    const auto from = placement.geodetic_from_world(camera.eye);
    const auto to = placement.geodetic_from_world(ahead);
    if (!from || !to) {
        return std::nullopt;
    }
    const geo::Geodesic way = geo::geodesic_between(*from, *to);
    return std::fmod(std::round(way.azimuth_start) + 360.0, 360.0);
}

std::string place_on_earth(const scene::TerrainSurface& surface, const scene::Camera& camera) {
    if (!surface.heightfield().georeference) {
        return {};
    }
    const auto place = surface.placement().geodetic_from_world(camera.eye);
    if (!place) {
        return " - beside the map of the Earth";
    }
    const auto heading = heading_at(surface.placement(), camera);
    return fmt::format(" - {} above sea - {:.5f}, {:.5f} - {}{}", length_text(place->height),
                       place->latitude, place->longitude, geo::mgrs_text(*place),
                       heading ? fmt::format(" - heading {:.0f}\u00b0", *heading) : "");
}

/// What the title says of a frame that shows triangles for a technique, or may be farther off than
/// its error bound.
std::string error_text(const view::FrameStats& stats, const scene::Technique& technique) {
    if (stats.reliefs_as_triangles > 0) {
        return " - triangles, rays are not precise here";
    }
    const double bound = technique.id() == scene::TechniqueId::exact
                             ? scene::max_expected_error_of_rays
                             : scene::error_bound(technique);
    if (bound > 0.0 && stats.tiles_unproven > 0) {
        return " - error unproven";
    }
    return stats.kept_error.value_or(0.0) > bound
               ? fmt::format(" - up to {:.1f} px off", *stats.kept_error)
               : std::string();
}

} // namespace

std::optional<double> Viewer::heading() const {
    const auto& surface = *scene_.terrain->get<scene::TerrainNode>()->surface;
    if (surface.heightfield().georeference) {
        return heading_at(surface.placement(), camera());
    }
    const scene::ViewAxes axes = scene::view_axes(camera());
    const glm::dvec3 ahead =
        std::abs(axes.forward.z) > std::abs(axes.up.z) ? axes.up : axes.forward;
    return std::fmod(glm::degrees(std::atan2(ahead.x, ahead.y)) + 360.0, 360.0);
}

std::string Viewer::title(const view::FrameStats& stats, const FrameTiming& timing) const {
    const auto& surface = *scene_.terrain->get<scene::TerrainNode>()->surface;
    const std::string rate = timing.frames_per_second
                                 ? fmt::format("{:.1f} fps", *timing.frames_per_second)
                                 : std::string("still");
    const auto preparing = progress();
    const std::string progress =
        preparing.label.empty()
            ? std::string()
            : fmt::format(" ({} {:.0f} %)", preparing.label, 100.0 * preparing.fraction);
    const std::string resolution =
        timing.divisor > 1 ? fmt::format(", 1/{} of the resolution", timing.divisor) : "";
    const std::string work = stats.rays > 0 ? fmt::format("{} rays", stats.rays)
                                            : fmt::format("{} triangles", stats.triangles);
    return fmt::format("reljef - {} - {}{}{} - {} ({:.1f} ms{}) - {} - {}", surface.terrain().name,
                       scene::to_string(material().technique), progress,
                       error_text(stats, material().technique), rate, timing.last_ms, resolution,
                       work, place());
}

std::string Viewer::place() const {
    const auto& terrain = *scene_.terrain->get<scene::TerrainNode>();
    const scene::TerrainSurface& surface = *terrain.surface;
    const glm::dvec3 eye = camera().eye;
    std::string text;
    if (map_) {
        text = "map, " + length_text(camera().view_height) + " high";
    } else if (const auto height = session::height_above_ground(terrain, eye)) {
        text = length_text(*height) + " above ground";
    } else {
        text = "beside the terrain";
    }
    text += place_on_earth(surface, camera());
    if (const auto scale = session::metres_per_pixel(terrain, camera(), size_.y)) {
        text += fmt::format(" - {} a pixel", length_text(*scale));
    }
    return text + fmt::format(" - speed {}/s", length_text(flight_.speed()));
}

} // namespace reljef::app
