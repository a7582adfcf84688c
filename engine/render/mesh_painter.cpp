#include "engine/render/mesh_painter.h"

#include <glm/matrix.hpp>

#include "engine/render/relief_options.h"
#include "engine/render/tile_painter.h"
#include "engine/scene/texture_plane.h"

namespace reljef::render {
namespace {

// Of the heights in [0,1] as they are seen: where the mesh lies.
float mesh_height(const MeshDraw& draw) {
    const float offset = draw.mesh->material.detail.offset;
    return draw.from_behind ? 1.0F + offset : -offset;
}

// From the tile's coordinates over the mesh to the warp's own, which go from 0 to 1 over it.
void bind_warp(gl::Program& program, const MeshDraw& draw, const gl::Texture2D& warp) {
    warp.bind(6);
    const auto plane = scene::texture_plane(*draw.mesh->mesh);
    const glm::dvec2 size = plane->high - plane->low;
    const glm::dvec2 per_tile = 1.0 / (size * glm::dvec2(draw.mesh->material.detail.repeats));
    program.set_uniform("warp_from_tile", glm::vec4(per_tile, -plane->low / size));
}

} // namespace

ShaderVariant mesh_variant(const scene::Material& material, std::uint32_t features) {
    if (material.detail.set == nullptr) {
        return {ShaderKind::mesh, features};
    }
    const bool wraps = scene::shown_detail(material).border == terrain::TileBorder::wrap;
    features |= wraps ? feature_wrap : 0U;
    const bool in_hull = material.technique.options.true_silhouettes;
    return looks_for_surface(material.technique.id)
               ? ShaderVariant{in_hull ? ShaderKind::relief_hull : ShaderKind::relief_mesh,
                               features | relief_features(material.technique)}
               : ShaderVariant{ShaderKind::textured_mesh,
                               features | look_features(material.technique.id)};
}

void set_tile(gl::Program& program, const MeshDraw& draw, const MeshResidency& residency,
              const scene::Camera& camera) {
    const scene::TextureDetail detail = scene::shown_detail(draw.mesh->material);
    bind_tile(program, residency.tile(draw), residency.surface(draw));
    if (const gl::Texture2D* const warp = residency.warp(draw)) {
        bind_warp(program, draw, *warp);
    }
    const bool is_perspective = camera.projection == scene::ProjectionKind::perspective;
    const glm::dmat3 local_from_world = glm::inverse(glm::dmat3(draw.world_from_local));
    program.set_uniform("local_from_relative", glm::mat3(local_from_world));
    program.set_uniform("perspective", is_perspective ? 1.0F : 0.0F);
    program.set_uniform("near_depth", static_cast<float>(camera.near));
    program.set_uniform("repeats", detail.repeats);
    set_tile_look(program, *detail.set,
                  static_cast<float>(scene::relief_height(*draw.mesh->mesh, detail)),
                  mesh_height(draw));
    program.set_uniform("side", draw.from_behind ? -1.0F : 1.0F);
    program.set_uniform("bounded", detail.border == terrain::TileBorder::discard ? 1.0F : 0.0F);
    set_relief_options(program, over_mesh(draw.mesh->material.technique, mesh_height(draw)),
                       static_cast<double>(mesh_height(draw)));
}

} // namespace reljef::render
