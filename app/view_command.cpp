#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <optional>
#include <variant>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/console_log.h"
#include "app/cli/message.h"
#include "app/cli/options.h"
#include "app/commands.h"
#include "app/viewer/viewer.h"
#include "engine/io/image/image.h"
#include "engine/platform/window.h"
#include "engine/session/background.h"
#include "engine/session/device.h"
#include "engine/session/ground.h"
#include "engine/session/log.h"
#include "engine/session/scene_renderer.h"
#include "engine/session/scene_setup.h"
#include "engine/session/streaming.h"

namespace reljef::app {
namespace {

using Clock = std::chrono::steady_clock;

struct ViewerChoice {
    cli::TerrainChoice terrain;
    cli::ViewChoice view;
    bool frames_given = false;
};

constexpr std::chrono::milliseconds between_titles{500};
// A moving view whose frames take longer than this gets fewer samples a pixel.
constexpr double smooth_ms = 33.0;
// How long a still window waits for an event before it looks whether it was asked to stop.
constexpr std::chrono::milliseconds still{100};
// The same while the terrain is opened or maps are made: their progress is shown.
constexpr std::chrono::milliseconds opening_pause{20};
// The same where something moves and yet nothing new is seen.
constexpr std::chrono::milliseconds stuck{10};

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// The loop between the window, what the viewer decides, and the driver.
class WindowLoop {
public:
    WindowLoop(platform::Window& window, session::SceneRenderer& renderer,
               session::TerrainScene& scene, Viewer& viewer, session::Log& log,
               const ViewerChoice& choice)
        : window_(window), renderer_(renderer), scene_(scene), viewer_(viewer), log_(log),
          frames_(choice.frames_given ? choice.view.frames : 0),
          chooses_samples_(!choice.view.samples) {}

    Result<void> run(const cli::Interrupt& interrupt) {
        auto before = Clock::now();
        while (!is_over() && !interrupt.requested()) {
            receive(window_.wait_events(pause()));
            viewer_.advance(seconds_since(std::exchange(before, Clock::now())));
            has_drawn_ = false;
            const bool has_new_tiles = session::take_arrivals(scene_.scene);
            if (viewer_.take_redraw() || frames_ > 0 || has_new_tiles || is_to_sharpen()) {
                if (auto drawn = draw(); !drawn) {
                    return drawn;
                }
            }
            session::log_stream_faults(scene_.scene, log_);
            viewer_.relay_to(log_);
            log_raised_path();
            serve_requests();
            show_title();
        }
        return {};
    }

private:
    [[nodiscard]] bool is_over() const {
        return viewer_.wants_to_close() || window_.should_close() ||
               (frames_ > 0 && drawn_ == frames_);
    }

    // The view stands still, and was drawn with fewer samples than it may have.
    [[nodiscard]] bool is_to_sharpen() const { return is_reduced_ && !viewer_.is_moving(); }

    [[nodiscard]] std::chrono::milliseconds pause() const {
        if (viewer_.is_preparing() && !viewer_.is_moving()) {
            return drawn_ == 0 ? std::chrono::milliseconds(0) : opening_pause;
        }
        if (!viewer_.is_moving() && frames_ == 0 && !session::awaits_tiles(scene_.scene)) {
            return drawn_ == 0 ? std::chrono::milliseconds(0) : still;
        }
        return has_drawn_ || drawn_ == 0 ? std::chrono::milliseconds(0) : stuck;
    }

    // Selects the view and requests its tiles and those of the next seconds. The picture does not
    // wait for them: it shows what is there.
    void select() {
        std::vector<view::TileRequests> requests = renderer_.select(scene_.scene).requests;
        if (!requests.empty()) {
            for (const scene::Camera& camera : viewer_.upcoming()) {
                auto ahead = view::tile_requests(scene_.scene, camera, renderer_.size());
                std::move(ahead.begin(), ahead.end(), std::back_inserter(requests));
            }
            session::request_tiles(requests);
        }
    }

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

    // Once, when it happens first.
    void log_raised_path() {
        if (viewer_.path_raised() > 0.0 && !std::exchange(raise_logged_, true)) {
            log_.note("the path leads under the ground or too close to it: it is raised there");
        }
    }

    void serve_requests() {
        if (viewer_.take_help_request()) {
            fmt::print("{}", Viewer::keys());
        }
        if (viewer_.take_screenshot_request()) {
            save_picture();
        }
        std::fflush(stdout);
    }

    // A folder that cannot be written is no reason to end the flight.
    void save_picture() {
        const auto file = next_screenshot(".");
        if (const auto written = io::write_image(file, renderer_.read_color()); !written) {
            cli::tell(fmt::format("reljef: {}\n", written.error().message));
            return;
        }
        fmt::print("saved {}\n", file.filename().string());
    }

    // Where several samples a pixel are too slow for a view that moves, it has one; the still view
    // has several again.
    void choose_samples() {
        if (!chooses_samples_) {
            return;
        }
        const bool moves = viewer_.is_moving();
        is_reduced_ = moves && (is_reduced_ || timing_.last_ms > smooth_ms);
        renderer_.set_samples(is_reduced_ ? 1 : render::automatic_samples);
    }

    Result<void> draw() {
        const glm::ivec2 size = window_.framebuffer_size();
        if (size.x == 0 || size.y == 0) {
            return {}; // minimized
        }
        if (size != renderer_.size()) {
            if (auto resized = renderer_.resize(size); !resized) {
                return resized;
            }
        }
        const auto start = Clock::now();
        choose_samples();
        select();
        const auto stats = renderer_.draw_selected(true);
        if (!stats) {
            return stats.error();
        }
        renderer_.show_in_window(size);
        timing_.last_ms = 1000.0 * seconds_since(start);
        window_.swap_buffers();
        stats_ = *stats;
        has_drawn_ = true;
        ++drawn_;
        ++drawn_since_title_;
        return {};
    }

    void show_title() {
        const bool is_first = title_.empty();
        if (!is_first && Clock::now() - titled_ < between_titles) {
            return;
        }
        const double seconds = seconds_since(std::exchange(titled_, Clock::now()));
        timing_.frames_per_second.reset();
        if (!is_first && viewer_.is_moving() && drawn_since_title_ > 0) {
            timing_.frames_per_second = drawn_since_title_ / seconds;
        }
        drawn_since_title_ = 0;
        const std::string title = viewer_.title(stats_, timing_);
        if (title != std::exchange(title_, title)) {
            window_.set_title(title);
        }
    }

    platform::Window& window_;
    session::SceneRenderer& renderer_;
    session::TerrainScene& scene_;
    Viewer& viewer_;
    session::Log& log_;
    int frames_; // to draw, moving or not, before the window closes; 0: until the user ends it
    view::FrameStats stats_;
    FrameTiming timing_;
    std::string title_;
    Clock::time_point titled_;
    int drawn_ = 0;
    int drawn_since_title_ = 0;
    bool has_drawn_ = false; // in this turn of the loop
    bool mouse_captured_ = false;
    bool chooses_samples_;    // none were named
    bool is_reduced_ = false; // to one sample
    bool raise_logged_ = false;
};

Result<std::unique_ptr<platform::Window>> open_window(const ViewerChoice& choice) {
    session::limit_software_threads(choice.terrain.threads);
    platform::ContextOptions options;
    options.size = choice.view.size;
    options.title = "reljef - opening " + choice.terrain.terrain;
    return platform::make_window(options);
}

bool asks_to_end(const std::vector<Event>& events) {
    return std::any_of(events.begin(), events.end(), [](const Event& event) {
        const auto* const key = std::get_if<KeyEvent>(&event);
        return std::holds_alternative<CloseEvent>(event) ||
               (key != nullptr && key->pressed && key->key == Key::escape);
    });
}

// Shows the progress of work in the background in the window's title and on stderr.
class ProgressDisplay {
public:
    ProgressDisplay(platform::Window& window, session::Log& log) : window_(window), log_(log) {}

    void show(const session::RelayedLog::Progress& progress) {
        if (progress.label != label_) {
            label_ = progress.label;
            task_ = label_.empty() ? nullptr : log_.start(label_);
        }
        if (task_ != nullptr) {
            task_->update(progress.fraction);
            window_.set_title(
                fmt::format("reljef - {} {:.0f} %", label_, 100.0 * progress.fraction));
        }
    }

private:
    platform::Window& window_;
    session::Log& log_;
    std::string label_;
    std::unique_ptr<session::Task> task_;
};

// Opens the scene in the background, so that the window answers meanwhile. Nothing where the user
// closes it.
Result<std::optional<session::TerrainScene>> open_beside(platform::Window& window,
                                                         const ViewerChoice& choice,
                                                         session::Log& log,
                                                         const cli::Interrupt& interrupt) {
    using Opened = Result<session::TerrainScene>;
    session::RelayedLog relayed;
    session::Background<Opened> opening([&](const std::stop_token& stop) -> Opened {
        session::SourceOptions terrain = choice.terrain;
        terrain.streamed = session::may_stream(choice.view);
        terrain.pictures_streamed = session::may_stream_pictures(choice.view);
        session::SceneOptions view = choice.view;
        view.prepares_maps = false; // the viewer does, and shows a coarser picture meanwhile
        return session::open_scene(terrain, view, relayed, stop);
    });
    ProgressDisplay display(window, log);
    bool is_closed = false;
    while (!opening.is_done()) {
        is_closed =
            asks_to_end(window.wait_events(opening_pause)) || window.should_close() || is_closed;
        if (is_closed || interrupt.requested()) {
            opening.request_stop();
        }
        relayed.relay_to(log);
        display.show(relayed.progress());
    }
    relayed.relay_to(log);
    Opened scene = opening.take();
    if (is_closed) {
        return std::optional<session::TerrainScene>();
    }
    return scene ? Result<std::optional<session::TerrainScene>>(std::move(*scene)) : scene.error();
}

Result<void> view(const ViewerChoice& choice, const cli::Interrupt& interrupt) {
    auto window = open_window(choice);
    if (!window) {
        return Error{window.error().message + "; without a window there is 'reljef render'"};
    }
    cli::ConsoleLog log(choice.terrain.quiet);
    auto opened = open_beside(**window, choice, log, interrupt);
    if (!opened) {
        return opened.error();
    }
    if (!*opened) {
        return {};
    }
    session::TerrainScene& scene = **opened;
    auto path =
        session::open_path(scene, choice.view.path.empty() ? "flyover" : choice.view.path, log);
    if (!path) {
        return path.error();
    }
    auto renderer = session::SceneRenderer::create(
        {.driver = {.size = (*window)->framebuffer_size(),
                    .shader_dir = choice.view.shader_dir,
                    .software = (*window)->context().is_software(),
                    .samples = choice.view.samples.value_or(render::automatic_samples)}});
    if (!renderer) {
        return renderer.error();
    }
    if (!choice.terrain.quiet) {
        fmt::print("{}", Viewer::keys());
        std::fflush(stdout);
    }
    if (const session::Lift lift =
            choice.view.allow_underground ? session::Lift{} : session::lift_camera(scene)) {
        log.note(session::lift_note(lift, cli::camera_source(choice.view, choice.terrain).name));
    }
    Viewer viewer(scene, std::move(*path), (*window)->framebuffer_size(),
                  {choice.terrain.threads, choice.view.allow_underground});
    if (!choice.view.path.empty()) {
        viewer.toggle_path();
    }
    return WindowLoop(**window, *renderer, scene, viewer, log, choice).run(interrupt);
}

void expect_window(const cli::ViewChoice& view) {
    if (view.context && *view.context != platform::ContextKind::glfw) {
        throw CLI::ValidationError(
            fmt::format("--context: {} found, but view needs a window: auto or glfw was expected",
                        platform::to_string(*view.context)));
    }
}

} // namespace

cli::Command add_view_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand("view", "fly through a terrain in a window");
    auto choice = std::make_shared<ViewerChoice>();
    cli::add_terrain_options(*arguments, choice->terrain);
    cli::add_view_options(*arguments, choice->view);
    cli::add_samples_option(*arguments, choice->view);
    arguments->callback([choice] {
        cli::check_view_options(choice->view);
        expect_window(choice->view);
    });
    arguments->footer(
        "Keys:\n" + Viewer::keys() +
        "The flight along --path begins at once; without it, P flies over the terrain. "
        "Where\nnothing moves nothing is drawn, but with --frames N: then the window "
        "closes after N frames.\n"
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
