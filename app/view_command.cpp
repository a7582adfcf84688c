#include <chrono>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/command.h"
#include "app/options.h"
#include "app/scene_setup.h"
#include "app/viewer.h"
#include "engine/io/image.h"
#include "engine/platform/window.h"
#include "engine/render/driver.h"

namespace reljef::app {
namespace {

using Clock = std::chrono::steady_clock;

struct ViewerChoice {
    TerrainChoice terrain;
    ViewChoice view;
    bool frames_given = false;
};

constexpr std::chrono::milliseconds between_titles{500};
// How long a still window waits for an event before it looks whether it was asked to stop.
constexpr std::chrono::milliseconds still{100};

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// The loop between the window, what the viewer decides, and the driver.
class WindowLoop {
public:
    WindowLoop(platform::Window& window, render::Driver& driver, TerrainScene& scene, Viewer& viewer)
        : window_(window), driver_(driver), scene_(scene), viewer_(viewer) {}

    /// Runs until the user ends it, or `frames` are drawn (0: no limit).
    Result<void> run(int frames, const Interrupt& interrupt) {
        auto before = Clock::now();
        while (!viewer_.wants_to_close() && !window_.should_close() && !interrupt.requested()) {
            receive(viewer_.is_moving() ? window_.poll_events() : window_.wait_events(still));
            viewer_.advance(seconds_since(before));
            before = Clock::now();
            if (auto served = serve_requests(); !served) {
                return served;
            }
            if (viewer_.take_redraw()) {
                if (auto drawn = draw(); !drawn) {
                    return drawn;
                }
                if (++drawn_ == frames) {
                    break;
                }
            }
            show_title();
        }
        return {};
    }

private:
    void receive(const std::vector<Event>& events) {
        for (const Event& event : events) {
            if (!scene_.scene.dispatch(event)) {
                viewer_.receive(event);
            }
        }
        if (viewer_.wants_mouse() != mouse_captured_) {
            mouse_captured_ = viewer_.wants_mouse();
            window_.capture_mouse(mouse_captured_);
        }
    }

    Result<void> serve_requests() {
        if (viewer_.take_help_request()) {
            fmt::print("{}", viewer_keys());
            std::fflush(stdout);
        }
        if (viewer_.take_screenshot_request()) {
            const auto file = next_screenshot(".");
            const auto written = io::write_image(file, driver_.read_color());
            // A folder that cannot be written is no reason to end the flight.
            fmt::print("{}\n", written ? "saved " + file.filename().string() : written.error().message);
            std::fflush(stdout);
        }
        return {};
    }

    Result<void> draw() {
        const glm::ivec2 size = window_.framebuffer_size();
        if (size.x == 0 || size.y == 0) {
            return {}; // minimized
        }
        if (size != driver_.size()) {
            if (auto resized = driver_.resize(size); !resized) {
                return resized;
            }
        }
        const auto start = Clock::now();
        const auto stats = driver_.draw(scene_.scene, true);
        if (!stats) {
            return stats.error();
        }
        driver_.show_in_window(size);
        window_.swap_buffers();
        stats_ = *stats;
        frame_ms_ = 1000.0 * seconds_since(start);
        return {};
    }

    void show_title() {
        if (Clock::now() - titled_ >= between_titles) {
            titled_ = Clock::now();
            window_.set_title(viewer_.title(stats_, frame_ms_));
        }
    }

    platform::Window& window_;
    render::Driver& driver_;
    TerrainScene& scene_;
    Viewer& viewer_;
    render::FrameStats stats_;
    double frame_ms_ = 0.0;
    int drawn_ = 0;
    bool mouse_captured_ = false;
    Clock::time_point titled_;
};

// The path that was named, or the flight over the terrain.
Result<scene::FlyPath> path_or_flyover(const TerrainScene& scene, ViewChoice view) {
    if (view.path.empty()) {
        view.path = "flyover";
    }
    auto path = open_path(scene, view);
    if (!path) {
        return path.error();
    }
    return std::move(**path);
}

Result<std::unique_ptr<platform::Window>> open_window(const ViewChoice& view) {
    if (view.context && *view.context != platform::ContextKind::glfw) {
        return Error{fmt::format("--context: {} found, view needs a window: auto or glfw was expected",
                                 platform::to_string(*view.context))};
    }
    platform::ContextOptions options;
    options.size = view.size;
    return platform::make_window(options);
}

Result<void> view(const ViewerChoice& choice, const Interrupt& interrupt) {
    auto window = open_window(choice.view);
    if (!window) {
        return window.error();
    }
    auto source = open_terrain(choice.terrain, interrupt.token());
    if (!source) {
        return source.error();
    }
    auto scene = make_scene(std::move(*source), choice.terrain, choice.view);
    if (!scene) {
        return scene.error();
    }
    auto path = path_or_flyover(*scene, choice.view);
    if (!path) {
        return path.error();
    }
    auto driver = render::Driver::create({.size = (*window)->framebuffer_size(),
                                          .shader_dir = choice.view.shader_dir,
                                          .software = (*window)->context().is_software()});
    if (!driver) {
        return driver.error();
    }
    if (!choice.terrain.quiet) {
        fmt::print("{}", viewer_keys());
        std::fflush(stdout);
    }
    Viewer viewer(*scene, std::move(*path));
    if (!choice.view.path.empty()) {
        viewer.toggle_path();
    }
    return WindowLoop(**window, *driver, *scene, viewer)
        .run(choice.frames_given ? choice.view.frames : 0, interrupt);
}

} // namespace

Command add_view_command(CLI::App& program, Interrupt& interrupt) {
    auto* arguments = program.add_subcommand("view", "fly through a terrain in a window");
    auto choice = std::make_shared<ViewerChoice>();
    add_terrain_options(*arguments, choice->terrain);
    add_view_options(*arguments, choice->view);
    arguments->footer("Keys:\n" + viewer_keys() +
                      "With --path the flight begins at once. With --frames N the window closes after N "
                      "drawn frames; a still picture is not drawn again.\n"
                      "Examples:\n"
                      "  reljef view natural\n"
                      "  reljef view N45E006.hgt --camera 45.60,6.70,5200,20,-18\n"
                      "  reljef view dem.tif --imagery photo.tif --path orbit\n"
                      "  reljef view urban --technique texture --size 1600x900");
    return {arguments, [arguments, choice, &interrupt] {
                choice->frames_given = arguments->count("--frames") > 0;
                return view(*choice, interrupt);
            }};
}

} // namespace reljef::app
