#include "app/viewer/window_loop.h"

#include <chrono>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "app/viewer/comparing/compared_frames.h"
#include "app/viewer/filming.h"
#include "app/viewer/message_history.h"
#include "app/viewer/motion_quality.h"
#include "app/viewer/timing/recent_times.h"
#include "app/viewer/viewer_content.h"
#include "engine/core/stopwatch.h"
#include "engine/io/image/image.h"
#include "engine/session/streaming.h"

namespace reljef::app {
namespace {

constexpr double seconds_between_titles = 0.5;
constexpr double seconds_between_panels = 0.1; // at rest, while messages or progress change
// Longest waits for an event.
constexpr std::chrono::milliseconds no_wait{0};
constexpr std::chrono::milliseconds still{100};          // nothing moves
constexpr std::chrono::milliseconds preparing_pause{20}; // shows the progress of maps
constexpr std::chrono::milliseconds stuck{10};           // moves without a visible change

class WindowLoop {
public:
    WindowLoop(platform::Window& window, session::SceneRenderer& renderer,
               session::TerrainScene& scene, Viewer& viewer, MessageHistory& log,
               const WindowLoopOptions& options)
        : window_(window), renderer_(renderer), scene_(scene), viewer_(viewer), messages_(log),
          options_(options), samples_(options.samples), panels_(options.panels),
          compared_(scene, renderer, viewer.comparison(), options.make_renderer),
          filming_(scene, viewer, log, options.open_video),
          timer_(options.timer != nullptr ? *options.timer : no_timer_) {}

    Result<void> run(const std::stop_token& stop) {
        Stopwatch step;
        while (!is_over() && !stop.stop_requested()) {
            refine_after_first_frame();
            receive(window_.wait_events(pause()));
            if (filming_.is_on()) {
                film();
                step.restart();
                continue;
            }
            ask_panels();
            act();
            viewer_.advance(step.restart());
            has_drawn_ = false;
            const bool has_new_tiles = session::take_arrivals(scene_.scene);
            if (viewer_.take_redraw() || options_.frames > 0 || has_new_tiles || is_to_sharpen()) {
                if (auto drawn = draw(); !drawn) {
                    if (!viewer_.undo_technique()) {
                        return drawn;
                    }
                    messages_.note(drawn.error().message);
                }
            } else if (auto shown = refresh_window(); !shown) {
                return shown;
            }
            session::log_stream_errors(scene_.scene, messages_);
            viewer_.relay_to(messages_);
            log_raised_path();
            serve_requests();
            show_title();
            timer_.end_round(open_work());
        }
        return {};
    }

private:
    void refine_after_first_frame() {
        if (drawn_ > 0 && options_.finer != nullptr) {
            viewer_.refine(std::exchange(options_.finer, nullptr));
        }
    }

    [[nodiscard]] bool is_over() const {
        return viewer_.wants_to_close() || window_.should_close() ||
               (options_.frames > 0 && drawn_ == options_.frames);
    }

    [[nodiscard]] OpenWork open_work() const {
        return {.is_preparing = viewer_.is_preparing() || options_.finer != nullptr,
                .is_loading = session::awaits_tiles(scene_.scene),
                .has_actions = !actions_.empty(),
                .is_stale = panels_ != nullptr && panels_->is_stale(),
                .is_reduced = is_to_sharpen()};
    }

    // Whether a view at rest was drawn with reduced quality.
    [[nodiscard]] bool is_to_sharpen() const {
        return resamples_ || (quality_.is_reduced() && !viewer_.is_moving());
    }

    [[nodiscard]] std::chrono::milliseconds pause() const {
        if (drawn_ == 0 || filming_.is_on() || awaits_errors() ||
            (panels_ != nullptr && panels_->is_stale())) {
            return no_wait;
        }
        if (viewer_.is_preparing() && !viewer_.is_moving()) {
            return preparing_pause;
        }
        if (!viewer_.is_moving() && options_.frames == 0 && !session::awaits_tiles(scene_.scene)) {
            return still;
        }
        return has_drawn_ ? no_wait : stuck;
    }

    // Selects the view and requests its tiles and those of the next seconds without waiting.
    void select(int samples_of_frame) {
        std::vector<view::TileRequests> requests = renderer_.select(scene_.scene).requests;
        auto of_the_right = compared_.select(samples_of_frame);
        std::move(of_the_right.begin(), of_the_right.end(), std::back_inserter(requests));
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
            timer_.receive(event, open_work());
            if (filming_.is_on()) {
                if (!is_for_panels(event)) {
                    filming_.receive(event);
                }
                continue;
            }
            if (const auto* move = std::get_if<MouseMoveEvent>(&event)) {
                pointer_ = move->position;
            }
            if (!is_for_panels(event) && !scene_.scene.dispatch(event)) {
                viewer_.receive(event);
            }
        }
        if (viewer_.wants_mouse() != mouse_captured_) {
            mouse_captured_ = viewer_.wants_mouse();
            window_.capture_mouse(mouse_captured_);
        }
    }

    // One frame of the video, which the window shows, too.
    void film() {
        const auto draw = [this](glm::ivec2 size) -> Result<bool> {
            if (auto drawn = draw_at({}, size); !drawn) {
                return drawn.error();
            }
            if (const glm::ivec2 shown = window_.framebuffer_size(); shown.x > 0 && shown.y > 0) {
                if (auto done = renderer_.show_in_window(shown); !done) {
                    return done.error();
                }
                draw_panels(shown);
                window_.swap_buffers();
                timer_.show(open_work());
            }
            return !session::awaits_tiles(scene_.scene);
        };
        filming_.film(draw, [this] { return renderer_.read_color(); });
        act(); // its panel may cancel it
        window_.set_title(
            fmt::format("reljef - video {:.0f} % - Esc cancels", 100.0 * filming_.progress()));
        title_.clear();
    }

    // A captured mouse has no place on the window.
    bool is_for_panels(const Event& event) {
        const bool is_mouse = std::holds_alternative<MouseMoveEvent>(event) ||
                              std::holds_alternative<MouseButtonEvent>(event) ||
                              std::holds_alternative<ScrollEvent>(event);
        return panels_ != nullptr && !(is_mouse && mouse_captured_) && panels_->receive(event);
    }

    [[nodiscard]] bool shows_panels() const { return panels_ != nullptr && panels_->is_visible(); }

    [[nodiscard]] std::optional<PlaceContent> place_under_pointer(glm::ivec2 size) const {
        const bool is_outside =
            pointer_.x < 0.0 || pointer_.y < 0.0 || pointer_.x >= size.x || pointer_.y >= size.y;
        if (is_outside || mouse_captured_ || panels_->is_over_panel(pointer_)) {
            return std::nullopt;
        }
        const auto picked = viewer_.place_at_pixel(pointer_);
        return picked ? std::optional(place_of(scene_, *picked)) : std::nullopt;
    }

    PanelContent content(glm::ivec2 size) {
        const auto* surface = scene_.terrain->get<scene::TerrainNode>()->surface.get();
        if (std::exchange(legend_of_, surface) != surface) {
            legend_ = legend_of(scene_);
        }
        PanelContent content = content_of(viewer_, scene_, size);
        content.frame = {stats_,           timing_.last_ms,  timing_.frames_per_second,
                         recent_ms_.all(), renderer_.size(), size};
        content.appearance.samples = samples_;
        if (viewer_.comparison().with() == CompareWith::technique) {
            content.compare.right_ms = compared_.right_ms();
        }
        content.compare.left_ms = left_ms_;
        content.cursor = place_under_pointer(size);
        if (filming_.is_on()) {
            content.path.video = filming_.progress();
        }
        content.legend = legend_;
        content.messages = messages_.messages();
        return content;
    }

    // Precondition: the picture is in the back buffer.
    void draw_panels(glm::ivec2 size) {
        FrameTimer::PanelScope timed(timer_);
        if (!shows_panels()) {
            return;
        }
        const bool is_due = panels_->is_due(size, since_panels_.seconds());
        timed.set(is_due ? PanelWork::drawn : PanelWork::copied);
        if (is_due) {
            actions_ += panels_->draw(content(size), size, since_panels_.restart());
        } else {
            panels_->show_again();
        }
    }

    // What is done to them takes effect in the next frame, which draws them again over its picture.
    void ask_panels() {
        constexpr int max_events = 4; // a press and its release need a frame each
        const glm::ivec2 size = window_.framebuffer_size();
        const bool has_frame = drawn_ > 0 && size.x > 0 && size.y > 0;
        for (int i = 0; has_frame && i < max_events && shows_panels() && panels_->has_input();
             ++i) {
            draw_panels(size);
            panels_->refresh(); // the frame shows what they became
        }
    }

    // Whether the view is drawn as it stays, so that it can be compared with the truth.
    [[nodiscard]] bool awaits_errors() const {
        return drawn_ > 0 && viewer_.comparison().awaits_view() && !viewer_.is_moving() &&
               !viewer_.is_preparing() && !is_to_sharpen() && !session::awaits_tiles(scene_.scene);
    }

    // Draws the window again over the last picture if its panels, or what it is compared with,
    // changed.
    Result<void> refresh_window() {
        if (awaits_errors()) {
            if (const auto begun = compared_.find_errors(); !begun) {
                messages_.note(begun.error().message);
            }
        }
        const bool is_compared_anew = viewer_.comparison().update();
        const bool is_busy =
            shows_panels() &&
            (messages_.youngest() < message_seconds + 1.0 || !viewer_.progress().label.empty() ||
             viewer_.comparison().is_busy()) &&
            since_panels_.seconds() > seconds_between_panels;
        const glm::ivec2 size = window_.framebuffer_size();
        if (viewer_.take_content_change() && panels_ != nullptr) {
            panels_->refresh();
        }
        const bool is_stale = panels_ != nullptr && panels_->is_stale();
        if (drawn_ == 0 || !(is_stale || is_busy || is_compared_anew) || size.x == 0 ||
            size.y == 0) {
            return {};
        }
        if (auto shown = compared_.show(size); !shown) {
            return shown;
        }
        if (shows_panels()) {
            draw_panels(size);
        } else if (panels_ != nullptr) {
            panels_->draw({}, size, 0.0); // nothing, once
        }
        window_.swap_buffers();
        timer_.show(open_work());
        return {};
    }

    void act() {
        timer_.act(actions_.size());
        for (const PanelAction& action : std::exchange(actions_, {})) {
            std::visit([this](const auto& chosen) { act_on(chosen); }, action);
        }
    }

    template <class Action> void act_on(const Action& action) {
        if (const auto done = viewer_.act(action); !done) {
            messages_.note(done.error().message);
        }
    }
    void act_on(const SetSamples& set) {
        samples_ = set.samples;
        resamples_ = true;
    }
    void act_on(const PressKey& press) {
        viewer_.receive(KeyEvent{.key = press.key, .pressed = true});
        viewer_.receive(KeyEvent{.key = press.key, .pressed = false});
    }
    void act_on(const CopyCommand& /*action*/) { copy_command(); }
    void act_on(const CancelVideo& /*action*/) { filming_.cancel(); }

    void copy_command() {
        const auto shown = shown_state(viewer_, scene_, window_.framebuffer_size(), samples_);
        const auto command = render_command(options_.start, scene_, shown);
        if (!command) {
            messages_.note(command.error().message);
            return;
        }
        window_.set_clipboard(*command);
        messages_.report(copied_text(*command, shown));
    }

    void log_raised_path() {
        if (viewer_.path_lifted() > 0.0 && !std::exchange(raise_logged_, true)) {
            messages_.note(
                "the path leads under the ground or too close to it: the camera is lifted there");
        }
    }

    void serve_requests() {
        if (viewer_.take_help_request()) {
            show_help();
        }
        if (viewer_.take_command_request()) {
            copy_command();
        }
        if (viewer_.take_video_request()) {
            filming_.begin(window_.framebuffer_size());
        }
        if (viewer_.take_screenshot_request()) {
            save_picture();
        }
        if (const auto text = viewer_.take_clipboard()) {
            window_.set_clipboard(*text);
        }
        messages_.report(viewer_.take_output());
    }

    void show_help() {
        if (panels_ != nullptr && panels_->has_room(window_.framebuffer_size())) {
            panels_->toggle_help();
        } else {
            messages_.report(Viewer::keys());
        }
    }

    // Failures are notes.
    void save_picture() {
        if (quality_.is_reduced()) {
            if (auto drawn = draw_at({}); !drawn) {
                messages_.note(drawn.error().message);
                return;
            }
        }
        const auto file = next_screenshot(".");
        if (const auto written = io::write_image(file, compared_.picture()); !written) {
            messages_.note(written.error().message);
            return;
        }
        messages_.report(fmt::format("saved {}\n", file.filename().string()));
    }

    Result<void> draw() {
        const glm::ivec2 size = window_.framebuffer_size();
        if (size.x == 0 || size.y == 0) {
            return {}; // minimized
        }
        const Stopwatch watch;
        const bool is_first = drawn_ == 0; // shown as early as possible, refined by the next one
        const FrameQuality quality =
            samples_ ? FrameQuality()
                     : quality_.choose(viewer_.is_moving() || is_first, renderer_.shows_rays());
        if (auto drawn = draw_at(quality); !drawn) {
            return drawn;
        }
        left_ms_ = watch.milliseconds();
        if (auto drawn = compared_.draw(); !drawn) {
            messages_.note(drawn.error().message);
            static_cast<void>(viewer_.comparison().set(CompareWith::nothing));
        }
        if (auto shown = compared_.show(size); !shown) {
            return shown;
        }
        timing_.last_ms = watch.milliseconds();
        timing_.divisor = quality.divisor;
        quality_.add_frame(timing_.last_ms);
        recent_ms_.add(timing_.last_ms);
        if (!is_first) {
            draw_panels(size);
        }
        window_.swap_buffers();
        timer_.show(open_work(), timing_.last_ms, watch.milliseconds());
        has_drawn_ = true;
        ++drawn_;
        ++drawn_since_title_;
        return {};
    }

    Result<void> draw_at(const FrameQuality& quality) {
        return draw_at(quality, quality.picture_size(window_.framebuffer_size()));
    }

    Result<void> draw_at(const FrameQuality& quality, glm::ivec2 size) {
        if (size != renderer_.size()) {
            if (auto resized = renderer_.resize(size); !resized) {
                return resized;
            }
        }
        renderer_.set_samples(samples_.value_or(quality.samples));
        renderer_.set_magnification(quality.divisor);
        resamples_ = false;
        while (auto light = viewer_.take_light()) {
            compared_.add_light(light);
            renderer_.add_light(std::move(light));
        }
        select(samples_.value_or(quality.samples));
        const auto stats = renderer_.draw_selected(true);
        if (!stats) {
            return stats.error();
        }
        stats_ = *stats;
        if (const std::string note = renderer_.take_note(); !note.empty()) {
            messages_.note(note);
        }
        return {};
    }

    void show_title() {
        const bool is_first = title_.empty();
        if (!is_first && since_title_.seconds() < seconds_between_titles) {
            return;
        }
        const double seconds = since_title_.restart();
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
    MessageHistory& messages_;
    WindowLoopOptions options_;
    std::optional<int> samples_; // absent: automatic
    bool resamples_ = false;     // since the last frame
    Panels* panels_;
    PanelActions actions_; // of the last frame of the panels
    Stopwatch since_panels_;
    glm::dvec2 pointer_{-1.0};
    RecentTimes recent_ms_;
    const scene::TerrainSurface* legend_of_ = nullptr; // whose colours the legend has
    std::vector<LegendStop> legend_;
    MotionQuality quality_;
    view::FrameStats stats_;
    FrameTiming timing_;
    double left_ms_ = 0.0; // of the technique's last frame, without what it is compared with
    std::string title_;
    Stopwatch since_title_;
    int drawn_ = 0;
    int drawn_since_title_ = 0;
    bool has_drawn_ = false; // in this iteration
    bool mouse_captured_ = false;
    bool raise_logged_ = false;
    ComparedFrames compared_;
    Filming filming_;
    FrameTimer no_timer_;
    FrameTimer& timer_;
};

} // namespace

Result<void> run_window_loop(platform::Window& window, session::SceneRenderer& renderer,
                             session::TerrainScene& scene, Viewer& viewer, MessageHistory& log,
                             const std::stop_token& stop, const WindowLoopOptions& options) {
    return WindowLoop(window, renderer, scene, viewer, log, options).run(stop);
}

} // namespace reljef::app
