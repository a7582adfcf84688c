#include "engine/render/mesh_painter.h"

#include <algorithm>
#include <limits>

#include <glm/matrix.hpp>

#include "engine/render/relief_options.h"
#include "engine/scene/texture_plane.h"

namespace reljef::render {
namespace {

std::uint32_t look_features(scene::TechniqueId id) {
    switch (id) {
    case scene::TechniqueId::bump:
        return feature_bump;
    case scene::TechniqueId::emboss:
        return feature_emboss;
    case scene::TechniqueId::normal:
    case scene::TechniqueId::displacement:
        return feature_normal_map;
    case scene::TechniqueId::prewarp:
        return feature_normal_map | feature_warped;
    default:
        return 0U;
    }
}

bool looks_for_surface(scene::TechniqueId id) {
    return scene::geometry_of(id) == scene::Geometry::box;
}

// Metres that a height of 1 lifts a point; the shaders divide by it.
float lift_of(const MeshDraw& draw) {
    const double lift = scene::relief_height(*draw.mesh->mesh, draw.mesh->material.detail);
    return std::max(static_cast<float>(lift), std::numeric_limits<float>::min());
}

// Of the heights in [0,1] as they are seen: where the mesh lies.
float mesh_height(const MeshDraw& draw) {
    const float offset = draw.mesh->material.detail.offset;
    return draw.from_behind ? 1.0F + offset : -offset;
}

// The mesh is the reference plane of parallax.
scene::Technique on_mesh(const MeshDraw& draw) {
    scene::Technique technique = draw.mesh->material.technique;
    if (is_parallax(technique.id)) {
        technique.values.front() = -static_cast<double>(mesh_height(draw));
    }
    return technique;
}

void bind_tile(gl::Program& program, const ResidentTile& tile, const ResidentSurface& surface) {
    tile.color.bind(0);
    surface.heights.bind(1);
    if (surface.greatest) {
        surface.greatest->bind(2);
        program.set_uniform("top_level", surface.greatest->levels() - 1);
    }
    tile.normals.bind(4);
    if (surface.normals) {
        surface.normals->along_u.bind(4);
        surface.normals->along_v.bind(5);
    }
    if (surface.cones) {
        surface.cones->bind(6);
    }
    program.set_uniform("height_texel", 1.0F / glm::vec2(surface.heights.size()));
    program.set_uniform("last_cell", surface.cells - 1);
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
    return looks_for_surface(material.technique.id)
               ? ShaderVariant{ShaderKind::relief_mesh,
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
    program.set_uniform("lift", lift_of(draw));
    program.set_uniform("mesh_height", mesh_height(draw));
    program.set_uniform("side", draw.from_behind ? -1.0F : 1.0F);
    program.set_uniform("bounded", detail.border == terrain::TileBorder::discard ? 1.0F : 0.0F);
    program.set_uniform("normal_scale", detail.set->scale);
    program.set_uniform("shine", glm::vec2(detail.set->specular, detail.set->shininess));
    set_relief_options(program, on_mesh(draw), static_cast<double>(mesh_height(draw)));
}

} // namespace reljef::render
