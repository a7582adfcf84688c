#include "engine/render/passes/draw_state.h"

#include <utility>

namespace reljef::render {
namespace {

// A software renderer keeps about 230 bytes for each triangle until it is drawn (measured with four
// samples per pixel).
constexpr std::size_t max_awaited = 1U << 16U; // 15 MB
// While it draws one part of them, the vertices of the next are computed.
constexpr std::size_t awaited_part = max_awaited / 2;

} // namespace

DrawState::DrawState(ShaderLibrary& shaders, BlockBuffers& blocks, bool software,
                     view::FrameStats& stats)
    : shaders_(shaders), blocks_(blocks), software_(software), stats_(stats) {
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
    set_sample_shading(
        (variant.features & feature_multisampled) != 0 &&
        (searches_for_surface(variant.kind) || (variant.features & feature_corner_depth) != 0));
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
    count_draw(static_cast<std::size_t>(mesh.index_count) / 3);
}

void DrawState::draw_slivers(const ResidentMesh& mesh, std::size_t count) {
    mesh.vertex_array.bind();
    gl::draw_arrays(gl::Primitive::triangles, static_cast<int>(3 * count));
    stats_.slivers += count;
    count_draw(count);
}

void DrawState::count_draw(std::size_t triangles) {
    stats_.triangles += triangles;
    ++stats_.draws;
    ++stats_.state_changes;
    awaited_ += triangles;
    if (software_ && awaited_ >= awaited_part) {
        gl::Fence drawn = gl::Fence::after_commands();
        last_part_.wait();
        if (awaited_ > max_awaited) { // one large draw
            drawn.wait();
        }
        last_part_ = std::move(drawn);
        awaited_ = 0;
    }
}

} // namespace reljef::render
