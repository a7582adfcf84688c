#include "engine/render/passes/frame_context.h"

#include <glm/matrix.hpp>

#include "engine/render/passes/tile_pass.h"
#include "engine/render/shaders/bindings.h"
#include "engine/render/shaders/relief_options.h"
#include "engine/render/shaders/surface_constants.h"
#include "engine/render/shaders/uniforms.h"
#include "engine/render/shaders/view_values.h"
#include "engine/scene/graph/mesh.h"
#include "engine/scene/graph/picture_detail.h"

namespace reljef::render {
namespace {

// The mesh's height among the visible heights in [0,1].
float mesh_height(const view::MeshDraw& draw) {
    const float offset = draw.mesh->material.detail.offset;
    return draw.from_behind ? 1.0F + offset : -offset;
}

// Maps the tile's coordinates on the mesh to the warp's, which go from 0 to 1.
void bind_warp(gl::Program& program, const view::MeshDraw& draw, const gl::Texture2D& warp) {
    warp.bind(bindings::warped_map_unit);
    const auto plane = scene::texture_plane(*view::drawn_mesh(draw));
    const glm::dvec2 size = plane->high - plane->low;
    const glm::dvec2 per_tile = 1.0 / (size * glm::dvec2(draw.mesh->material.detail.repeats));
    program.set(uniforms.warp_from_tile, glm::vec4(per_tile, -plane->low / size));
}

// Hits do not show the texels of a picture.
bool shows_tile(const scene::Material& material, const FrameContext& frame) {
    return material.detail.set != nullptr && !(frame.hits && scene::is_picture(material.detail));
}

ShaderVariant mesh_variant(const scene::Material& material, const FrameContext& frame,
                           ShaderFeatures more_features) {
    ShaderFeatures features = frame.features | more_features;
    if (!shows_tile(material, frame)) {
        return {ShaderKind::mesh, features};
    }
    const bool wraps = scene::visible_detail(material).border == material::WrapMode::wrap;
    features |= wraps ? feature_wrap : 0U;
    features |= technique_features(material.technique);
    if (!scene::searches_surface(material.technique.id())) {
        return {ShaderKind::textured_mesh, features};
    }
    const bool in_hull = material.technique.options.true_silhouettes;
    return {in_hull ? ShaderKind::relief_hull : ShaderKind::relief_mesh, features};
}

DetailBlock mesh_detail(const view::MeshDraw& draw, const MeshResidency& residency) {
    const scene::SurfaceDetail detail = scene::visible_detail(draw.mesh->material);
    const double lift = scene::relief_height(*view::drawn_mesh(draw), detail);
    DetailBlock block = detail_block(*detail.set, residency.surface(draw), static_cast<float>(lift),
                                     mesh_height(draw));
    const bool bounded = detail.border == material::WrapMode::discard;
    block.detail_heights.w = draw.from_behind ? -1.0F : 1.0F;
    block.detail_repeats = glm::vec4(detail.repeats, 0.0F, bounded ? 1.0F : 0.0F);
    return block;
}

// Sets the inputs of programs with surface detail, except the transform.
Result<void> set_tile(gl::Program& program, const view::MeshDraw& draw, const FrameContext& frame) {
    const MeshResidency& residency = frame.residency.meshes();
    bind_tile(program, residency.tile(draw), residency.surface(draw));
    if (const gl::Texture2D* const warp = residency.warp(draw)) {
        bind_warp(program, draw, *warp);
    }
    const glm::dmat3 local_from_world = glm::inverse(glm::dmat3(draw.world_from_local));
    program.set(uniforms.local_from_relative, glm::mat3(local_from_world));
    ++frame.state.stats().state_changes;
    if (auto set = frame.state.set(mesh_detail(draw, residency)); !set) {
        return set;
    }
    return frame.state.set(
        technique_block(over_mesh(draw.mesh->material.technique, mesh_height(draw)),
                        static_cast<double>(mesh_height(draw))));
}

void draw_hull(DrawState& state, gl::Program& program, const ResidentHull& hull) {
    if (hull.count == 0) {
        return;
    }
    program.set(uniforms.coordinate_range, hull.coordinate_range);
    constexpr int strip_vertices = 6; // relief_hull.vert
    hull.vertex_array.bind();
    gl::draw_arrays(gl::Primitive::triangle_strip, strip_vertices, hull.count);
    view::FrameStats& stats = state.stats();
    stats.triangles += 4U * static_cast<std::size_t>(hull.count);
    ++stats.draws;
    ++stats.state_changes;
}

Result<void> draw_mesh(const FrameContext& frame, const view::MeshDraw& draw,
                       ShaderFeatures more_features) {
    const scene::Material& material = draw.mesh->material;
    const scene::Camera& camera = frame.list.camera;
    const MeshResidency& residency = frame.residency.meshes();
    DrawState& state = frame.state;
    auto program = state.use(with_surface(mesh_variant(material, frame, more_features), material));
    if (!program) {
        return program.error();
    }
    set_surface(**program, material, camera);
    state.set_culling(draw.from_behind ? gl::Culling::front : gl::Culling::back);
    state.set_wireframe(material.wireframe);
    (*program)->set(uniforms.relative_from_local,
                    relative_from_local(camera, draw.world_from_local));
    (*program)->set(uniforms.world_from_normal, world_from_normal(draw.world_from_local));
    (*program)->set(uniforms.albedo, material.color);
    if ((more_features & feature_mesh_shadows) != 0) {
        (*program)->set(uniforms.ground_shadow_place,
                        frame.ground_shadow->place_on(frame.list, draw));
    }
    const bool has_tile = shows_tile(material, frame);
    if (has_tile) {
        if (auto set = set_tile(**program, draw, frame); !set) {
            return set;
        }
    }
    if (has_tile && material.technique.options.true_silhouettes) {
        draw_hull(state, **program, residency.hull(draw));
    } else {
        state.draw(residency.mesh(draw), gl::IndexType::uint32);
    }
    return {};
}

} // namespace

// The walls' depth is written: they hide meshes and the sky behind them.
Result<void> draw_bases(const FrameContext& frame) {
    if (frame.list.bases.empty() || frame.hits) {
        return {};
    }
    gl::set_depth_test(gl::DepthTest::always);
    Result<void> done;
    for (const view::MeshDraw& base : frame.list.bases) {
        done = done ? draw_mesh(frame, base, 0) : done;
    }
    gl::set_depth_test(gl::DepthTest::greater);
    frame.state.stats().state_changes += 2;
    return done;
}

Result<void> draw_meshes(const FrameContext& frame) {
    const ShaderFeatures points =
        frame.hits || frame.list.point_lights.empty() ? 0U : feature_point_lights;
    const ShaderFeatures more_features = points | frame.mesh_shadows;
    if (frame.mesh_shadows != 0) {
        frame.ground_shadow->bind();
    }
    for (const view::MeshDraw& draw : frame.list.meshes) {
        if (view::drawn_mesh(draw)->indices.empty()) {
            continue;
        }
        if (auto drawn = draw_mesh(frame, draw, more_features); !drawn) {
            return drawn;
        }
    }
    return {};
}

} // namespace reljef::render
