#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/gl/framebuffer.h"
#include "engine/gl/limits.h"
#include "engine/gl/timer_query.h"
#include "engine/render/passes/beams.h"
#include "engine/render/passes/ground_shadow.h"
#include "engine/render/passes/mesh_shadow.h"
#include "engine/render/passes/sample_target.h"
#include "engine/render/passes/skips.h"
#include "engine/render/residency/block_buffers.h"
#include "engine/render/residency/residency.h"
#include "engine/render/shaders/shader_library.h"
#include "engine/view/frame_stats.h"
#include "engine/view/sample_count.h"
#include "engine/view/select.h"

namespace reljef::render {

struct DriverOptions {
    glm::ivec2 size{1024, 768};       ///< of the picture, pixels
    std::filesystem::path shader_dir; ///< files there override the built-in shaders
    bool software = true;             ///< CPU renderer: measure time by a clock, not by queries
    /// Per pixel, see view::check_samples(). In a relief search each sample has its own ray. Hits
    /// are those of the pixels' centres.
    int samples = 1;
    Skips skips = {};
};

/// Draws selected frames with the current context into its own framebuffer object with reversed
/// 32-bit float depth. Keeps drawn content in GPU memory as long as the scene lives. Destroy while
/// the context is current, like all objects of this room that own GL objects.
class Driver {
public:
    /// Fails on a size that GL cannot draw and as view::check_samples().
    static Result<Driver> create(const DriverOptions& options = {});

    /// Draws a frame of size(). `wait` waits for the GPU and fills FrameStats::gpu_ms. Fails as
    /// check_techniques() and check_support().
    Result<view::FrameStats> draw(const view::FrameView& frame, bool wait = false);

    Result<view::DrawnHits> draw_hits(const view::FrameView& frame);
    /// What the fragments of draw() cost with one sample per pixel: those of terrains that pass the
    /// depth test, also where nearer ones replace them.
    Result<view::PictureWork> count_work(const view::FrameView& frame);

    /// Waits for the last frame; fails if the driver lost it, so that read_color() shows nothing.
    Result<void> check_drawn();
    /// The last frame. Waits for the GPU.
    [[nodiscard]] Image read_color() const;
    /// Replaces a rectangle of the last frame by what `paint` makes of its colours. Waits for the
    /// GPU. Precondition: it lies inside the frame.
    void paint_over(glm::ivec2 first, glm::ivec2 size, const std::function<void(Image&)>& paint);
    void show_in_window(glm::ivec2 window_size) const;

    /// Adds precomputed light of a terrain in the next frame. Fails when GL has no memory.
    Result<void> add_light(const view::PreparedLight& prepared) {
        return residency_.add_light(prepared);
    }
    /// Releases what is in GPU memory; the next frame uploads what it needs again.
    void forget_content() { residency_ = {}; }
    [[nodiscard]] int max_texture_side() const { return limits_.max_texture_size; }

    Result<void> resize(glm::ivec2 size);
    /// See DriverOptions::samples. Precondition: view::check_samples().
    void set_samples(int samples) { options_.samples = samples; }
    [[nodiscard]] glm::ivec2 size() const { return color_target_.size(); }

private:
    Driver(const DriverOptions& options, gl::Framebuffer target);

    Result<void> check_context();
    Result<void> prepare(const view::DrawList& list, bool hits, view::FrameStats& stats);
    void write_frame_block(const view::DrawList& list, view::FrameStats& stats);
    Result<void> draw_picture(const view::DrawList& list, view::FrameStats& stats);
    Result<void> draw_mesh_shadows(const view::DrawList& list, view::FrameStats& stats);
    Result<void> draw_samples(const view::DrawList& list, view::FrameStats& stats);
    Result<void> draw_sample_pass(const view::DrawList& list, int pass, view::FrameStats& stats);
    Result<void> draw_pass(const view::DrawList& list, const gl::Framebuffer& picture,
                           view::FrameStats& stats);
    Result<void> set_light(const view::DrawList& list, DrawState& state) const;
    Result<void> draw_content(const view::DrawList& list, const gl::Framebuffer& picture, bool hits,
                              view::FrameStats& stats);
    Result<void> draw_work(const view::DrawList& list, const gl::Framebuffer& picture);

    DriverOptions options_;
    gl::Limits limits_;
    bool is_lost_ = false; // the context
    gl::Framebuffer color_target_;
    gl::Framebuffer hit_target_;  // created on first use
    gl::Framebuffer work_target_; // likewise
    SampleTarget sample_target_;
    BeamTarget beam_target_;
    BeamTarget counted_beams_{true};
    MeshShadow mesh_shadow_; // of the last picture
    GroundShadow ground_shadow_;
    gl::Buffer frame_block_;
    gl::VertexArray no_vertices_;
    ShaderLibrary shaders_;
    BlockBuffers blocks_;
    Residency residency_;
};

} // namespace reljef::render
