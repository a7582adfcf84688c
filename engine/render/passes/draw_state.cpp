#include "engine/render/passes/draw_state.h"

namespace reljef::render {

DrawState::DrawState(ShaderLibrary& shaders, view::FrameStats& stats)
    : shaders_(shaders), stats_(stats) {
    gl::set_reversed_depth();
    gl::set_culling(culling_);
    gl::set_polygon_mode(gl::PolygonMode::fill);
    gl::set_sample_shading(false);
}

Result<gl::Program*> DrawState::use(ShaderVariant variant) {
    if (variant_ == variant) {
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

void DrawState::set_sample_shading(bool on) {
    if (on != shades_samples_) {
        gl::set_sample_shading(on);
        shades_samples_ = on;
        ++stats_.state_changes;
    }
}

void DrawState::set_culling(gl::Culling culling) {
    if (culling != culling_) {
        gl::set_culling(culling);
        culling_ = culling;
        ++stats_.state_changes;
    }
}

void DrawState::set_wireframe(bool wireframe) {
    if (wireframe != wireframe_) {
        gl::set_polygon_mode(wireframe ? gl::PolygonMode::line : gl::PolygonMode::fill);
        wireframe_ = wireframe;
        ++stats_.state_changes;
    }
}

void DrawState::draw(const ResidentMesh& mesh, gl::IndexType type) {
    mesh.vertex_array.bind();
    gl::draw_elements({.type = type, .count = mesh.index_count});
    stats_.triangles += static_cast<std::size_t>(mesh.index_count) / 3;
    ++stats_.draws;
    ++stats_.state_changes;
}

} // namespace reljef::render
