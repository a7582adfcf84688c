#include "app/viewer/opening.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "app/viewer/viewer.h"
#include "engine/core/check.h"
#include "engine/core/stopwatch.h"
#include "engine/terrain/field/coarse_terrain.h"

namespace reljef::app {
namespace {

// Between two updates of the progress.
constexpr std::chrono::milliseconds opening_pause{5};

bool asks_to_end(const std::vector<Event>& events) {
    return std::any_of(events.begin(), events.end(), [](const Event& event) {
        const auto* const key = std::get_if<KeyEvent>(&event);
        return std::holds_alternative<CloseEvent>(event) ||
               (key != nullptr && key->pressed && key->key == Key::escape);
    });
}

class ProgressDisplay {
public:
    ProgressDisplay(platform::Window& window, session::Log& log) : window_(window), log_(log) {}

    void show(const session::RelayedLog::TaskProgress& progress) {
        if (progress.label != label_) {
            label_ = progress.label;
            task_ = label_.empty() ? nullptr : log_.start(label_);
        }
        if (task_ != nullptr) {
            task_->update(progress.fraction);
            show_title(fmt::format("reljef - {} {:.0f} %", label_, 100.0 * progress.fraction));
        }
    }

private:
    // A new title is an event, which would end the wait for events at once.
    void show_title(std::string title) {
        if (title != title_) {
            window_.set_title(title);
            title_ = std::move(title);
        }
    }

    platform::Window& window_;
    session::Log& log_;
    std::string title_;
    std::string label_;
    std::unique_ptr<session::Task> task_;
};

session::SourceOptions streamed(session::SourceOptions terrain) {
    terrain.streamed = true;
    return terrain;
}

// A scene that begins with fewer samples has these first: they take less than a tenth of a second.
constexpr std::size_t first_samples = 250'000;

// Whether nothing was put on the exact ground, and all samples would take long.
bool can_begin_coarse(const session::TerrainSource& source, const session::SceneOptions& view) {
    const io::SceneDescription& scene = source.description;
    const terrain::Heightfield& field = source.terrain.heightfield;
    const bool is_plain = scene.generator.empty() && !source.stream && !view.technique &&
                          scene.objects.empty() && scene.footprints.empty() &&
                          scene.point_lights.empty() && view.objects.empty() &&
                          view.footprints.empty() && view.point_lights.empty();
    const bool has_camera = view.eye || view.geodetic || view.pose || scene.eye;
    const geo::GlobalWrap wrap =
        field.georeference ? field.georeference->geodetic.rows().wrap() : geo::GlobalWrap{};
    return is_plain && !has_camera && !wrap.around && wrap.rows() == 0 &&
           field.heights.size() > 2 * first_samples &&
           std::min(field.heights.cols(), field.heights.rows()) >= 2;
}

// The viewer makes the maps, and shows a coarser picture first.
session::SceneOptions without_maps(session::SceneOptions view) {
    view.prepares_maps = false;
    return view;
}

// Between two frames of a window without a scene.
constexpr std::chrono::milliseconds failure_pause{100};

} // namespace

Opening::Opening(const session::SourceOptions& terrain, const session::SceneOptions& view,
                 FirstSamples first)
    : terrain_(streamed(terrain)), view_(without_maps(view)), first_(first),
      reading_([this](const std::stop_token& stop) {
          return session::open_source(terrain_, view_, relayed_, stop);
      }) {}

Result<OpenedScene> Opening::open(const session::SceneOptions& view, int largest_side,
                                  const std::stop_token& stop) {
    const std::stop_callback stops_reading(stop, [this] { reading_.request_stop(); });
    auto source = reading_.take();
    if (!source) {
        return source.error();
    }
    std::shared_ptr<const terrain::Terrain> finer;
    if (first_ == FirstSamples::few && can_begin_coarse(*source, view)) {
        finer = std::make_shared<const terrain::Terrain>(std::move(source->terrain));
        source->terrain = terrain::coarse_terrain(*finer, first_samples);
    }
    auto scene = session::open_scene(std::move(*source), terrain_, view, relayed_, stop);
    if (!scene) {
        return scene.error();
    }
    OpenedScene opened{std::move(*scene), nullptr, std::move(finer)};
    const auto light =
        session::light_request(opened.scene, *opened.scene.light->get<scene::Light>(),
                               first_technique(opened.scene), largest_side);
    if (light) {
        const auto task = relayed_.start("lighting " + light->surface->terrain().name);
        opened.light = std::make_shared<const view::PreparedLight>(view::prepare_light(*light));
    }
    return opened;
}

void Opening::begin(session::RayUse rays, int largest_side) {
    session::SceneOptions view = view_;
    view.rays = rays;
    opening_.emplace([this, view = std::move(view), largest_side](const std::stop_token& stop) {
        return open(view, largest_side, stop);
    });
}

Result<std::optional<OpenedScene>> Opening::finish(platform::Window& window, session::Log& log,
                                                   std::stop_source stop) {
    check(opening_.has_value(), "an opening that has begun was expected");
    Background<OpenedScene>& opening = *opening_;
    ProgressDisplay display(window, log);
    while (!opening.is_done()) {
        if (asks_to_end(window.wait_events(opening_pause)) || window.should_close()) {
            stop.request_stop();
        }
        if (stop.stop_requested()) {
            opening.request_stop();
        }
        relayed_.relay_to(log);
        display.show(relayed_.progress());
    }
    relayed_.relay_to(log);
    auto opened = opening.take();
    if (stop.stop_requested()) {
        return std::optional<OpenedScene>();
    }
    return opened ? Result<std::optional<OpenedScene>>(std::move(*opened)) : opened.error();
}

void show_failure(platform::Window& window, Panels& panels, const std::string& sentence,
                  const std::stop_token& stop) {
    if (!panels.has_room(window.framebuffer_size())) {
        return;
    }
    window.set_title("reljef - " + sentence);
    Stopwatch since_last;
    while (!stop.stop_requested() && !window.should_close()) {
        panels.draw_failure(sentence, window.framebuffer_size(), since_last.restart());
        window.swap_buffers();
        if (asks_to_end(window.wait_events(failure_pause))) {
            return;
        }
    }
}

} // namespace reljef::app
