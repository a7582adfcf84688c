#pragma once

#include <optional>

#include "engine/core/result.h"
#include "engine/gl/draw.h"
#include "engine/gl/program.h"
#include "engine/gl/state.h"
#include "engine/render/residency/resident_mesh.h"
#include "engine/render/shaders/shader_library.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// What is set for the draw calls of one frame. What is set already is not set again; what is set
/// and drawn is counted. Each painter asks for all that it needs. Needs a current context.
class DrawState {
public:
    /// Sets what a frame begins with: reversed depth, filled triangles, their backs left out.
    DrawState(ShaderLibrary& shaders, view::FrameStats& stats);

    /// The variant's program, in use; one that looks for a surface does so for each sample of a
    /// pixel. Fails as ShaderLibrary::program.
    Result<gl::Program*> use(ShaderVariant variant);
    /// Which sides of triangles are left out.
    void set_culling(gl::Culling culling);
    void set_wireframe(bool wireframe);

    /// Draws all of a mesh with the program in use.
    void draw(const ResidentMesh& mesh, gl::IndexType type);

    /// For what a painter sets and draws itself.
    [[nodiscard]] view::FrameStats& stats() { return stats_; }

private:
    void set_sample_shading(bool on);

    ShaderLibrary& shaders_;
    view::FrameStats& stats_;
    std::optional<ShaderVariant> variant_;
    gl::Program* program_ = nullptr;
    gl::Culling culling_ = gl::Culling::back;
    bool wireframe_ = false;
    bool shades_samples_ = false;
};

} // namespace reljef::render
