#include "engine/render/passes/draw_state.h"

namespace reljef::render {

DrawState::DrawState(ShaderLibrary& shaders, BlockBuffers& blocks, view::FrameStats& stats,
                     bool skips)
    : shaders_(shaders), blocks_(blocks), stats_(stats), skips_(skips) {
    gl::set_reversed_depth();
    gl::set_culling(culling_);
    gl::set_polygon_mode(gl::PolygonMode::fill);
    gl::set_sample_shading(false);
    gl::set_adding(false);
}

Result<gl::Program*> DrawState::use(ShaderVariant variant) {
    if (skips_ && variant_ == variant) {
        return program_;
    }
    auto program = shaders_.program(variant);
    if (!program) {
        return program.error();
    }
    program_ = *program;
    variant_ = variant;
    program_->use();
    ++stats_.state_changes;
    set_sample_shading((variant.features & feature_multisampled) != 0 &&
                       searches_for_surface(variant.kind));
    return program_;
}

Result<void> DrawState::set_block(unsigned int binding, std::span<const std::byte> content) {
    auto buffer = blocks_.buffer(content, stats_);
    if (!buffer) {
        return buffer.error();
    }
    const gl::Buffer*& bound = bound_[binding];
    if (!skips_ || bound != *buffer) {
        bound = *buffer;
        bound->bind_uniform_block(binding);
        ++stats_.state_changes;
    }
    return {};
}

void DrawState::set_sample_shading(bool on) {
    if (!skips_ || on != shades_samples_) {
        gl::set_sample_shading(on);
        shades_samples_ = on;
        ++stats_.state_changes;
    }
}

void DrawState::set_culling(gl::Culling culling) {
    if (!skips_ || culling != culling_) {
        gl::set_culling(culling);
        culling_ = culling;
        ++stats_.state_changes;
    }
}

void DrawState::set_wireframe(bool wireframe) {
    if (!skips_ || wireframe != wireframe_) {
        gl::set_polygon_mode(wireframe ? gl::PolygonMode::line : gl::PolygonMode::fill);
        wireframe_ = wireframe;
        ++stats_.state_changes;
    }
}

void DrawState::set_adding(bool adding) {
    if (!skips_ || adding != adding_) {
        gl::set_adding(adding);
        adding_ = adding;
        ++stats_.state_changes;
    }
}

void DrawState::draw(const ResidentMesh& mesh, gl::IndexType type) {
    mesh.vertex_array.bind();
    gl::draw_elements(type, mesh.index_count);
    stats_.triangles += static_cast<std::size_t>(mesh.index_count) / 3;
    ++stats_.draws;
    ++stats_.state_changes;
}

} // namespace reljef::render
