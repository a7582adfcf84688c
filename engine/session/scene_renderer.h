#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/cast/frame/driver.h"
#include "engine/core/color.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"
#include "engine/platform/context.h"
#include "engine/render/driver.h"
#include "engine/render/window_picture.h"
#include "engine/scene/graph/scene.h"
#include "engine/session/options.h"
#include "engine/view/choice/technique_choice.h"
#include "engine/view/picture/contour_labels.h"
#include "engine/view/picture/label_picture.h"
#include "engine/view/select.h"

namespace reljef::session {

/// What triangles and rays cost: by these `auto` chooses.
using Costs = view::TechniqueCosts;

/// The instruction set of rays by its name; an empty name: the fastest. Fails as
/// cast::simd_target().
Result<std::optional<cast::SimdTarget>> simd_target_of(const std::string& name);

/// Whether rays on the CPU draw a technique, see cast::draws_technique().
bool rays_draw(const scene::Technique& technique);

struct SceneRendererOptions {
    std::optional<render::DriverOptions> opengl = {}; ///< absent: rays only
    /// Absent: OpenGL only. With both, rays draw the frames that they can draw.
    std::optional<cast::DriverOptions> rays = {};
    bool expects_rays = false; ///< take_note() also says why OpenGL draws the first frame
    /// With both: triangles draw what they keep drawing faster (cast::obstacle_beside_triangles).
    bool prefers_triangles = false;
    /// With both: makes the context before OpenGL's first frame; empty: there is one.
    std::function<Result<void>()> make_context = {};
    view::SelectOptions select = {};
    view::TechniqueCosts costs = {}; ///< by which `auto` chooses
    bool selects_always = false;     ///< see view::FrameSelector
    unsigned threads = 0;            ///< of what is drawn over pictures; 0: one per processor
};

/// Draws the frames of a scene with OpenGL or by rays on the CPU, and selects each view once (see
/// view::FrameSelector). Destroy while its OpenGL context is current.
class SceneRenderer {
public:
    /// Fails if a driver cannot draw the size. Beside rays, OpenGL's driver is made for the first
    /// frame that it draws.
    static Result<SceneRenderer> create(const SceneRendererOptions& options = {});

    /// Selects what the scene's camera sees. Valid until the next call.
    const view::FrameView& select(const scene::Scene& scene) {
        return selector_.select(scene, size());
    }
    /// Draws the frame selected last; `wait`: until it is finished. Precondition: the scene has not
    /// changed since.
    Result<view::FrameStats> draw_selected(bool wait = false);
    Result<view::DrawnHits> draw_selected_hits();

    /// Selects and draws; FrameStats::cpu_ms includes the selection.
    Result<view::FrameStats> draw(const scene::Scene& scene, bool wait = false);
    Result<HitBuffer> draw_hits(const scene::Scene& scene);
    /// Selects, and counts what the pixels of draw() cost.
    Result<view::PictureWork> count_work(const scene::Scene& scene);

    /// Later parts of a picture are those of the one that the scene's camera shows at this size:
    /// what draws the whole draws them, and `auto` chooses once.
    void choose_for_parts(const scene::Scene& scene, glm::ivec2 picture);

    /// Releases the last view, before another scene is opened.
    void forget_scene() { selector_.forget(); }

    [[nodiscard]] view::FrameSelector& selector() { return selector_; }
    /// Waits for the last frame; fails if the graphics driver lost it.
    Result<void> check_drawn() { return shows_rays_ ? Result<void>() : opengl_->check_drawn(); }
    /// The last frame drawn. Waits for it.
    [[nodiscard]] Image read_color() const;
    /// Copies the last frame to the window's back buffer. Precondition: the window's context is
    /// current.
    Result<void> show_in_window(glm::ivec2 window_size);
    /// Copies any picture there.
    Result<void> show_in_window(const Image& picture, glm::ivec2 window_size) {
        return window_picture_.show(picture, window_size);
    }
    /// Takes the prepared light of a terrain, so that the next frame need not compute it.
    void add_light(std::shared_ptr<const view::PreparedLight> light);
    [[nodiscard]] int max_texture_side() const;
    Result<void> resize(glm::ivec2 size);
    /// For later frames, see render::DriverOptions::samples and cast::DriverOptions::samples.
    void set_samples(int samples);
    /// For later frames: how many times as large they will be shown. Labels are smaller by as much.
    void set_magnification(double magnification) { magnification_ = magnification; }
    /// For later frames: no contour label lies in these areas of the picture.
    void keep_clear(std::vector<scene::PicturePart> areas) { clear_areas_ = std::move(areas); }
    /// For later frames. Forgets the last view.
    void set_costs(const Costs& costs);
    [[nodiscard]] const Costs& costs() const { return chooser_->costs(); }
    [[nodiscard]] glm::ivec2 size() const { return size_; }

    /// Whether rays drew the last frame; before the first, whether they draw at all.
    [[nodiscard]] bool shows_rays() const { return shows_rays_; }
    /// A sentence if other means drew the last frame than the one before, once; else empty. See
    /// SceneRendererOptions::expects_rays for the first one.
    std::string take_note() { return std::exchange(note_, {}); }

private:
    SceneRenderer(const SceneRendererOptions& options);
    /// Whether rays draw the selected frame; fails if nothing does.
    Result<bool> choose_rays();
    Result<void> prepare_opengl();
    void forget_other_side(bool by_rays);
    Result<void> pass_lights(bool to_rays);
    [[nodiscard]] view::ContourLabels labels_of(const view::DrawList& list) const;
    [[nodiscard]] view::ContourLabels labels_of_frame() const;
    Result<void> draw_over(view::ContourLabels labels, bool needs_depths);
    void draw_eye_dome(const Grid<float>& depths, view::ContourLabels& labels);
    void draw_labels(const view::ContourLabels& labels);
    void paint_over(const scene::PicturePart& area,
                    const std::function<void(GridView<Rgba8>)>& paint);

    std::optional<render::DriverOptions> opengl_options_; // of the driver to be made
    std::function<Result<void>()> make_context_;
    std::optional<render::Driver> opengl_;
    std::optional<cast::Driver> rays_;
    render::WindowPicture window_picture_; // of rays
    glm::ivec2 size_;
    unsigned threads_;
    std::vector<std::shared_ptr<const view::PreparedLight>> lights_; // for the next frame
    bool shows_rays_;
    bool expects_rays_;
    std::string note_;
    // What keeps rays on the CPU from drawing the picture of later parts.
    bool prefers_triangles_;
    std::shared_ptr<std::string> obstacle_of_whole_;
    std::shared_ptr<view::TechniqueChooser> chooser_; // of the selector
    view::SelectOptions select_options_;              // without the choice
    view::FrameSelector selector_;
    double magnification_ = 1.0;
    std::vector<scene::PicturePart> clear_areas_;
    view::ContourLabels labels_of_whole_; // for parts of a picture
    int drawn_ = 0;                       // the selection that was drawn last, counted from 1
};

struct DeviceOptions {
    /// Absent: EGL if it finds a hardware GPU, otherwise OSMesa.
    std::optional<BackendKind> context = {};
    /// Without a named context and a hardware GPU: rays draw what they can, OSMesa all else.
    bool prefers_rays = false;
    glm::ivec2 size{1024, 768};            ///< of the picture, pixels
    std::filesystem::path shader_dir = {}; ///< its files override the built-in shaders
    int samples = 1;                       ///< per pixel, see render::DriverOptions
    int threads = 0;                       ///< of all that draws on the CPU; 0: its own choice
    std::string simd = {};                 ///< of rays on the CPU (cast/simd_target.h); empty: best
    bool selects_always = false;           ///< see SceneRendererOptions
    bool cuts_always = false;              ///< OpenGL cuts triangles of an unchanged view again
    view::TechniqueCosts costs = {};       ///< by which `auto` chooses
};

/// Sets the threads of software contexts (llvmpipe) created later; 0 changes nothing.
void limit_software_threads(int threads);

/// Lets Mesa's drivers of contexts created later keep their shaders in io::driver_cache_folder(),
/// or nowhere. Where the environment names a folder or forbids it, that holds. Sets the
/// environment: call it before other threads start.
void set_driver_cache();

/// A renderer, and the context without a visible window that it draws with, if OpenGL draws.
class Device {
public:
    /// Fails without such a context, and as SceneRenderer::create.
    static Result<Device> create(const DeviceOptions& options = {});

    /// What drew the last frame.
    [[nodiscard]] platform::RendererInfo info() const;
    [[nodiscard]] RayUse rays() const { return ray_use_; }
    [[nodiscard]] SceneRenderer& renderer() { return *renderer_; }
    [[nodiscard]] const SceneRenderer& renderer() const { return *renderer_; }

private:
    using Context = std::unique_ptr<platform::Context>;
    Device() = default;

    static Result<Device> create_with_rays(const DeviceOptions& options, RayUse use);
    static Result<Device> create_with_context(const DeviceOptions& options, Context context);

    RayUse ray_use_ = RayUse::none;
    std::string rays_version_;
    std::shared_ptr<Context> context_; // outlives the renderer's GL objects; null: no GL
    std::unique_ptr<SceneRenderer> renderer_;
};

} // namespace reljef::session
