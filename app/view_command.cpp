#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/choice/calibration_option.h"
#include "app/cli/console_log.h"
#include "app/cli/options.h"
#include "app/cli/program.h"
#include "app/cli/standard_input.h"
#include "app/commands.h"
#include "app/objects/light_option.h"
#include "app/objects/object_option.h"
#include "app/objects/point_light_option.h"
#include "app/objects/surface_shader_option.h"
#include "app/rendering/frame_sink.h"
#include "app/viewer/opening.h"
#include "app/viewer/panels/toolkit/gpu_wait.h"
#include "app/viewer/timing/program_age.h"
#include "app/viewer/timing/time_report.h"
#include "app/viewer/viewer.h"
#include "app/viewer/window_loop.h"
#include "engine/core/stopwatch.h"
#include "engine/platform/window.h"
#include "engine/session/flight_keys.h"
#include "engine/session/ground.h"
#include "engine/session/picture/picture_parts.h"
#include "engine/session/scene_renderer.h"
#include "engine/session/scene_setup.h"

namespace reljef::app {
namespace {

struct ViewerChoice {
    cli::TerrainChoice terrain;
    cli::ViewChoice view;
    bool frames_given = false;
    bool hides_panels = false;
    bool prints_times = false;
    bool prints_json = false;
    std::string named_terrain; ///< as on the command line
};

StartOptions start_options(const ViewerChoice& choice) {
    StartOptions start{choice.terrain, choice.view, choice.view.context, choice.view.simd,
                       choice.view.allow_underground};
    start.source.terrain = choice.named_terrain;
    return start;
}

Result<Panels> make_panels(const ViewerChoice& choice, platform::Window& window) {
    auto interface = Interface::create(
        {.scale = window.content_scale(),
         .clipboard = [&window] { return window.clipboard(); },
         .set_clipboard = [&window](const std::string& text) { window.set_clipboard(text); }});
    if (!interface) {
        return interface.error();
    }
    Panels panels(std::move(*interface));
    panels.set_visible(!choice.hides_panels);
    return panels;
}

// A window and its panels, which are made when they are first needed: while the scene opens, or for
// an error. Destroy it while the window is open.
class ViewerWindow {
public:
    ViewerWindow(const ViewerChoice& choice, platform::Window& window)
        : choice_(choice), window_(window) {}

    [[nodiscard]] platform::Window& window() const { return window_; }
    Result<Panels>& panels() {
        if (!panels_) {
            panels_.emplace(make_panels(choice_, window_));
        }
        return *panels_;
    }

private:
    const ViewerChoice& choice_;
    platform::Window& window_;
    std::optional<Result<Panels>> panels_;
};

Result<std::unique_ptr<platform::Window>> open_window(const ViewerChoice& choice) {
    platform::ContextOptions options;
    options.size = choice.view.size;
    options.title = "reljef - opening " + choice.terrain.terrain;
    return platform::make_window(options);
}

Result<VideoFile> open_video(const std::filesystem::path& file, glm::ivec2 size,
                             double frames_per_second) {
    auto made = make_frame_sink(file, {.size = size,
                                       .frames = 2, // more than one
                                       .frames_per_second = frames_per_second});
    if (!made) {
        return made.error();
    }
    const std::shared_ptr<FrameSink> sink = std::move(*made);
    return VideoFile{
        [sink](const Image& picture, int index) { return sink->write(picture, index); },
        [sink]() -> Result<void> {
            std::vector<AtomicFile> outputs;
            if (auto finished = sink->finish(outputs); !finished) {
                return finished;
            }
            return commit_all(outputs);
        }};
}

// Without the time when the program began, the command's.
FrameTimer make_timer(const ViewerChoice& choice) {
    if (!choice.prints_times) {
        return {};
    }
    const auto age = program_age();
    return FrameTimer(
        {[age = age ? *age : 0.0, since = Stopwatch()] { return age + since.seconds(); },
         wait_for_gpu});
}

void print_times(const ViewerChoice& choice, const FrameTimer& timer) {
    if (choice.prints_times) {
        const TimeReport report = timer.times().report();
        fmt::print("{}", choice.prints_json ? json_of(report) + '\n' : text_of(report));
    }
}

// For work in the background after the window was closed.
constexpr std::chrono::milliseconds longest_background{500};

struct ShownBy {
    platform::Window& window;
    session::SceneRenderer& renderer;
    ComparedFrames::MakeRenderer make_renderer; ///< another one
    Panels* panels = nullptr;                   ///< null: none
};

Result<void> fly(const ShownBy& shown, OpenedScene& opened, const ViewerChoice& choice,
                 MessageHistory& log, const cli::Interrupt& interrupt) {
    platform::Window& window = shown.window;
    session::SceneRenderer& renderer = shown.renderer;
    session::TerrainScene& scene = opened.scene;
    auto path =
        session::open_path(scene, choice.view.path.empty() ? "flyover" : choice.view.path, log);
    if (!path) {
        return path.error();
    }
    if (opened.light != nullptr) {
        renderer.add_light(std::exchange(opened.light, nullptr));
    }
    if (!choice.terrain.quiet && !choice.prints_json) {
        fmt::print("{}", Viewer::keys());
        std::fflush(stdout);
    }
    if (const session::Lift lift =
            choice.view.allow_underground ? session::Lift{} : session::lift_camera(scene)) {
        log.note(session::lift_note(lift, cli::camera_source(choice.view, choice.terrain)));
    }
    Viewer viewer(scene, std::move(*path), window.framebuffer_size(),
                  {.maps = {choice.terrain.threads, renderer.max_texture_side()},
                   .allow_underground = choice.view.allow_underground,
                   .proves_errors = choice.terrain.index != session::IndexUse::none,
                   .terrain = choice.terrain.terrain,
                   .bookmarks = bookmark_file()});
    if (!choice.view.path.empty()) {
        viewer.toggle_path();
        if (viewer.path_desk().path().keys().size() == 1) {
            log.note(fmt::format("{}: one keyframe found, at least two were expected; the view "
                                 "rests there",
                                 choice.view.path));
        }
    }
    FrameTimer timer = make_timer(choice);
    auto done = run_window_loop(window, renderer, scene, viewer, log, interrupt.token(),
                                {.frames = choice.frames_given ? choice.view.frames : 0,
                                 .samples = choice.view.samples,
                                 .open_video = open_video,
                                 .start = start_options(choice),
                                 .make_renderer = shown.make_renderer,
                                 .panels = shown.panels,
                                 .timer = &timer,
                                 .finer = std::move(opened.finer)});
    print_times(choice, timer);
    std::fflush(stdout);
    interrupt.end_after(longest_background);
    interrupt.request_stop();
    return done;
}

// Without a GPU, rays draw what they can; OpenGL draws all else in the same window.
session::RayUse rays_of(const ViewerChoice& choice, platform::Window& window) {
    if (choice.view.context == session::BackendKind::cpu) {
        return session::RayUse::only;
    }
    const bool is_chosen = choice.view.context.has_value();
    return is_chosen || !window.context().is_software() ? session::RayUse::none
                                                        : session::RayUse::preferred;
}

Result<session::SceneRenderer> make_renderer(const ViewerChoice& choice, platform::Window& window,
                                             session::RayUse rays) {
    const int samples = choice.view.samples.value_or(view::automatic_samples);
    const glm::ivec2 size = window.framebuffer_size();
    session::SceneRendererOptions options;
    options.threads = static_cast<unsigned>(choice.terrain.threads);
    options.opengl = {.size = size,
                      .shader_dir = choice.view.shader_dir,
                      .software = window.context().is_software(),
                      .samples = samples};
    if (rays != session::RayUse::none) {
        const auto target = session::simd_target_of(choice.view.simd);
        if (!target) {
            return target.error();
        }
        options.rays = {.size = size,
                        .threads = static_cast<unsigned>(choice.terrain.threads),
                        .samples = samples,
                        .target = *target};
        options.expects_rays = rays == session::RayUse::only;
        options.prefers_triangles = rays == session::RayUse::preferred;
    }
    return session::SceneRenderer::create(options);
}

Result<void> show(const ViewerChoice& choice, ViewerWindow& shown, Opening& opening,
                  const cli::Interrupt& interrupt) {
    platform::Window& window = shown.window();
    const session::RayUse rays = rays_of(choice, window);
    auto renderer = make_renderer(choice, window, rays);
    if (!renderer) {
        return renderer.error();
    }
    if (auto used = use_calibration(choice.view, platform::info_of(window.context()), *renderer);
        !used) {
        return used;
    }
    cli::ConsoleLog console(choice.terrain.quiet);
    MessageHistory log(console, choice.prints_json ? stderr : stdout);
    opening.begin(rays, renderer->max_texture_side());
    auto& panels = shown.panels(); // meanwhile
    if (!panels) {
        log.note(panels.error().message);
    } else if (!panels->note().empty()) {
        log.note(panels->note());
    }
    auto opened = opening.finish(window, log, interrupt.source());
    if (!opened) {
        return opened.error();
    }
    if (!*opened) {
        print_times(choice, {});
        return {};
    }
    return fly({window, *renderer, [&] { return make_renderer(choice, window, rays); },
                panels ? &*panels : nullptr},
               **opened, choice, log, interrupt);
}

// The error stands on stderr at once, and in the window until the user closes it. Returns whether
// it does.
bool show_error(const Error& error, const ViewerChoice& choice, ViewerWindow& shown,
                const cli::Interrupt& interrupt) {
    if (choice.frames_given || interrupt.requested()) {
        return false;
    }
    auto& panels = shown.panels();
    if (!panels) {
        return false;
    }
    cli::write_error("reljef", error);
    show_failure(shown.window(), *panels, error.message, interrupt.token());
    return true;
}

struct Viewed {
    Result<void> result;
    bool has_written_error = false; // of the result
};

Viewed view(ViewerChoice choice, const cli::Interrupt& interrupt) {
    const auto description = session::describe(choice.terrain.terrain);
    if (!description) {
        return {description.error()}; // without a window
    }
    if (!choice.view.samples) {
        choice.view.samples = description->samples;
    }
    session::limit_software_threads(choice.terrain.threads);
    session::set_driver_cache();
    interrupt.end_after(cli::Interrupt::longest_frame);
    // A path may follow the ground.
    const FirstSamples first = choice.view.path.empty() ? FirstSamples::few : FirstSamples::all;
    Opening opening(choice.terrain, choice.view, first);
    auto window = open_window(choice);
    if (!window) {
        return {Error{window.error().message + "; without a window there is 'reljef render'"}};
    }
    ViewerWindow shown(choice, **window);
    auto result = show(choice, shown, opening, interrupt);
    const bool shows_error = !result && show_error(result.error(), choice, shown, interrupt);
    return {std::move(result), shows_error};
}

} // namespace

cli::Command add_view_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand("view", "fly through a terrain in a window");
    auto choice = std::make_shared<ViewerChoice>();
    cli::add_terrain_options(*arguments, choice->terrain);
    choice->view.default_grain = 1.0;
    cli::add_view_options(*arguments, choice->view);
    add_object_options(*arguments, choice->view.objects, choice->view.footprints);
    add_light_option(*arguments, choice->view.lights);
    add_point_light_option(*arguments, choice->view.point_lights);
    add_surface_shader_option(*arguments, choice->view.surface_shader);
    cli::add_samples_option(*arguments, choice->view);
    cli::add_index_option(*arguments, choice->terrain, session::IndexUse::existing);
    arguments->add_flag("--no-panels", choice->hides_panels,
                        "hide the panels until Tab shows them");
    auto* stats = arguments->add_flag(
        "--stats", choice->prints_times,
        "when the window closes, print how long the first picture, frames, panels, and answers to "
        "keys and clicks took; panels are waited for, so frames take a little longer");
    arguments->add_flag("--json", choice->prints_json, "with --stats: print JSON, not the keys")
        ->needs(stats);
    arguments->callback([choice] {
        cli::check_view_options(choice->view);
        const glm::ivec2 size = choice->view.size;
        if (std::max(size.x, size.y) > session::max_frame_side) {
            throw CLI::ValidationError(
                fmt::format("--size: {}x{} found, at most {} a side was expected", size.x, size.y,
                            session::max_frame_side));
        }
        const auto context = choice->view.context;
        const bool has_window = !context || *context == session::BackendKind::glfw ||
                                *context == session::BackendKind::cpu;
        if (!has_window) {
            throw CLI::ValidationError(fmt::format(
                "--context: {} found, but view needs a window: auto, glfw or cpu was expected",
                session::to_string(*context)));
        }
    });
    arguments->footer(
        "Keys:\n" + Viewer::keys() +
        "With --path, the flight begins at once. Without it, P flies over the terrain. A view "
        "without\nmotion is not drawn again. With --frames N, the window draws N frames and "
        "closes. Ctrl-C\ncloses the window as Esc does, with exit status 0, or at once with the "
        "status of the\n"
        "signal (130) if a frame takes longer than a second.\n"
        "Examples:\n"
        "  reljef view natural\n"
        "  reljef view N45E006.hgt --camera 45.60,6.70,5200,20,-18\n"
        "  reljef view dem.tif --imagery photo.tif --path orbit\n"
        "  reljef view urban --technique texture --size 1600x900");
    const auto viewed = std::make_shared<Viewed>();
    return {arguments,
            [arguments, choice, viewed, &interrupt] {
                choice->frames_given = arguments->count("--frames") > 0;
                choice->named_terrain = choice->terrain.terrain;
                return cli::with_standard_input(choice->terrain.terrain, interrupt.token(), [&] {
                    *viewed = view(*choice, interrupt);
                    return viewed->result;
                });
            },
            [viewed] { return viewed->has_written_error; }};
}

} // namespace reljef::app
