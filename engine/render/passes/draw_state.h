#pragma once

#include <cstddef>
#include <span>

#include "engine/core/result.h"
#include "engine/gl/draw.h"
#include "engine/gl/fence.h"
#include "engine/gl/program.h"
#include "engine/gl/state.h"
#include "engine/render/residency/block_buffers.h"
#include "engine/render/shaders/shader_library.h"
#include "engine/render/triangles/resident_mesh.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// The GL state of one frame's draw calls. Counts changes and draws. Each pass sets all state that
/// it needs. Needs a current context.
class DrawState {
public:
    /// Sets reversed depth, filled triangles, back-face culling, and colours that replace others.
    /// `software`: a renderer on the CPU, which is waited for so often that its memory is limited.
    DrawState(ShaderLibrary& shaders, BlockBuffers& blocks, bool software, view::FrameStats& stats);

    /// Binds the variant's program. Programs that search a surface, or take depth from corners, run
    /// per sample. Fails as
    /// ShaderLibrary::program.
    Result<gl::Program*> use(ShaderVariant variant);
    template <class Block> Result<void> set(const Block& block) {
        return set_block(Block::layout.binding, std::as_bytes(std::span(&block, 1)));
    }
    void set_culling(gl::Culling culling);
    void set_wireframe(bool wireframe);
    /// Whether fragments add to the colours that are there.
    void set_adding(bool adding);

    void draw(const ResidentMesh& mesh, gl::IndexType type);
    /// The first triangles of a mesh without indices. Counts them as slivers (view::Slivers), too.
    void draw_slivers(const ResidentMesh& mesh, std::size_t count);

    [[nodiscard]] view::FrameStats& stats() { return stats_; }

private:
    Result<void> set_block(unsigned int binding, std::span<const std::byte> content);
    void set_sample_shading(bool on);
    void count_draw(std::size_t triangles);

    ShaderLibrary& shaders_;
    BlockBuffers& blocks_;
    bool software_;
    view::FrameStats& stats_;
    std::size_t awaited_ = 0; // triangles after last_part_
    gl::Fence last_part_;
};

} // namespace reljef::render
