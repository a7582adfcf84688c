#include "engine/session/options.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <variant>

#include <fmt/format.h>

#include "engine/scene/graph/terrain_node.h"

namespace reljef::session {
namespace {

constexpr std::array all_backends{BackendKind::osmesa, BackendKind::egl, BackendKind::glfw,
                                  BackendKind::cpu};

} // namespace

std::optional<platform::ContextKind> context_of(BackendKind kind) {
    switch (kind) {
    case BackendKind::osmesa:
        return platform::ContextKind::osmesa;
    case BackendKind::egl:
        return platform::ContextKind::egl;
    case BackendKind::glfw:
        return platform::ContextKind::glfw;
    case BackendKind::cpu:
        break;
    }
    return std::nullopt;
}

std::string_view to_string(BackendKind kind) {
    const auto context = context_of(kind);
    return context ? platform::to_string(*context) : "cpu";
}

std::string_view to_string(BaseKind kind) {
    return kind == BaseKind::plane ? "plane" : kind == BaseKind::solid ? "solid" : "none";
}

std::optional<BackendKind> backend_from_string(std::string_view text) {
    const auto* const found =
        std::find_if(all_backends.begin(), all_backends.end(),
                     [&](BackendKind kind) { return to_string(kind) == text; });
    return found == all_backends.end() ? std::nullopt : std::optional(*found);
}

bool is_map(const SceneOptions& options) {
    const bool is_parallel = options.projection == scene::ProjectionKind::orthographic;
    if (options.geodetic) {
        return is_parallel && options.geodetic->pitch == -90.0;
    }
    if (options.eye && options.target) {
        return is_parallel && glm::dvec2(*options.eye) == glm::dvec2(*options.target);
    }
    return options.pose ? *options.pose == scene::Pose::map : is_parallel;
}

glm::dvec2 default_sun(const SceneOptions& options) {
    return is_map(options) ? glm::dvec2(315.0, 35.0) : glm::dvec2(300.0, 40.0);
}

scene::Technique technique_of(const SceneOptions& options) {
    scene::Technique technique = options.technique.value_or(scene::Technique{});
    auto* const polygons = std::get_if<scene::Polygons>(&technique.parameters);
    if (polygons != nullptr && !options.technique) {
        polygons->error = options.max_error.value_or(default_max_error);
    } else if (polygons != nullptr && options.max_error.value_or(0.0) > 0.0) {
        polygons->error = *options.max_error;
    }
    return technique;
}

bool names_error_bound(const SceneOptions& options) {
    return (options.technique || options.max_error) &&
           scene::error_bound(technique_of(options)) > 0.0;
}

Result<void> check(const SceneOptions& options) {
    if (options.eye && options.target && *options.eye == *options.target) {
        return usage_error("--look: the point of --eye found, another point was expected");
    }
    if (!options.technique) {
        return {};
    }
    const scene::Technique& technique = *options.technique;
    const bool draws_polygons = technique.id() == scene::TechniqueId::polygons;
    const std::string_view name = scene::technique_info(technique.id()).name;
    const bool is_bounded = options.max_error.value_or(0.0) > 0.0;
    if (is_bounded && !draws_polygons) {
        return usage_error(
            fmt::format("--max-error: technique {} found, polygons was expected", name));
    }
    if (options.detail && !draws_polygons) {
        return usage_error(fmt::format(
            "--detail: technique {} found, polygons was expected, which it lies on", name));
    }
    const scene::TechniqueParameters plain = scene::Polygons{};
    if (is_bounded && technique.parameters != plain) {
        return usage_error(
            fmt::format("--max-error: --technique {} found beside it, which says how coarse "
                        "triangles may be too; one of them was expected",
                        scene::to_string(technique)));
    }
    return {};
}

SourceOptions streamed_for(SourceOptions source, const SceneOptions& options) {
    source.streamed = source.streamed && scene::draws_tiles(technique_of(options));
    source.pictures_streamed = source.streamed && !names_error_bound(options);
    return source;
}

} // namespace reljef::session
