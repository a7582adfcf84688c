#include "engine/render/driver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "engine/core/geometry.h"
#include "engine/gl/draw.h"
#include "engine/gl/read_pixels.h"
#include "engine/gl/state.h"
#include "engine/render/beams.h"
#include "engine/render/error_view.h"
#include "engine/render/frame_block.h"
#include "engine/render/ground_painter.h"
#include "engine/render/mesh_painter.h"
#include "engine/render/occlusion.h"
#include "engine/render/relief_options.h"
#include "engine/render/technique_support.h"

#include <glad/gl.h>

namespace reljef::render {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Relative to the eye: what remains is small enough for floats.
glm::mat4 relative_from(const scene::Camera& camera, const glm::dmat4& world_from_local,
                        glm::dvec3 local_origin) {
    glm::dmat4 relative = world_from_local;
    relative[3] = world_from_local * glm::dvec4(local_origin, 1.0);
    relative[3] -= glm::dvec4(camera.eye, 0.0);
    return glm::mat4(relative);
}

glm::mat3 world_from_normal(const glm::dmat4& world_from_local) {
    return glm::mat3(glm::inverseTranspose(glm::dmat3(world_from_local)));
}

// The view ray at depth 1 of a place on the picture, from gl_FragCoord.
glm::vec4 ray_from_pixel(const scene::Camera& camera, glm::dvec2 size) {
    const double half = std::tan(0.5 * glm::radians(camera.vertical_fov));
    const glm::dvec2 extent{half * size.x / size.y, half};
    return glm::vec4(glm::vec2(2.0 * extent / size), glm::vec2(-extent));
}

bool is_perspective(const DrawList& list) {
    return list.camera.projection == scene::ProjectionKind::perspective;
}

FrameBlock frame_block(const DrawList& list) {
    FrameBlock block{};
    block.clip_from_relative = glm::mat4(scene::clip_from_view(list.camera, list.size) *
                                         scene::view_from_world_rotation(list.camera));
    block.view_forward = glm::vec4(glm::vec3(scene::view_axes(list.camera).forward), 0.0F);
    block.vertex_grid = glm::vec4(glm::vec2(list.size) * (0.5F * vertex_steps), 0.0F, 0.0F);
    block.ray_from_pixel = ray_from_pixel(list.camera, glm::dvec2(list.size));
    if (list.sun) {
        block.to_sun = glm::vec4(glm::vec3(scene::to_light(*list.sun)), 0.0F);
        block.sun_color = glm::vec4(list.sun->color, 0.0F);
        block.ambient_color = glm::vec4(list.sun->ambient, 0.0F);
    }
    if (list.sky) {
        block.sky_zenith = glm::vec4(list.sky->zenith, 0.0F);
        block.sky_horizon =
            glm::vec4(list.sky->horizon, static_cast<float>(scene::extinction(*list.sky)));
    }
    return block;
}

std::uint32_t features_of(const DrawList& list, bool hits) {
    std::uint32_t features = hits ? feature_hit : 0U;
    features |= list.sun ? feature_lit : 0U;
    // A map is seen from no particular distance: no air.
    features |= is_perspective(list) && list.sky && list.sky->visibility > 0.0 ? feature_fog : 0U;
    return features;
}

struct Targets {
    const gl::Framebuffer& picture;
    const gl::Framebuffer& beams; // there where a technique has them
};

// Draws a list and counts what it sets; what is set already is not set again.
class Painter {
public:
    Painter(const DrawList& list, bool hits, const Targets& targets, ShaderLibrary& shaders,
            const Residency& residency, FrameStats& stats)
        : list_(list), features_(features_of(list, hits)), hits_(hits), targets_(targets),
          shaders_(shaders), residency_(residency), stats_(stats) {}

    Result<void> draw_tiles() {
        if (list_.tiles.empty()) {
            return {};
        }
        for (const TileDraw& draw : list_.tiles) {
            if (auto used =
                    use_for(*draw.terrain, shown_detail(draw.detail), draw.world_from_local);
                !used) {
                return used;
            }
            draw_tile(draw);
        }
        return {};
    }

    Result<void> draw_streamed_tiles() {
        if (list_.streamed_tiles.empty()) {
            return {};
        }
        tiles_of_ = nullptr;
        for (const StreamedDraw& draw : list_.streamed_tiles) {
            if (auto used =
                    use_for(*draw.terrain, shown_detail(draw.detail), draw.world_from_local);
                !used) {
                return used;
            }
            draw_streamed(draw);
        }
        return {};
    }

    Result<void> draw_reliefs(const gl::VertexArray& no_vertices) {
        if (list_.reliefs.empty()) {
            return {};
        }
        gl::set_culling(gl::Culling::front); // the box's far sides are seen from inside, too
        ++stats_.state_changes;
        for (const ReliefDraw& draw : list_.reliefs) {
            if (auto drawn = draw_relief(draw, no_vertices); !drawn) {
                return drawn;
            }
        }
        gl::set_culling(gl::Culling::back);
        ++stats_.state_changes;
        return {};
    }

    Result<void> draw_meshes() {
        std::optional<ShaderVariant> in_use;
        for (const MeshDraw& draw : list_.meshes) {
            if (draw.mesh->mesh->indices.empty()) {
                continue;
            }
            const scene::Material& material = draw.mesh->material;
            const ShaderVariant variant = mesh_variant(material, features_);
            if (in_use != variant) {
                if (auto used = use(variant); !used) {
                    return used;
                }
                in_use = variant;
            }
            set_side(draw.from_behind);
            draw_mesh(draw);
        }
        set_side(false);
        return {};
    }

    Result<void> draw_sky(const gl::VertexArray& no_vertices) {
        if (auto used = use({ShaderKind::sky, features_}); !used) {
            return used;
        }
        set_wireframe(false);
        gl::set_depth_writing(false);
        gl::set_depth_test(gl::DepthTest::greater_or_equal);
        const auto corner = scene::view_ray(list_.camera, list_.size, {0.0, list_.size.y});
        const auto right = scene::view_ray(list_.camera, list_.size, glm::dvec2(list_.size));
        const auto up = scene::view_ray(list_.camera, list_.size, {0.0, 0.0});
        program_->set_uniform("ray_corner", glm::vec4(glm::vec3(corner.direction), 0.0F));
        program_->set_uniform("ray_right",
                              glm::vec4(glm::vec3(right.direction - corner.direction), 0.0F));
        program_->set_uniform("ray_up",
                              glm::vec4(glm::vec3(up.direction - corner.direction), 0.0F));
        no_vertices.bind();
        gl::draw_arrays(gl::Primitive::triangles, 0, 3);
        gl::set_depth_writing(true);
        gl::set_depth_test(gl::DepthTest::greater);
        stats_.state_changes += 5;
        ++stats_.draws;
        return {};
    }

    void set_wireframe(bool wireframe) {
        if (wireframe != wireframe_) {
            gl::set_polygon_mode(wireframe ? gl::PolygonMode::line : gl::PolygonMode::fill);
            wireframe_ = wireframe;
            ++stats_.state_changes;
        }
    }

private:
    // Which side of what is drawn is left out.
    void set_side(bool from_behind) {
        if (from_behind != from_behind_) {
            gl::set_culling(from_behind ? gl::Culling::front : gl::Culling::back);
            from_behind_ = from_behind;
            ++stats_.state_changes;
        }
    }

    Result<void> use(ShaderVariant variant) {
        auto program = shaders_.program(variant);
        if (!program) {
            return program.error();
        }
        program_ = *program;
        program_->use();
        ++stats_.state_changes;
        return {};
    }

    // A hit is the terrain's own.
    [[nodiscard]] DetailLevel shown_detail(DetailLevel detail) const {
        return hits_ ? DetailLevel::none : detail;
    }

    // The program that draws the tiles of a terrain, if it is not in use.
    Result<void> use_for(const scene::TerrainNode& terrain, DetailLevel detail,
                         const glm::dmat4& world_from_local) {
        if (tiles_of_ == &terrain && detail == detail_) {
            return {};
        }
        const ShaderVariant variant = variant_for(terrain, detail);
        if (tiles_of_ == nullptr || variant != tiles_variant_) {
            if (auto used = use(variant); !used) {
                return used;
            }
            maps_of_ = nullptr;
        }
        if (detail != DetailLevel::none) {
            set_ground(*program_, terrain, world_from_local, list_.camera, list_.size,
                       residency_.ground().tiles());
            maps_of_ = nullptr; // other textures
        } else if (is_warped(terrain)) {
            residency_.warped(terrain).bind(4);
        }
        tiles_of_ = &terrain;
        tiles_variant_ = variant;
        detail_ = detail;
        return {};
    }

    [[nodiscard]] ShaderVariant variant_for(const scene::TerrainNode& terrain,
                                            DetailLevel detail) const {
        if (detail != DetailLevel::none) {
            return ground_variant(*terrain.detail, detail, features_);
        }
        return {ShaderKind::terrain, features_ | (is_warped(terrain) ? feature_warped : 0U)};
    }

    static bool is_warped(const scene::TerrainNode& terrain) {
        return terrain.material.technique.id == scene::TechniqueId::prewarp;
    }

    void bind_maps(const scene::TerrainNode& terrain) {
        if (hits_ || maps_of_ == &terrain) {
            return;
        }
        maps_of_ = &terrain;
        const ResidentMaps& maps = residency_.maps(terrain);
        const bool has_ground = tiles_of_ == &terrain && detail_ != DetailLevel::none;
        maps.lit.bind(has_ground ? 3 : 0);
        if (maps.sun) {
            maps.sun->bind(3);
        }
        program_->set_uniform("lit_from_sample", maps.lit_from_sample);
        if (has_ground) {
            bind_ground(residency_.ground().ground(terrain));
        }
        ++stats_.state_changes;
    }

    void bind_ground(const ResidentGround& ground) {
        ground.albedo.bind(7);
        ground.surface.bind(8);
        program_->set_uniform("ground_from_sample", ground.ground_from_sample);
    }

    void draw_tile(const TileDraw& draw) {
        const scene::TerrainSurface& surface = *draw.terrain->surface;
        const auto& tile = surface.tiles()[static_cast<std::size_t>(draw.tile)];
        bind_maps(*draw.terrain);
        set_wireframe(draw.terrain->material.wireframe);
        program_->set_uniform("tile_sample", glm::vec2(tile.col, tile.row));
        set_eye(draw.world_from_local);
        const std::size_t before = stats_.triangles;
        for (const ResidentMesh& mesh : residency_.tile(draw)) {
            draw_resident(mesh, gl::IndexType::uint16);
        }
        if (draw.coarse) {
            const std::size_t all =
                2U * static_cast<std::size_t>(tile.cols) * static_cast<std::size_t>(tile.rows);
            stats_.skipped.triangles_under_error += all - std::min(all, stats_.triangles - before);
        }
        ++stats_.tiles;
    }

    void draw_streamed(const StreamedDraw& draw) {
        const ResidentStreamed& resident = residency_.streamed().tile(draw);
        set_wireframe(draw.terrain->material.wireframe);
        if (hits_) {
            program_->set_uniform("tile_sample",
                                  glm::vec2(draw.terrain->stream->maker().first(draw.tile->id)));
        } else {
            const bool has_ground = detail_ != DetailLevel::none;
            resident.lit->bind(has_ground ? 3 : 0);
            program_->set_uniform("tile_sample", glm::vec2(0.0F));
            program_->set_uniform("lit_from_sample", resident.lit_from_sample);
            if (has_ground) {
                bind_ground(*resident.ground);
            }
        }
        set_eye(draw.world_from_local);
        draw_resident(resident.mesh, gl::IndexType::uint16);
        stats_.state_changes += hits_ ? 0 : 1;
        ++stats_.tiles;
    }

    void set_eye(const glm::dmat4& world_from_local) {
        const glm::dvec3 eye(glm::inverse(world_from_local) * glm::dvec4(list_.camera.eye, 1.0));
        const SplitPoint split = split_into_floats(eye);
        program_->set_uniform("eye", split.rounded);
        program_->set_uniform("eye_rest", split.rest);
        program_->set_uniform("world_from_local", glm::mat3(glm::dmat3(world_from_local)));
    }

    Result<void> draw_relief(const ReliefDraw& draw, const gl::VertexArray& no_vertices) {
        const scene::Technique& technique = draw.terrain->material.technique;
        no_vertices.bind();
        if (has_beams(technique)) {
            if (auto drawn = draw_beams(draw); !drawn) {
                return drawn;
            }
        }
        if (auto used = use({ShaderKind::relief, features_ | relief_features(technique)}); !used) {
            return used;
        }
        maps_of_ = nullptr; // another program
        tiles_of_ = nullptr;
        bind_maps(*draw.terrain);
        set_wireframe(draw.terrain->material.wireframe);
        set_relief(draw, residency_.relief(draw));
        constexpr int box_vertices = 14; // relief.vert
        gl::draw_arrays(gl::Primitive::triangle_strip, 0, box_vertices);
        stats_.triangles += box_vertices - 2;
        stats_.state_changes += 3;
        ++stats_.draws;
        ++stats_.tiles;
        return {};
    }

    // How far down the rays of each block of pixels meet nothing.
    Result<void> draw_beams(const ReliefDraw& draw) {
        if (auto used = use({ShaderKind::beams}); !used) {
            return used;
        }
        const ResidentRelief& relief = residency_.relief(draw);
        set_wireframe(false);
        set_beams(*program_, relief,
                  picture_rays(list_.camera, list_.size, relief.space,
                               glm::inverse(draw.world_from_local)));
        targets_.beams.bind();
        gl::draw_arrays(gl::Primitive::triangles, 0, 3);
        targets_.picture.bind();
        stats_.state_changes += 3;
        ++stats_.draws;
        return {};
    }

    void set_relief(const ReliefDraw& draw, const ResidentRelief& relief) {
        const ReliefSpace& space = relief.space;
        relief.heights.bind(1);
        if (relief.greatest) {
            relief.greatest->bind(2);
            program_->set_uniform("top_level", relief.greatest->levels() - 1);
        }
        if (relief.cones) {
            relief.cones->bind(4);
        }
        const glm::dmat4 local_from_world = glm::inverse(draw.world_from_local);
        const glm::dvec3 eye(local_from_world * glm::dvec4(list_.camera.eye, 1.0));
        const glm::ivec2 samples = relief.heights.size();
        program_->set_uniform("relative_from_local",
                              relative_from(list_.camera, draw.world_from_local, glm::dvec3(0.0)));
        program_->set_uniform("box_low", glm::vec3(space.local_box.low));
        program_->set_uniform("box_high", glm::vec3(space.local_box.high));
        program_->set_uniform("space_from_relative",
                              glm::mat3(space.space_from_local * glm::dmat3(local_from_world)));
        program_->set_uniform("eye_in_space",
                              glm::vec3(space.space_from_local * eye + space.space_of_origin));
        program_->set_uniform("box_begin", glm::vec3(space.box.low));
        program_->set_uniform("box_end", glm::vec3(space.box.high));
        program_->set_uniform("perspective", is_perspective(list_) ? 1.0F : 0.0F);
        program_->set_uniform("near_depth", static_cast<float>(list_.camera.near));
        program_->set_uniform("range_of_height", glm::vec2(space.lowest, space.range));
        program_->set_uniform("height_texel", 1.0F / glm::vec2(samples));
        program_->set_uniform("last_cell", samples - 2);
        program_->set_uniform("metres_per_unit", space.metres_per_unit);
        const scene::Technique& technique = draw.terrain->material.technique;
        if (has_beams(technique)) {
            targets_.beams.color().bind(5);
            program_->set_uniform("pixels_a_block", pixels_a_beam);
        }
        set_relief_options(*program_, technique, reference_height(technique));
        program_->set_uniform("texels_per_metre_away", texels_per_metre_away(draw, space));
    }

    // Texels of the lit map that a pixel facing the eye covers, a metre away.
    [[nodiscard]] float texels_per_metre_away(const ReliefDraw& draw,
                                              const ReliefSpace& space) const {
        if (hits_ || !is_perspective(list_)) {
            return 1e6F; // no limit
        }
        const ResidentMaps& maps = residency_.maps(*draw.terrain);
        const glm::vec2 texels_per_sample =
            glm::vec2(maps.lit_from_sample) * glm::vec2(maps.lit.size());
        const glm::vec2 texels_per_metre = texels_per_sample / glm::vec2(space.metres_per_unit);
        const glm::vec4 ray = ray_from_pixel(list_.camera, glm::dvec2(list_.size));
        return ray.x * std::max(texels_per_metre.x, texels_per_metre.y);
    }

    void draw_mesh(const MeshDraw& draw) {
        set_wireframe(draw.mesh->material.wireframe);
        program_->set_uniform("relative_from_local",
                              relative_from(list_.camera, draw.world_from_local, glm::dvec3(0.0)));
        program_->set_uniform("world_from_normal", world_from_normal(draw.world_from_local));
        program_->set_uniform("albedo", draw.mesh->material.color);
        if (draw.mesh->material.detail.set != nullptr) {
            set_tile(*program_, draw, residency_.meshes(), list_.camera);
            ++stats_.state_changes;
        }
        if (draw.mesh->material.detail.set != nullptr &&
            draw.mesh->material.technique.options.true_silhouettes) {
            draw_hull(residency_.meshes().hull(draw));
        } else {
            draw_resident(residency_.meshes().mesh(draw), gl::IndexType::uint32);
        }
    }

    void draw_hull(const ResidentHull& hull) {
        if (hull.count == 0) {
            return;
        }
        constexpr int strip_vertices = 6; // relief_hull.vert
        hull.vertex_array.bind();
        gl::draw_arrays(gl::Primitive::triangle_strip, 0, strip_vertices, hull.count);
        stats_.triangles += 4U * static_cast<std::size_t>(hull.count);
        ++stats_.draws;
        ++stats_.state_changes;
    }

    void draw_resident(const ResidentMesh& mesh, gl::IndexType type) {
        mesh.vertex_array.bind();
        gl::draw_elements({.type = type, .count = mesh.index_count});
        stats_.triangles += static_cast<std::size_t>(mesh.index_count) / 3;
        ++stats_.draws;
        ++stats_.state_changes;
    }

    const DrawList& list_;
    std::uint32_t features_;
    bool hits_;
    Targets targets_;
    ShaderLibrary& shaders_;
    const Residency& residency_;
    FrameStats& stats_;
    gl::Program* program_ = nullptr;
    const scene::TerrainNode* maps_of_ = nullptr;
    const scene::TerrainNode* tiles_of_ = nullptr;
    ShaderVariant tiles_variant_;
    DetailLevel detail_ = DetailLevel::none; // of the tiles that are drawn
    bool wireframe_ = false;
    bool from_behind_ = false;
};

glm::vec4 channels_of(const Hit& hit) {
    return {hit.col, hit.row, hit.height, hit.depth};
}

} // namespace

Driver::Driver(const DriverOptions& options, gl::Framebuffer target)
    : options_(options), limits_(gl::query_limits()), color_target_(std::move(target)),
      no_vertices_(gl::VertexArray::create()), shaders_(options.shader_dir) {}

Result<Driver> Driver::create(const DriverOptions& options) {
    auto target = gl::Framebuffer::create({.size = options.size});
    if (!target) {
        return target.error();
    }
    auto block = gl::Buffer::create_writable(sizeof(FrameBlock));
    if (!block) {
        return block.error();
    }
    Driver driver(options, std::move(*target));
    driver.frame_block_ = std::move(*block);
    return driver;
}

Result<void> Driver::resize(glm::ivec2 size) {
    auto target = gl::Framebuffer::create({.size = size});
    if (!target) {
        return target.error();
    }
    color_target_ = std::move(*target);
    hit_target_ = {};
    return {};
}

Result<FrameStats> Driver::draw(const scene::Scene& scene, bool wait) {
    const auto start = Clock::now();
    const DrawList list = list_of(scene);
    FrameStats stats = list.stats;
    if (auto done = prepare(list, false, stats); !done) {
        return done.error();
    }
    gl::TimerQuery timer = wait && !options_.software ? gl::TimerQuery::create() : gl::TimerQuery();
    if (timer.id() != 0U) {
        timer.begin();
    }
    const auto drawing = Clock::now();
    color_target_.bind();
    color_target_.clear_color(glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));
    if (auto done = draw_content(list, false, stats); !done) {
        return done.error();
    }
    if (timer.id() != 0U) {
        timer.end();
    }
    stats.cpu_ms = milliseconds_since(start);
    if (wait) {
        glFinish();
        const auto measured = timer.poll();
        stats.gpu_ms = measured ? std::chrono::duration<double, std::milli>(*measured).count()
                                : milliseconds_since(drawing);
    }
    return stats;
}

Result<HitBuffer> Driver::draw_hits(const scene::Scene& scene) {
    if (hit_target_.size() != size()) {
        auto target = gl::Framebuffer::create({.size = size(), .colors = {gl::Format::rgba32f}});
        if (!target) {
            return target.error();
        }
        hit_target_ = std::move(*target);
    }
    const DrawList list = list_of(scene);
    FrameStats stats;
    if (auto done = prepare(list, true, stats); !done) {
        return done.error();
    }
    hit_target_.bind();
    hit_target_.clear_color(channels_of(Hit{}));
    if (auto done = draw_content(list, true, stats); !done) {
        return done.error();
    }
    const Grid<glm::vec4> channels = gl::read_float_color(hit_target_);
    HitBuffer hits(channels.cols(), channels.rows());
    for (int row = 0; row < hits.rows(); ++row) {
        for (int col = 0; col < hits.cols(); ++col) {
            const glm::vec4& hit = channels(col, row);
            hits(col, row) = {hit.x, hit.y, hit.z, hit.w};
        }
    }
    return hits;
}

DrawList Driver::list_of(const scene::Scene& scene) const {
    DrawList list = select(scene, size());
    if (options_.occlusion) {
        drop_occluded(list);
    }
    return list;
}

Result<void> Driver::prepare(const DrawList& list, bool hits, FrameStats& stats) {
    if (auto good = check_techniques(list); !good) {
        return good;
    }
    if (auto good = check_support(list, limits_); !good) {
        return good;
    }
    const FrameBlock block = frame_block(list);
    frame_block_.write(0, std::as_bytes(std::span(&block, 1)));
    ++stats.uploads;
    stats.upload_bytes += sizeof(block);
    if (auto there = prepare_beams(list); !there) {
        return there;
    }
    return residency_.prepare(list, !hits, stats);
}

Result<void> Driver::prepare_beams(const DrawList& list) {
    const bool needed =
        std::any_of(list.reliefs.begin(), list.reliefs.end(), [](const ReliefDraw& draw) {
            return has_beams(draw.terrain->material.technique);
        });
    if (!needed || beams_of_ == size()) {
        return {};
    }
    auto target = beam_target(size());
    if (!target) {
        return target.error();
    }
    beam_target_ = std::move(*target);
    beams_of_ = size();
    return {};
}

Result<void> Driver::draw_content(const DrawList& list, bool hits, FrameStats& stats) {
    gl::set_reversed_depth();
    gl::set_culling(gl::Culling::back);
    frame_block_.bind_uniform_block(0);
    const Targets targets{hits ? hit_target_ : color_target_, beam_target_};
    targets.picture.clear_depth();
    Painter painter(list, hits, targets, shaders_, residency_, stats);
    auto done = painter.draw_tiles();
    if (done) {
        done = painter.draw_streamed_tiles();
    }
    if (done) {
        done = painter.draw_reliefs(no_vertices_);
    }
    if (done) {
        done = painter.draw_meshes();
    }
    if (done && list.sky && !hits) {
        done = painter.draw_sky(no_vertices_);
    }
    painter.set_wireframe(false);
    return done;
}

Image Driver::read_color() const {
    return gl::read_color(color_target_);
}

void Driver::show_in_window(glm::ivec2 window_size) const {
    color_target_.blit_to_window(window_size);
}

} // namespace reljef::render
