#include "engine/render/passes/draw_state.h"

namespace reljef::render {

DrawState::DrawState(ShaderLibrary& shaders, BlockBuffers& blocks, view::FrameStats& stats)
    : shaders_(shaders), blocks_(blocks), stats_(stats) {
    gl::set_reversed_depth();
    gl::set_culling(gl::Culling::back);
    gl::set_polygon_mode(gl::PolygonMode::fill);
    gl::set_sample_shading(false);
    gl::set_adding(false);
}

Result<gl::Program*> DrawState::use(ShaderVariant variant) {
    auto program = shaders_.program(variant);
    if (!program) {
        return program.error();
    }
    (*program)->use();
    ++stats_.state_changes;
    set_sample_shading((variant.features & feature_multisampled) != 0 &&
                       searches_for_surface(variant.kind));
    return *program;
}

Result<void> DrawState::set_block(unsigned int binding, std::span<const std::byte> content) {
    auto buffer = blocks_.buffer(content, stats_);
    if (!buffer) {
        return buffer.error();
    }
    (*buffer)->bind_uniform_block(binding);
    ++stats_.state_changes;
    return {};
}

void DrawState::set_sample_shading(bool on) {
    gl::set_sample_shading(on);
    ++stats_.state_changes;
}

void DrawState::set_culling(gl::Culling culling) {
    gl::set_culling(culling);
    ++stats_.state_changes;
}

void DrawState::set_wireframe(bool wireframe) {
    gl::set_polygon_mode(wireframe ? gl::PolygonMode::line : gl::PolygonMode::fill);
    ++stats_.state_changes;
}

void DrawState::set_adding(bool adding) {
    gl::set_adding(adding);
    ++stats_.state_changes;
}

void DrawState::draw(const ResidentMesh& mesh, gl::IndexType type) {
    mesh.vertex_array.bind();
    gl::draw_elements(type, mesh.index_count);
    stats_.triangles += static_cast<std::size_t>(mesh.index_count) / 3;
    ++stats_.draws;
    ++stats_.state_changes;
}

void DrawState::draw_triangles(const gl::VertexArray& no_vertices, std::size_t count) {
    no_vertices.bind();
    gl::draw_arrays(gl::Primitive::triangles, static_cast<int>(3 * count));
    stats_.triangles += count;
    stats_.slivers += count;
    ++stats_.draws;
    ++stats_.state_changes;
}

} // namespace reljef::render
