#include "engine/render/shaders/frame_block.h"

#include <type_traits>

#include "engine/render/shaders/view_values.h"
#include "engine/view/draw_list.h"
#include "engine/view/error_view.h"

namespace reljef::render {
namespace {

void set_rays(FrameBlock& block, const view::DrawList& list) {
    const auto direction_at = [&](glm::dvec2 pixel) {
        return scene::view_ray(list.camera, list.size, pixel).direction;
    };
    const glm::dvec2 extent(list.size);
    const glm::dvec3 corner = direction_at({0.0, extent.y});
    const glm::dvec3 right = direction_at(extent);
    const glm::dvec3 up = direction_at({0.0, 0.0});
    block.ray_corner = glm::vec4(glm::vec3(corner), 0.0F);
    block.ray_right = glm::vec4(glm::vec3(right - corner), 0.0F);
    block.ray_up = glm::vec4(glm::vec3(up - corner), 0.0F);
    block.ray_from_pixel = ray_from_pixel(list.camera, list.size);
    block.pixel_share =
        glm::vec4(1.0F / glm::vec2(list.size), view::dither_origin(list.camera, list.size));
}

} // namespace

FrameBlock frame_block(const view::DrawList& list) {
    FrameBlock block{};
    block.clip_from_relative = glm::mat4(scene::clip_from_view(list.camera, list.size) *
                                         scene::view_from_world_rotation(list.camera));
    block.view_forward = glm::vec4(glm::vec3(scene::view_axes(list.camera).forward), 0.0F);
    block.vertex_grid = glm::vec4(glm::vec2(list.size) * (0.5F * view::vertex_steps), 1.0F, 0.0F);
    block.projection =
        glm::vec4(is_perspective(list.camera) ? 1.0F : 0.0F, static_cast<float>(list.camera.near),
                  scene::metres_a_pixel(list.camera, list.size));
    set_rays(block, list);
    if (list.sun) {
        block.to_sun = glm::vec4(glm::vec3(scene::to_light(*list.sun)), 0.0F);
        block.sun_color = glm::vec4(list.sun->color, 0.0F);
        block.ambient_color = glm::vec4(list.sun->ambient, 0.0F);
    }
    if (list.sky) {
        const scene::Sky& sky = *list.sky;
        const scene::AirSeen air = scene::air_seen(sky, list.camera);
        block.sky_zenith = glm::vec4(sky.zenith, sky.curve);
        block.sky_horizon = glm::vec4(sky.horizon, air.plane_air);
        block.sky_glow = glm::vec4(sky.glow, air.eye_density);
        block.air = glm::vec4(air.extinction, air.per_height);
        block.sky_plane = glm::vec4(sky.plane.value_or(glm::vec3(0.0F)), air.eye_above);
        block.air_up = glm::vec4(air.up, air.bend);
    }
    return block;
}

PointLightBlock point_light_block(const view::DrawList& list) {
    static_assert(std::extent_v<decltype(PointLightBlock::point_light_places)> ==
                  scene::max_shown_point_lights);
    constexpr float nearest = scene::nearest_point_light;
    PointLightBlock block{};
    block.point_light_numbers = {list.point_lights.size(), nearest * nearest, 0.0F, 0.0F};
    for (std::size_t i = 0; i < list.point_lights.size(); ++i) {
        const auto& [light, place] = list.point_lights[i];
        block.point_light_places[i] =
            glm::vec4(glm::vec3(place - list.camera.eye), 1.0F / (light.range * light.range));
        block.point_light_colors[i] = glm::vec4(light.color * light.intensity, 0.0F);
    }
    return block;
}

} // namespace reljef::render
