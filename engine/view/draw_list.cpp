#include "engine/view/draw_list.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/scene/graph/picture_detail.h"
#include "engine/view/error_view.h"

namespace reljef::view {
namespace {

// Of the error bound: silhouettes of levels change rarely, but all at once.
constexpr double mesh_share = 0.25;
// Of triangles that are shaded otherwise than the mesh: too small to show it.
constexpr double max_shaded_pixels = 3.0;
// Of a picture that repeats: each pixel then shows the mean of two repeats or more, which is one
// texel of its mip levels.
constexpr double max_repeat_pixels = 0.5;

// Squared metres to the nearest point of a box.
double squared_distance(glm::dvec3 place, const Box& box) {
    const glm::dvec3 way = place - glm::clamp(place, box.low, box.high);
    return glm::dot(way, way);
}

// Near the eye, all lights count as a metre away.
double brightness_at(glm::dvec3 eye, const scene::PlacedPointLight& light) {
    const glm::dvec3 way = light.place - eye;
    const double luminance = glm::dot(light.light.color, glm::vec3(0.2126F, 0.7152F, 0.0722F));
    return luminance * light.light.intensity / std::max(glm::dot(way, way), 1.0);
}

// The box by which a level is chosen, local metres.
const Box& choosing_bounds(const scene::MeshLevel& level, const MeshDraw& draw) {
    return level.together.empty() ? draw.local_bounds : level.together;
}

bool shows_picture(const scene::MeshLevel& level, const MeshDraw& draw, const PictureError& seen) {
    const scene::SurfaceDetail& detail = draw.mesh->material.detail;
    if (!level.repeat) {
        return detail.set == nullptr;
    }
    return (detail.set == nullptr || scene::is_picture(detail)) &&
           seen.of_any_direction(choosing_bounds(level, draw), *level.repeat) <= max_repeat_pixels;
}

} // namespace

const std::shared_ptr<const scene::Mesh>& drawn_mesh(const MeshDraw& draw) {
    return draw.level == 0 ? draw.mesh->mesh : (*draw.mesh->levels)[draw.level - 1].mesh;
}

MeshDraw with_level(MeshDraw draw, const DrawList& list, double max_error) {
    const scene::MeshNode& mesh = *draw.mesh;
    if (mesh.levels == nullptr || !(max_error > 0.0)) {
        return draw;
    }
    const BoundLeft left = left_of_bound(list.camera, list.size, std::max(max_error, min_error));
    if (left.exceeded_by_rounding) {
        return draw;
    }
    const PictureError seen(list.camera, list.size, draw.world_from_local);
    for (std::size_t level = mesh.levels->size(); level > 0; --level) {
        const scene::MeshLevel& coarser = (*mesh.levels)[level - 1];
        const Box& bounds = choosing_bounds(coarser, draw);
        // The corners of triangles beside the picture are rounded more than what is seen.
        const double of_corners = left.of_operations * (seen.depth_ratio(bounds) - 1.0);
        const double error = of_corners + seen.of_any_direction(bounds, coarser.error);
        const double shaded = seen.of_any_direction(bounds, coarser.shaded_width);
        if (error <= mesh_share * left.error && shaded <= max_shaded_pixels &&
            shows_picture(coarser, draw, seen)) {
            draw.level = level;
            draw.error = error + left.vertex_rounding + rasterizer_error;
            break;
        }
    }
    return draw;
}

std::vector<const TerrainDraw*> searched_terrains(const DrawList& list) {
    std::vector<const TerrainDraw*> searched;
    for (const TerrainDraw& draw : list.terrains) {
        if (draw.search) {
            searched.push_back(&draw);
        }
    }
    std::stable_sort(searched.begin(), searched.end(),
                     [](const TerrainDraw* a, const TerrainDraw* b) {
                         return a->search->distance < b->search->distance;
                     });
    return searched;
}

Result<void> check_techniques(const DrawList& list) {
    Result<void> checked;
    for (const TerrainDraw& draw : list.terrains) {
        if (checked) {
            checked =
                scene::check_technique(draw.terrain->material.technique, *draw.terrain->surface);
        }
    }
    for (const MeshDraw& draw : list.meshes) {
        if (checked) {
            checked = scene::check_technique(draw.mesh->material.technique, *draw.mesh);
        }
    }
    return checked;
}

std::optional<scene::TerrainLight> light_on(const DrawList& list,
                                            const glm::dmat4& world_from_local) {
    if (!list.sun) {
        return std::nullopt;
    }
    return scene::TerrainLight{*list.sun, glm::dmat3(world_from_local)};
}

std::vector<scene::PlacedPointLight> seen_point_lights(std::vector<scene::PlacedPointLight> lights,
                                                       const scene::Camera& camera,
                                                       const Frustum& frustum,
                                                       FrameStats::Skipped& skipped) {
    std::erase_if(lights, [&](const scene::PlacedPointLight& light) {
        const glm::dvec3 range(light.light.range);
        const bool is_everywhere = std::isinf(light.light.range);
        return !(light.light.range > 0.0F) ||
               (!is_everywhere && !frustum.may_see({light.place - range, light.place + range}));
    });
    std::stable_sort(lights.begin(), lights.end(), [&](const auto& one, const auto& other) {
        return brightness_at(camera.eye, one) > brightness_at(camera.eye, other);
    });
    if (lights.size() > scene::max_shown_point_lights) {
        skipped.point_lights = static_cast<int>(lights.size() - scene::max_shown_point_lights);
        lights.resize(scene::max_shown_point_lights);
    }
    return lights;
}

bool is_reached(const DrawList& list, const Box& box) {
    return std::any_of(list.point_lights.begin(), list.point_lights.end(), [&](const auto& light) {
        const double range = light.light.range;
        return squared_distance(light.place, box) < range * range;
    });
}

bool needs_ground(const DrawList& list, const TileDraw& draw) {
    return draw.terrain->material.shader != nullptr ||
           (!list.point_lights.empty() &&
            is_reached(list, transformed(list.world_from_local(draw), draw.tile->bounds)));
}

bool needs_ground(const DrawList& list, const TerrainDraw& draw) {
    return draw.terrain->material.shader != nullptr ||
           (!list.point_lights.empty() &&
            is_reached(list, transformed(draw.world_from_local, draw.terrain->surface->bounds())));
}

bool has_surface_shader(const DrawList& list) {
    return std::ranges::any_of(
               list.terrains,
               [](const auto& draw) { return draw.terrain->material.shader != nullptr; }) ||
           std::ranges::any_of(
               list.meshes, [](const auto& draw) { return draw.mesh->material.shader != nullptr; });
}

glm::vec2 seen_height_pixels(const scene::TerrainNode& terrain) {
    const double error = scene::error_bound(terrain.material.technique);
    return glm::vec2(1.0, 2.0) * static_cast<float>(error > 0.0 ? error : 1.0);
}

double contour_scale(const scene::Camera& camera, glm::ivec2 size) {
    constexpr double rows = 768.0;
    return std::max(1.0, scene::whole_picture(camera, size).y / rows);
}

glm::vec2 dither_origin(const scene::Camera& camera, glm::ivec2 size) {
    constexpr int repeat = 64; // of the pattern, pixels
    const int height = scene::whole_picture(camera, size).y;
    const glm::ivec2 corner(camera.first.x, height - camera.first.y - size.y);
    return glm::vec2((corner % repeat + repeat) % repeat);
}

bool has_detail(const scene::TerrainNode& terrain) {
    return terrain.detail != nullptr &&
           terrain.material.technique.id() == scene::TechniqueId::polygons;
}

DetailLevel seen_detail(const scene::TerrainNode& terrain, const scene::Camera& camera,
                        glm::ivec2 size, double distance) {
    if (!has_detail(terrain)) {
        return DetailLevel::none;
    }
    const scene::TerrainDetail& detail = *terrain.detail;
    const glm::dvec2 metres(scene::metres_a_pixel(camera, size));
    const double pixel = metres.x + metres.y * distance;
    const auto is_seen = [&](double size_on_ground, float min_pixels) {
        return size_on_ground > static_cast<double>(min_pixels) * pixel;
    };
    if (!is_seen(detail.width, seen_tile_pixels.x)) {
        return DetailLevel::none;
    }
    const double lift = static_cast<double>(detail.scale) * detail.width;
    return scene::searches_surface(detail.technique.id()) &&
                   is_seen(lift, seen_height_pixels(terrain).x)
               ? DetailLevel::relief
               : DetailLevel::light;
}

} // namespace reljef::view
