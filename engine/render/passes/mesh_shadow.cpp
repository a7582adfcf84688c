#include "engine/render/passes/mesh_shadow.h"

#include <algorithm>
#include <bit>
#include <iterator>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/render/shaders/uniform_blocks.h"
#include "engine/render/shaders/uniforms.h"

namespace reljef::render {
namespace {

constexpr int min_side = 1024; // texels of the square of all maps
constexpr int max_side_of_maps = 4096;
constexpr int texels_a_pixel = 4; // of the square, so two of a map

int side_of_maps(const view::DrawList& list, int max_side) {
    const glm::ivec2 whole = scene::whole_picture(list.camera, list.size);
    const int needed =
        std::clamp(texels_a_pixel * std::max(whole.x, whole.y), min_side, max_side_of_maps);
    return std::min(static_cast<int>(std::bit_ceil(static_cast<unsigned>(needed))), max_side);
}

glm::dmat4 clip_from_map() {
    return glm::scale(glm::translate(glm::dmat4(1.0), {-1.0, -1.0, 0.0}), {2.0, 2.0, 1.0});
}

bool is_in_map(const SunMap& map, const view::MeshDraw& draw, glm::dvec3 eye) {
    const glm::dmat4 map_from_world = map.map_from_relative * glm::translate(glm::dmat4(1.0), -eye);
    const Box box = transformed(map_from_world * draw.world_from_local, draw.local_bounds);
    return !box.empty() && box.high.x >= 0.0 && box.high.y >= 0.0 && box.low.x <= 1.0 &&
           box.low.y <= 1.0;
}

} // namespace

Result<void> MeshShadow::prepare(const view::DrawList& list, int max_side) {
    const int side = side_of_maps(list, max_side);
    maps_ = sun_maps(list, side / 2);
    if (!is_cast() || depth_.side() == side) {
        return {};
    }
    depth_ = {};
    auto made = gl::DepthMap::create(side);
    if (!made) {
        maps_.clear();
        return made.error();
    }
    depth_ = std::move(*made);
    return {};
}

std::vector<view::MeshDraw> MeshShadow::casters_beside(const view::DrawList& list) const {
    std::vector<view::MeshDraw> casters;
    std::ranges::copy_if(
        list.meshes_beside, std::back_inserter(casters), [&](const view::MeshDraw& draw) {
            return is_shadow_caster(draw) && std::ranges::any_of(maps_, [&](const SunMap& map) {
                       return is_in_map(map, draw, list.camera.eye);
                   });
        });
    return casters;
}

Result<void> MeshShadow::draw(const view::DrawList& list, const Residency& residency,
                              DrawState& state) const {
    auto program = state.use({ShaderKind::sun_depth});
    if (!program) {
        return program.error();
    }
    state.set_culling(gl::Culling::none); // faces hide the sun from both sides
    state.set_wireframe(false);
    depth_.clear();
    const std::vector<view::MeshDraw> casters = shadow_casters(list);
    const glm::dvec3 eye = list.camera.eye;
    const int side = depth_.side() / 2;
    for (std::size_t i = 0; i < maps_.size(); ++i) {
        depth_.bind(side * glm::ivec2(i & 1U, i >> 1U), side);
        const glm::dmat4 clip_from_world =
            clip_from_map() * maps_[i].map_from_relative * glm::translate(glm::dmat4(1.0), -eye);
        for (const view::MeshDraw& caster : casters) {
            if (is_in_map(maps_[i], caster, eye)) {
                (*program)->set(uniforms.sun_clip_from_local,
                                glm::mat4(clip_from_world * caster.world_from_local));
                state.draw(residency.meshes().mesh(caster), gl::IndexType::uint32);
            }
        }
    }
    return {};
}

Result<void> MeshShadow::bind(DrawState& state) const {
    if (is_cast()) {
        depth_.bind_texture(bindings::mesh_shadow_unit);
        ++state.stats().state_changes;
    }
    return state.set(mesh_shadow_block(maps_));
}

} // namespace reljef::render
