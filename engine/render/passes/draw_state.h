#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>

#include "engine/core/result.h"
#include "engine/gl/draw.h"
#include "engine/gl/program.h"
#include "engine/gl/state.h"
#include "engine/render/residency/block_buffers.h"
#include "engine/render/residency/resident_mesh.h"
#include "engine/render/shaders/shader_library.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// What is set for the draw calls of one frame. What is set already is not set again; what is set
/// and drawn is counted. Each pass asks for all that it needs. Needs a current context.
class DrawState {
public:
    /// Sets what a frame begins with: reversed depth, filled triangles, their backs left out.
    DrawState(ShaderLibrary& shaders, BlockBuffers& blocks, view::FrameStats& stats);

    /// The variant's program, in use; one that looks for a surface does so for each sample of a
    /// pixel. Fails as ShaderLibrary::program.
    Result<gl::Program*> use(ShaderVariant variant);
    /// What all programs read from that uniform block. Fails where the driver has no memory.
    template <class Block> Result<void> set(const Block& block) {
        return set_block(Block::layout.binding, std::as_bytes(std::span(&block, 1)));
    }
    /// Which sides of triangles are left out.
    void set_culling(gl::Culling culling);
    void set_wireframe(bool wireframe);

    /// Draws all of a mesh with the program in use.
    void draw(const ResidentMesh& mesh, gl::IndexType type);

    /// For what a pass sets and draws itself.
    [[nodiscard]] view::FrameStats& stats() { return stats_; }

private:
    Result<void> set_block(unsigned int binding, std::span<const std::byte> content);
    void set_sample_shading(bool on);

    ShaderLibrary& shaders_;
    BlockBuffers& blocks_;
    view::FrameStats& stats_;
    std::optional<ShaderVariant> variant_;
    gl::Program* program_ = nullptr;
    std::map<unsigned int, const gl::Buffer*> bound_; // by binding point
    gl::Culling culling_ = gl::Culling::back;
    bool wireframe_ = false;
    bool shades_samples_ = false;
};

} // namespace reljef::render
