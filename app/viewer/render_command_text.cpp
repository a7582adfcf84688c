#include "app/viewer/render_command_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "app/objects/footprints_option.h"
#include "app/objects/light_option.h"
#include "app/objects/object_option.h"
#include "app/objects/point_light_option.h"
#include "app/objects/surface_shader_option.h"

namespace reljef::app {
namespace {

class CommandText {
public:
    explicit CommandText(std::string text) : text_(std::move(text)) {}

    CommandText& add(std::string_view option) {
        text_ += fmt::format(" {}", option);
        return *this;
    }
    CommandText& add(std::string_view option, std::string_view value) {
        text_ += fmt::format(" {} {}", option, shell_word(value));
        return *this;
    }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::string text_;
};

std::string point_text(glm::dvec3 point) {
    return fmt::format("{},{},{}", point.x, point.y, point.z);
}

void add_source(CommandText& command, const session::SourceOptions& source) {
    for (const auto& file : source.imagery) {
        command.add("--imagery", file.string());
    }
    if (source.buildings) {
        command.add(
            "--buildings",
            std::string(building::city_form_names[static_cast<std::size_t>(*source.buildings)]));
    }
    if (source.walls) {
        command.add(
            "--walls",
            std::string(building::city_wall_names[static_cast<std::size_t>(*source.walls)]));
    }
    if (source.textures) {
        command.add("--textures", *source.textures);
    }
    if (const auto& area = source.area) {
        command.add("--area",
                    fmt::format("{},{},{},{}", area->south, area->west, area->north, area->east));
    }
    if (source.gaps) {
        command.add("--gaps", *source.gaps == io::Gaps::sea ? "sea" : "holes");
    }
    if (!source.geoid.empty()) {
        command.add("--geoid", source.geoid);
    }
    if (source.allow_external) {
        command.add("--allow-external");
    }
    const session::SourceOptions usual;
    if (source.memory_megabytes != usual.memory_megabytes) {
        command.add("--memory", fmt::format("{}", source.memory_megabytes));
    }
    if (source.index == session::IndexUse::none) {
        command.add("--no-index");
    }
}

void add_detail(CommandText& command, const session::SceneOptions& options) {
    if (const auto& detail = options.detail) {
        std::string numbers;
        if (detail->width) {
            numbers += fmt::format(",width={}", *detail->width);
        }
        if (detail->scale) {
            numbers += fmt::format(",scale={}", *detail->scale);
        }
        std::replace(numbers.begin(), numbers.begin() + (numbers.empty() ? 0 : 1), ',', ':');
        command.add("--detail", detail->textures + numbers);
    }
    if (options.detail_technique) {
        command.add("--detail-technique", scene::to_string(*options.detail_technique));
    }
}

void add_surroundings(CommandText& command, const session::TerrainScene& scene,
                      const StartOptions& start, const ShownState& shown) {
    if (!shown.ramp.empty()) {
        command.add("--ramp", shown.ramp);
    } else if (start.source.ramp) {
        command.add("--ramp", *start.source.ramp);
    }
    const auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    if (terrain.surface->imagery_share() < 1.0) {
        command.add("--imagery-share", fmt::format("{}", terrain.surface->imagery_share()));
    }
    command.add("--turbidity", fmt::format("{}", scene.surroundings.turbidity));
    if (scene.surroundings.visibility) {
        command.add("--visibility", fmt::format("{}", *scene.surroundings.visibility));
    }
    if (start.scene.sky) {
        command.add("--sky", start.scene.sky->string());
    }
    if (start.scene.sky_turn) {
        command.add("--sky-turn", fmt::format("{}", *start.scene.sky_turn));
    }
    if (start.scene.base) {
        command.add("--base", session::to_string(*start.scene.base));
    }
    command.add("--grain", fmt::format("{}", terrain.grain));
    if (terrain.contours > 0.0) {
        command.add("--contours", fmt::format("{}", terrain.contours));
        if (!terrain.labels_contours) {
            command.add("--contour-labels", "off");
        }
    }
    if (scene.scene.eye_dome() > 0.0) {
        command.add("--eye-dome", fmt::format("{}", scene.scene.eye_dome()));
    }
    if (start.scene.hides_sky) {
        command.add("--occlusion", *start.scene.hides_sky ? "on" : "off");
    }
}

// Heading and pitch, degrees, with which scene::camera_from_angles gives the view back.
glm::dvec2 angles_of(const scene::Camera& camera, const terrain::Placement& placement) {
    const glm::dvec3 up = placement.up(camera.eye);
    const glm::dvec3 north = placement.north(camera.eye);
    const glm::dvec3 east = glm::cross(north, up);
    const scene::ViewAxes axes = scene::view_axes(camera);
    const double rise = std::clamp(glm::dot(axes.forward, up), -1.0, 1.0);
    const double pitch = glm::degrees(std::asin(rise));
    const double heading =
        glm::degrees(std::atan2(glm::dot(axes.forward, east), glm::dot(axes.forward, north)));
    return {heading, pitch};
}

void add_camera(CommandText& command, const session::TerrainScene& scene) {
    const auto& camera = *scene.camera->get<scene::Camera>();
    const auto& placement = scene.terrain->get<scene::TerrainNode>()->surface->placement();
    command.add("--fov", fmt::format("{}", camera.vertical_fov));
    if (camera.projection == scene::ProjectionKind::orthographic) {
        const glm::dvec3 forward = scene::view_axes(camera).forward;
        const double distance =
            0.5 * camera.view_height / std::tan(0.5 * glm::radians(camera.vertical_fov));
        command.add("--projection", "orthographic")
            .add("--eye=" + point_text(camera.target - distance * forward))
            .add("--look=" + point_text(camera.target));
        return;
    }
    const auto eye = placement.geodetic_from_world(camera.eye);
    if (placement.kind() == terrain::PlacementKind::plane || !eye) { // z is up
        command.add("--eye=" + point_text(camera.eye)).add("--look=" + point_text(camera.target));
        return;
    }
    const glm::dvec2 angles = angles_of(camera, placement);
    command.add(fmt::format("--camera={},{},{},{},{}", eye->latitude, eye->longitude, eye->height,
                            angles.x, angles.y));
}

Result<void> add_technique(CommandText& command, const session::TerrainScene& scene,
                           const StartOptions& start, const ShownState& shown) {
    const auto materials = scene.materials();
    const bool is_one =
        std::all_of(materials.begin(), materials.end(), [&](const scene::Material* material) {
            return material->technique == materials.front()->technique;
        });
    if (shown.keeps_techniques && !scene.models.empty()) {
        if (start.scene.mixed) {
            command.add("--technique", "mixed");
        } else if (start.scene.technique) {
            command.add("--technique", scene::to_string(*start.scene.technique));
        }
        return {};
    }
    if (!is_one) {
        return Error{"the models have several techniques, one was expected: --technique draws all "
                     "models with one"};
    }
    command.add("--technique", scene::to_string(shown.technique));
    return {};
}

} // namespace

std::string shell_word(std::string_view text) {
    constexpr std::string_view plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%";
    if (!text.empty() && text.find_first_not_of(plain) == std::string_view::npos) {
        return std::string(text);
    }
    std::string quoted = "'";
    for (const char character : text) {
        quoted += character == '\'' ? std::string("'\\''") : std::string(1, character);
    }
    return quoted + "'";
}

Result<std::string> render_command(const StartOptions& start, const session::TerrainScene& scene,
                                   const ShownState& shown) {
    CommandText command("reljef render " + shell_word(start.source.terrain));
    add_source(command, start.source);
    const auto& placement = scene.terrain->get<scene::TerrainNode>()->surface->placement();
    if (scene.models.empty()) {
        const bool is_plane = placement.kind() == terrain::PlacementKind::plane;
        command.add("--placement", is_plane ? "plane" : "ellipsoid");
        command.add("--exaggeration", fmt::format("{}", shown.exaggeration));
    }
    if (auto added = add_technique(command, scene, start, shown); !added) {
        return added.error();
    }
    add_detail(command, start.scene);
    for (const io::ObjectDescription& object : start.scene.objects) {
        command.add("--object", to_text(object));
    }
    for (const io::FootprintsDescription& footprints : start.scene.footprints) {
        command.add("--footprints", to_text(footprints));
    }
    for (const io::LightDescription& light : start.scene.lights) {
        command.add("--light", to_text(light));
    }
    for (const io::PointLightDescription& light : start.scene.point_lights) {
        command.add("--point-light", to_text(light));
    }
    if (start.scene.surface_shader) {
        command.add("--surface-shader", to_text(*start.scene.surface_shader));
    }
    add_surroundings(command, scene, start, shown);
    if (scene.materials().front()->wireframe) {
        command.add("--wireframe");
    }
    command.add("--sun", fmt::format("{},{}", shown.light.azimuth, shown.light.altitude));
    add_camera(command, scene);
    if (start.allow_underground) {
        command.add("--allow-underground");
    }
    if (start.context) {
        command.add("--context", session::to_string(*start.context));
    }
    if (!start.simd.empty()) {
        command.add("--simd", start.simd);
    }
    if (shown.samples) {
        command.add("--samples", fmt::format("{}", *shown.samples));
    }
    if (!shown.compare.empty()) {
        command.add("--compare", shown.compare).add("--wipe", fmt::format("{:.3f}", shown.wipe));
    }
    command.add("--size", fmt::format("{}x{}", shown.size.x, shown.size.y));
    return command.add("-o", "view.png").text();
}

std::string copied_text(const std::string& command, const ShownState& shown) {
    return fmt::format("copied{}: {}\n",
                       shown.shows_viewshed
                           ? " without the colours of the viewshed, which render cannot draw"
                           : "",
                       command);
}

} // namespace reljef::app
