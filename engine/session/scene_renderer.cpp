#include "engine/session/scene_renderer.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>

#include <glm/vector_relational.hpp>

#include "engine/cast/simd_target.h"
#include "engine/core/check.h"
#include "engine/core/stopwatch.h"
#include "engine/io/cache/disk_cache.h"
#include "engine/view/picture/eye_dome.h"

namespace reljef::session {

Result<std::optional<cast::SimdTarget>> simd_target_of(const std::string& name) {
    using Target = std::optional<cast::SimdTarget>;
    if (name.empty()) {
        return Target();
    }
    const auto target = cast::simd_target(name);
    return target ? Result<Target>(*target) : target.error();
}

bool rays_draw(const scene::Technique& technique) {
    return cast::draws_technique(technique);
}

namespace {

view::SelectOptions with_chooser(view::SelectOptions options,
                                 std::shared_ptr<view::TechniqueChooser> chooser) {
    options.refine = [chooser = std::move(chooser)](view::DrawList& list,
                                                    const std::function<void()>& drop_hidden) {
        chooser->choose(list, drop_hidden);
    };
    return options;
}

std::string obstacle_of(const view::DrawList& list, bool prefers_triangles) {
    return prefers_triangles ? cast::obstacle_beside_triangles(list) : cast::obstacle_of(list);
}

// All parts of a picture are drawn by the same means.
std::string obstacle_in(const view::DrawList& list, const std::string& of_whole,
                        bool prefers_triangles) {
    const bool is_part = list.camera.whole != glm::ivec2(0);
    return is_part && !of_whole.empty() ? of_whole : obstacle_of(list, prefers_triangles);
}

bool overlap(const scene::PicturePart& a, const scene::PicturePart& b) {
    return glm::all(glm::lessThan(a.first, b.first + b.size)) &&
           glm::all(glm::lessThan(b.first, a.first + a.size));
}

view::ChoiceOptions choice_options(const SceneRendererOptions& options,
                                   std::shared_ptr<const std::string> obstacle_of_whole) {
    view::ChoiceOptions choice{.costs = options.costs};
    if (options.rays) {
        choice.rays_draw = [is_alone = !options.opengl,
                            prefers_triangles = options.prefers_triangles,
                            of_whole = std::move(obstacle_of_whole)](const view::DrawList& list) {
            return is_alone || obstacle_in(list, *of_whole, prefers_triangles).empty();
        };
    }
    return choice;
}

} // namespace

SceneRenderer::SceneRenderer(const SceneRendererOptions& options)
    : opengl_options_(options.opengl), make_context_(options.make_context),
      size_(options.rays ? options.rays->size : options.opengl->size), threads_(options.threads),
      shows_rays_(options.rays.has_value()), expects_rays_(options.expects_rays),
      prefers_triangles_(options.prefers_triangles),
      obstacle_of_whole_(std::make_shared<std::string>()),
      chooser_(
          std::make_shared<view::TechniqueChooser>(choice_options(options, obstacle_of_whole_))),
      select_options_(options.select),
      selector_(with_chooser(options.select, chooser_), options.selects_always) {
    chooser_->set_samples(options.opengl ? options.opengl->samples : 1);
}

Result<SceneRenderer> SceneRenderer::create(const SceneRendererOptions& options) {
    reljef::check(options.opengl || options.rays, "a driver was expected");
    SceneRenderer renderer(options);
    if (options.rays) {
        auto rays = cast::Driver::create(*options.rays);
        if (!rays) {
            return rays.error();
        }
        renderer.rays_ = std::move(*rays);
    } else if (auto made = renderer.prepare_opengl(); !made) {
        return made.error();
    }
    return renderer;
}

Result<void> SceneRenderer::prepare_opengl() {
    if (opengl_) {
        return {};
    }
    if (make_context_) {
        if (auto made = make_context_(); !made) {
            return made;
        }
    }
    opengl_options_->size = size_;
    auto driver = render::Driver::create(*opengl_options_);
    if (!driver) {
        return driver.error();
    }
    opengl_ = std::move(*driver);
    chooser_->set_max_map_side(opengl_->max_texture_side());
    return {};
}

Result<bool> SceneRenderer::choose_rays() {
    const view::DrawList& list = selector_.selected().list;
    const std::string obstacle =
        rays_ ? obstacle_in(list, *obstacle_of_whole_, prefers_triangles_) : "no rays";
    const bool by_rays = obstacle.empty() || !opengl_options_;
    if (!by_rays) {
        if (auto prepared = prepare_opengl(); !prepared) {
            return prepared.error();
        }
    }
    if ((drawn_ > 0 || expects_rays_) && shows_rays_ != by_rays) {
        note_ = by_rays ? "exact rays on the CPU draw again, within the technique's error bound"
                        : obstacle + ": drawn by OpenGL, not by rays on the CPU";
    }
    if (shows_rays_ != by_rays) {
        forget_other_side(by_rays);
    }
    shows_rays_ = by_rays;
    if (auto passed = pass_lights(by_rays); !passed) {
        return passed.error();
    }
    return by_rays;
}

// What draws no more releases its content, so that both together stay within the memory.
void SceneRenderer::forget_other_side(bool by_rays) {
    if (by_rays && opengl_) {
        opengl_->forget_content();
    } else if (!by_rays && rays_) {
        rays_->forget_content();
    }
}

Result<void> SceneRenderer::pass_lights(bool to_rays) {
    for (const auto& light : std::exchange(lights_, {})) {
        auto added = to_rays ? rays_->add_light(*light) : opengl_->add_light(*light);
        if (!added) {
            return added;
        }
    }
    return {};
}

Result<view::DrawnHits> SceneRenderer::draw_selected_hits() {
    const auto by_rays = choose_rays();
    if (!by_rays) {
        return by_rays.error();
    }
    auto drawn = *by_rays ? rays_->draw_hits(selector_.selected())
                          : opengl_->draw_hits(selector_.selected());
    if (drawn) {
        view::add_mesh_error(drawn->stats);
    }
    return drawn;
}

Image SceneRenderer::read_color() const {
    return shows_rays_ ? rays_->read_color() : opengl_->read_color();
}

Result<void> SceneRenderer::show_in_window(glm::ivec2 window_size) {
    if (shows_rays_) {
        return window_picture_.show(rays_->read_color(), window_size);
    }
    opengl_->show_in_window(window_size);
    return {};
}

void SceneRenderer::add_light(std::shared_ptr<const view::PreparedLight> light) {
    lights_.push_back(std::move(light));
}

int SceneRenderer::max_texture_side() const {
    const int of_rays = rays_ ? cast::Driver::max_texture_side() : opengl_->max_texture_side();
    return opengl_ ? std::min(of_rays, opengl_->max_texture_side()) : of_rays;
}

Result<void> SceneRenderer::resize(glm::ivec2 size) {
    if (rays_) {
        if (auto resized = rays_->resize(size); !resized) {
            return resized;
        }
    }
    if (opengl_) {
        if (auto resized = opengl_->resize(size); !resized) {
            return resized;
        }
    }
    size_ = size;
    return {};
}

void SceneRenderer::set_samples(int samples) {
    if (samples != chooser_->samples()) { // what is cheapest depends on them
        chooser_->set_samples(samples);
        selector_.forget();
    }
    if (opengl_options_) {
        opengl_options_->samples = samples;
    }
    if (opengl_) {
        opengl_->set_samples(samples);
    }
    if (rays_) {
        rays_->set_samples(samples);
    }
}

void SceneRenderer::set_costs(const Costs& costs) {
    chooser_->set_costs(costs);
    selector_.forget();
}

void SceneRenderer::choose_for_parts(const scene::Scene& scene, glm::ivec2 picture) {
    const view::FrameView whole = view::select(scene, picture, select_options_);
    *obstacle_of_whole_ = obstacle_of(whole.list, prefers_triangles_);
    chooser_->choose_for_parts(whole.list);
    labels_of_whole_ = labels_of(whole.list);
    selector_.forget();
}

Result<view::FrameStats> SceneRenderer::draw_selected(bool wait) {
    const auto by_rays = choose_rays();
    if (!by_rays) {
        return by_rays.error();
    }
    const view::FrameView& frame = selector_.selected();
    Stopwatch watch;
    view::ContourLabels labels = labels_of_frame();
    // The depths of a frame are kept or drawn only if something needs them.
    const bool needs_depths =
        frame.list.eye_dome > 0.0 || (!labels.labels.empty() && !frame.list.meshes.empty());
    const double searching = watch.milliseconds();
    auto stats = *by_rays ? rays_->draw(frame, needs_depths) : opengl_->draw(frame, wait);
    if (stats) {
        view::add_mesh_error(*stats);
        watch = Stopwatch();
        if (auto drawn = draw_over(std::move(labels), needs_depths); !drawn) {
            return drawn.error();
        }
        stats->cpu_ms += searching + watch.milliseconds();
        const bool was_drawn = std::exchange(drawn_, selector_.count()) == selector_.count();
        stats->skipped.selections_unchanged = was_drawn ? 1 : 0;
        stats->cpu_ms += was_drawn ? 0.0 : selector_.milliseconds();
    }
    return stats;
}

Result<void> SceneRenderer::draw_over(view::ContourLabels labels, bool needs_depths) {
    if (needs_depths && shows_rays_) {
        draw_eye_dome(rays_->depths(), labels);
    } else if (needs_depths) {
        const auto drawn = opengl_->draw_hits(selector_.selected());
        if (!drawn) {
            return drawn.error();
        }
        Grid<float> depths(size_.x, size_.y);
        std::ranges::transform(drawn->hits.samples(), depths.samples().begin(), &Hit::depth);
        draw_eye_dome(depths, labels);
    }
    draw_labels(labels);
    return {};
}

// Drops covered labels.
void SceneRenderer::draw_eye_dome(const Grid<float>& depths, view::ContourLabels& labels) {
    std::erase_if(labels.labels, [&](const view::ContourLabel& label) {
        return view::is_covered(label, labels.digit_height, depths);
    });
    const view::DrawList& list = selector_.selected().list;
    if (list.eye_dome > 0.0) {
        paint_over({{0, 0}, size_}, [&](GridView<Rgba8> picture) {
            view::shade_eye_dome(picture, depths, list, {threads_, {}, {}});
        });
    }
}

// Of a list that is no part of a picture.
view::ContourLabels SceneRenderer::labels_of(const view::DrawList& list) const {
    view::ContourLabels labels = view::contour_labels(list, magnification_);
    std::erase_if(labels.labels, [&](const view::ContourLabel& label) {
        const auto area = view::label_area(label, labels.digit_height, list.size);
        return std::ranges::any_of(
            clear_areas_, [&](const scene::PicturePart& clear) { return overlap(area, clear); });
    });
    return labels;
}

view::ContourLabels SceneRenderer::labels_of_frame() const {
    const view::DrawList& list = selector_.selected().list;
    if (list.camera.whole == glm::ivec2(0)) {
        return labels_of(list);
    }
    view::ContourLabels labels = labels_of_whole_;
    for (view::ContourLabel& label : labels.labels) {
        label.middle -= glm::dvec2(list.camera.first);
    }
    return labels;
}

void SceneRenderer::draw_labels(const view::ContourLabels& labels) {
    for (const view::ContourLabel& label : labels.labels) {
        const scene::PicturePart area = view::label_area(label, labels.digit_height, size_);
        if (area.size.x > 0 && area.size.y > 0) {
            paint_over(area, [&](GridView<Rgba8> colors) {
                view::draw_label(label, labels.digit_height, colors, area.first);
            });
        }
    }
}

void SceneRenderer::paint_over(const scene::PicturePart& area,
                               const std::function<void(GridView<Rgba8>)>& paint) {
    if (shows_rays_) {
        paint(rays_->picture().view().window(area.first.x, area.first.y, area.size.x, area.size.y));
    } else {
        opengl_->paint_over(area.first, area.size, [&](Image& colors) { paint(colors.view()); });
    }
}

Result<view::FrameStats> SceneRenderer::draw(const scene::Scene& scene, bool wait) {
    select(scene);
    return draw_selected(wait);
}

Result<HitBuffer> SceneRenderer::draw_hits(const scene::Scene& scene) {
    select(scene);
    auto drawn = draw_selected_hits();
    return drawn ? Result<HitBuffer>(std::move(drawn->hits)) : drawn.error();
}

Result<view::PictureWork> SceneRenderer::count_work(const scene::Scene& scene) {
    const view::FrameView& frame = select(scene);
    const auto by_rays = choose_rays();
    if (!by_rays) {
        return by_rays.error();
    }
    return *by_rays ? rays_->count_work(frame) : opengl_->count_work(frame);
}

void limit_software_threads(int threads) {
    if (threads > 0) {
        ::setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
    }
}

void set_driver_cache() {
    for (const char* const name : {"MESA_SHADER_CACHE_DIR", "MESA_SHADER_CACHE_DISABLE",
                                   "MESA_GLSL_CACHE_DIR", "MESA_GLSL_CACHE_DISABLE"}) {
        if (std::getenv(name) != nullptr) {
            return;
        }
    }
    if (const auto folder = io::driver_cache_folder()) {
        ::setenv("MESA_SHADER_CACHE_DIR", folder->c_str(), 1);
    } else {
        ::setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    }
}

namespace {

render::DriverOptions opengl_options(const DeviceOptions& options, bool is_software) {
    return {.size = options.size,
            .shader_dir = options.shader_dir,
            .software = is_software,
            .samples = options.samples,
            .skips = {.cuts = !options.cuts_always}};
}

platform::ContextOptions hidden(const DeviceOptions& options) {
    return {.size = options.size, .visible = false};
}

} // namespace

Result<Device> Device::create_with_rays(const DeviceOptions& options, RayUse use) {
    const auto target = simd_target_of(options.simd);
    if (!target) {
        return target.error();
    }
    Device device;
    device.ray_use_ = use;
    device.rays_version_ =
        options.simd.empty() ? std::string(cast::simd_targets().front().name) : options.simd;
    SceneRendererOptions drivers{
        .rays = cast::DriverOptions{.size = options.size,
                                    .threads = static_cast<unsigned>(options.threads),
                                    .samples = options.samples,
                                    .target = *target},
        .costs = options.costs,
        .selects_always = options.selects_always,
        .threads = static_cast<unsigned>(options.threads)};
    if (use == RayUse::preferred) {
        device.context_ = std::make_shared<Context>();
        drivers.opengl = opengl_options(options, true);
        drivers.make_context = [slot = device.context_, made = hidden(options)]() -> Result<void> {
            auto context = platform::make_headless_context(made);
            if (!context) {
                return context.error();
            }
            *slot = std::move(*context);
            return {};
        };
    }
    auto renderer = SceneRenderer::create(drivers);
    if (!renderer) {
        return renderer.error();
    }
    device.renderer_ = std::make_unique<SceneRenderer>(std::move(*renderer));
    return device;
}

Result<Device> Device::create_with_context(const DeviceOptions& options, Context context) {
    auto renderer =
        SceneRenderer::create({.opengl = opengl_options(options, context->is_software()),
                               .costs = options.costs,
                               .selects_always = options.selects_always,
                               .threads = static_cast<unsigned>(options.threads)});
    if (!renderer) {
        return renderer.error();
    }
    Device device;
    device.context_ = std::make_shared<Context>(std::move(context));
    device.renderer_ = std::make_unique<SceneRenderer>(std::move(*renderer));
    return device;
}

Result<Device> Device::create(const DeviceOptions& options) {
    if (options.context == BackendKind::cpu) {
        return create_with_rays(options, RayUse::only);
    }
    limit_software_threads(options.threads);
    set_driver_cache();
    if (!options.context && options.prefers_rays) {
        auto gpu = platform::make_gpu_context(hidden(options));
        return gpu ? create_with_context(options, std::move(*gpu))
                   : create_with_rays(options, RayUse::preferred);
    }
    auto context = options.context
                       ? platform::make_context(*context_of(*options.context), hidden(options))
                       : platform::make_headless_context(hidden(options));
    return context ? create_with_context(options, std::move(*context)) : context.error();
}

platform::RendererInfo Device::info() const {
    if (!renderer_->shows_rays()) {
        return platform::info_of(**context_);
    }
    return {.renderer = "exact rays on the CPU",
            .version = rays_version_,
            .context = std::string(to_string(BackendKind::cpu)),
            .is_software = true};
}

} // namespace reljef::session
