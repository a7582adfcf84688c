#include "engine/render/passes/frame_context.h"

#include <algorithm>
#include <span>

#include "engine/core/geometry.h"
#include "engine/render/passes/ground_pass.h"
#include "engine/render/passes/overlay_pass.h"
#include "engine/render/shaders/bindings.h"
#include "engine/render/shaders/surface_constants.h"
#include "engine/render/shaders/uniforms.h"
#include "engine/render/shaders/view_values.h"
#include "engine/view/triangles/tile_cut.h"

namespace reljef::render {
namespace {

bool is_warped(const scene::TerrainNode& terrain) {
    return terrain.material.technique.id() == scene::TechniqueId::prewarp;
}

// The remainder in zw.
glm::vec4 split_place(glm::dvec2 place) {
    const SplitPoint split = split_into_floats(glm::dvec3(place, 0.0));
    return {split.rounded.x, split.rounded.y, split.rest.x, split.rest.y};
}

// The sample of the terrain where a tile begins.
glm::dvec2 first_of(const view::TileSurface& surface) {
    return surface.placement.on_terrain(glm::dvec2(surface.samples.first));
}

void bind_ground(gl::Program& program, const ResidentGround& ground) {
    ground.albedo.bind(bindings::albedo_map_unit);
    ground.surface.bind(bindings::ground_map_unit);
    program.set(uniforms.ground_from_sample, ground.ground_from_sample);
}

enum class Part { wide, mild_slivers, narrow_slivers }; // view::Slivers

// For the light of points.
void bind_lit_ground(gl::Program& program, const ResidentGround& ground,
                     const glm::dmat4& world_from_local) {
    ground.albedo.bind(bindings::lit_albedo_unit);
    ground.surface.bind(bindings::lit_normals_unit);
    program.set(uniforms.world_from_normal, world_from_normal(world_from_local));
}

// Sets shared state once for successive tiles of a terrain.
class TerrainPass {
public:
    TerrainPass(const FrameContext& frame, Part part)
        : frame_(frame), state_(frame.state), part_(part) {
        state_.set_culling(gl::Culling::back);
        state_.set_adding(frame.counts());
    }

    // The tile with this index in the list.
    Result<void> draw(std::size_t index) {
        const view::TileDraw& draw = frame_.list.tiles[index];
        if (!has_part(index)) {
            return {};
        }
        const view::DetailLevel detail = shown(draw.detail);
        const glm::dmat4& world_from_local = frame_.list.world_from_local(draw);
        if (!is_set_for(draw, detail)) {
            if (auto set = set_for(draw, detail, world_from_local); !set) {
                return set;
            }
            if (draw.tile->borrows) {
                bind_shared_maps(*draw.terrain, world_from_local);
            }
        }
        if (!draw.tile->borrows) {
            bind_own_maps(draw);
        }
        set_place(draw, world_from_local);
        draw_meshes(index, draw);
        return {};
    }

private:
    // Hits are on the terrain itself, and details do not count.
    [[nodiscard]] view::DetailLevel shown(view::DetailLevel detail) const {
        return frame_.hits || frame_.counts() ? view::DetailLevel::none : detail;
    }

    [[nodiscard]] bool has_ground() const { return detail_ != view::DetailLevel::none; }
    [[nodiscard]] unsigned lit_unit() const {
        return has_ground() ? bindings::ground_lit_map_unit : bindings::lit_map_unit;
    }

    [[nodiscard]] unsigned sun_unit() const {
        return has_ground() ? bindings::ground_sun_map_unit : bindings::sun_map_unit;
    }

    [[nodiscard]] bool is_set_for(const view::TileDraw& draw, view::DetailLevel detail) const {
        return terrain_ == draw.terrain && detail_ == detail && overlay_ == overlay_of(draw) &&
               points_ == points_of(draw);
    }

    // Far tiles show no grain.
    [[nodiscard]] ShaderFeatures overlay_of(const view::TileDraw& draw) const {
        return overlay_features(frame_, *draw.terrain, draw.distance);
    }

    // Of ground and meshes.
    [[nodiscard]] bool has_shadows(const scene::TerrainNode& terrain) const {
        return frame_.ground_shadow != nullptr && !is_warped(terrain) &&
               frame_.ground_shadow->is_on(terrain);
    }

    [[nodiscard]] ShaderFeatures points_of(const view::TileDraw& draw) const {
        return point_light_features(frame_, draw);
    }

    Result<void> set_for(const view::TileDraw& draw, view::DetailLevel detail,
                         const glm::dmat4& world_from_local) {
        const scene::TerrainNode& terrain = *draw.terrain;
        overlay_ = overlay_of(draw);
        points_ = points_of(draw);
        auto program = state_.use(with_surface(variant_for(terrain, detail), terrain.material));
        if (!program) {
            return program.error();
        }
        program_ = *program;
        set_surface(*program_, terrain.material, frame_.list.camera);
        terrain_ = &terrain;
        detail_ = detail;
        state_.set_wireframe(terrain.material.wireframe);
        if (has_ground()) {
            return set_ground(*program_, frame_, terrain, world_from_local);
        }
        if (is_warped(terrain)) {
            frame_.residency.warped(terrain).bind(bindings::warped_places_unit);
            return {};
        }
        return overlay_ != 0 ? set_overlay(frame_, terrain, world_from_local) : Result<void>();
    }

    [[nodiscard]] ShaderVariant variant_for(const scene::TerrainNode& terrain,
                                            view::DetailLevel detail) const {
        const ShaderFeatures features = frame_.features | points_ |
                                        (has_shadows(terrain) ? feature_mesh_shadows : 0U) |
                                        (part_ != Part::wide ? feature_sliver : 0U) |
                                        (part_ == Part::narrow_slivers ? feature_corner_depth : 0U);
        if (detail != view::DetailLevel::none) {
            return ground_variant(*terrain.detail, detail, features);
        }
        return {ShaderKind::terrain, features | (is_warped(terrain) ? feature_warped : overlay_)};
    }

    // Of a terrain in memory.
    void bind_shared_maps(const scene::TerrainNode& terrain, const glm::dmat4& world_from_local) {
        if (frame_.hits) {
            return;
        }
        const ResidentMaps& maps = frame_.residency.maps(terrain);
        maps.lit.bind(lit_unit());
        if (has_shadows(terrain)) {
            maps.sun->bind(sun_unit());
        }
        program_->set(uniforms.lit_from_sample, maps.lit_from_sample);
        if (has_ground()) {
            bind_ground(*program_, frame_.residency.ground().ground(terrain));
        } else if (points_ != 0) {
            bind_lit_ground(*program_, frame_.residency.ground().ground(terrain), world_from_local);
        }
        ++state_.stats().state_changes;
    }

    void bind_own_maps(const view::TileDraw& draw) {
        if (frame_.hits) {
            return;
        }
        const ResidentTileMaps& maps = frame_.residency.tile_maps().tile(draw);
        maps.lit->bind(lit_unit());
        if (has_shadows(*draw.terrain)) {
            maps.sun->bind(sun_unit());
        }
        program_->set(uniforms.lit_from_sample, maps.lit_from_sample);
        if (has_ground()) {
            bind_ground(*program_, *maps.ground);
        } else if (points_ != 0) {
            bind_lit_ground(*program_, *maps.ground, frame_.list.world_from_local(draw));
        }
        ++state_.stats().state_changes;
    }

    void set_place(const view::TileDraw& draw, const glm::dmat4& world_from_local) {
        const SplitPoint eye = split_into_floats(local_eye(frame_.list.camera, world_from_local));
        program_->set(uniforms.eye, eye.rounded);
        program_->set(uniforms.eye_rest, eye.rest);
        program_->set(uniforms.world_from_local, glm::mat3(glm::dmat3(world_from_local)));
        program_->set(uniforms.tile_sample, first_sample(draw));
        if (has_shadows(*draw.terrain)) {
            program_->set(uniforms.shadow_from_sample,
                          frame_.ground_shadow->bind(draw, first_sample(draw)));
        }
        if (frame_.hits) {
            set_eye_sample(draw, world_from_local);
        }
    }

    // Hits are relative to the eye, because floats are precise near 0.
    void set_eye_sample(const view::TileDraw& draw, const glm::dmat4& world_from_local) {
        const view::TileSurface surface = view::surface_of(draw);
        const glm::dvec2 first = first_of(surface);
        const auto eye =
            surface.placement.sample_from_world(local_eye(frame_.list.camera, world_from_local));
        const glm::dvec2 origin = eye ? surface.placement.on_even_rows(glm::dvec2(*eye)) : first;
        program_->set(uniforms.eye_sample, split_place(origin));
        program_->set(uniforms.eye_in_tile, split_place(origin - first));
    }

    // What the shader adds to a vertex's place: own maps begin at the tile.
    [[nodiscard]] glm::vec2 first_sample(const view::TileDraw& draw) const {
        return draw.tile->borrows || frame_.hits ? glm::vec2(first_of(view::surface_of(draw)))
                                                 : glm::vec2(0.0F);
    }

    [[nodiscard]] std::span<const TileMesh> meshes(std::size_t index) const {
        return frame_.residency.terrain_meshes().tile(index);
    }

    // Of the part that is drawn.
    [[nodiscard]] std::size_t sliver_count(const TileMesh& mesh) const {
        return part_ == Part::narrow_slivers ? mesh.slivers.narrow.size()
                                             : mesh.slivers.mild.size();
    }

    [[nodiscard]] bool has_part(std::size_t index) const {
        const auto tile = meshes(index);
        return part_ == Part::wide ||
               std::any_of(tile.begin(), tile.end(),
                           [&](const TileMesh& mesh) { return sliver_count(mesh) > 0; });
    }

    void draw_meshes(std::size_t index, const view::TileDraw& draw) {
        if (part_ != Part::wide) {
            draw_slivers(index);
            return;
        }
        view::FrameStats& stats = state_.stats();
        std::size_t drawn = 0;
        for (const TileMesh& mesh : meshes(index)) {
            if (mesh.mesh.index_count > 0) {
                state_.draw(mesh.mesh, gl::IndexType::uint16);
            }
            drawn += static_cast<std::size_t>(mesh.mesh.index_count) / 3 +
                     mesh.slivers.mild.size() + mesh.slivers.narrow.size();
        }
        if (draw.coarse) {
            const glm::ivec2 cells = draw.tile->cells;
            const std::size_t all =
                2U * static_cast<std::size_t>(cells.x) * static_cast<std::size_t>(cells.y);
            stats.skipped.triangles_under_error += all - std::min(all, drawn);
        }
        ++stats.tiles;
    }

    void draw_slivers(std::size_t index) {
        for (const TileMesh& mesh : meshes(index)) {
            if (const std::size_t count = sliver_count(mesh); count > 0) {
                const ResidentMesh& corners =
                    part_ == Part::narrow_slivers ? mesh.narrow : mesh.mild;
                corners.vertices.bind_storage_block(bindings::corners_binding);
                state_.draw_slivers(corners, count);
            }
        }
    }

    const FrameContext& frame_;
    DrawState& state_;
    Part part_;
    gl::Program* program_ = nullptr;
    const scene::TerrainNode* terrain_ = nullptr; // of the program's state
    view::DetailLevel detail_ = view::DetailLevel::none;
    ShaderFeatures overlay_ = 0;
    ShaderFeatures points_ = 0;
};

} // namespace

Result<void> draw_terrain_tiles(const FrameContext& frame) {
    for (const Part part : {Part::wide, Part::mild_slivers, Part::narrow_slivers}) {
        TerrainPass pass(frame, part);
        for (std::size_t i = 0; i < frame.list.tiles.size(); ++i) {
            if (auto drawn = pass.draw(i); !drawn) {
                return drawn;
            }
        }
    }
    return {};
}

} // namespace reljef::render
