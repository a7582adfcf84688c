#include "engine/render/passes/beams.h"

#include <algorithm>
#include <utility>

#include "engine/render/shaders/bindings.h"
#include "engine/render/shaders/relief_options.h"
#include "engine/render/shaders/uniforms.h"
#include "engine/render/shaders/view_values.h"
#include "engine/view/relief_samples.h"

namespace reljef::render {

static_assert(bindings::pixels_a_beam == view::pixels_a_beam);

PictureRays picture_rays(const scene::Camera& camera, glm::ivec2 size, const ReliefSpace& space,
                         const glm::dmat4& local_from_world) {
    const glm::dmat3 turned = space.space_from_local * glm::dmat3(local_from_world);
    const auto ray_at = [&](glm::dvec2 pixel) {
        const Ray ray = scene::view_ray(camera, size, pixel);
        const glm::dvec3 local(local_from_world * glm::dvec4(ray.origin, 1.0));
        return Ray{space.space_from_local * local + space.space_of_origin, turned * ray.direction};
    };
    const glm::dvec2 extent(size);
    const Ray corner = ray_at({0.0, extent.y});
    const Ray right = ray_at(extent);
    const Ray top = ray_at({0.0, 0.0});
    const auto of_ray = [&](glm::dvec3 Ray::*part) {
        return glm::mat3(corner.*part, (right.*part - corner.*part) / extent.x,
                         (top.*part - corner.*part) / extent.y);
    };
    const double highest = space.box.high.z;
    return {
        of_ray(&Ray::origin), of_ray(&Ray::direction),
        static_cast<float>(is_perspective(camera) ? std::min(highest, corner.origin.z) : highest)};
}

bool needs_beams(const view::DrawList& list) {
    return std::any_of(list.terrains.begin(), list.terrains.end(),
                       [](const view::TerrainDraw& draw) {
                           return draw.search && has_beams(draw.search->technique);
                       });
}

Result<void> BeamTarget::prepare(const view::DrawList& list) {
    if (!needs_beams(list) || picture_size_ == list.size) {
        return {};
    }
    auto made = gl::Framebuffer::create(
        {.size = (list.size + bindings::pixels_a_beam - 1) / bindings::pixels_a_beam,
         .color = gl::Format::r32f,
         .second_color = counts_ ? std::optional(gl::Format::rg32f) : std::nullopt,
         .depth = false});
    if (!made) {
        return made.error();
    }
    framebuffer_ = std::move(*made);
    picture_size_ = list.size;
    return {};
}

void set_beams(gl::Program& program, const ReliefSpace& space, const PictureRays& rays) {
    program.set(uniforms.origin_of_ray, rays.origin_of_ray);
    program.set(uniforms.direction_of_ray, rays.direction_of_ray);
    program.set(uniforms.begin_height, rays.begin_height);
    program.set(uniforms.beam_lift, static_cast<float>(space.box.high.z - 1.0));
}

} // namespace reljef::render
