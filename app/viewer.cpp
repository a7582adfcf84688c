#include "app/viewer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "engine/scene/poses.h"
#include "engine/scene/technique.h"

namespace reljef::app {
namespace {

// Flying once across the terrain takes this long.
constexpr double seconds_across = 20.0;
// How close the eye comes to the ground, of the terrain's width.
constexpr double clearance_in_widths = 5e-4;

double width_of(const TerrainScene& scene) {
    return std::max(scene.bounds.size().x, scene.bounds.size().y);
}

scene::FreeFlight make_flight(const TerrainScene& scene) {
    return {*scene.camera->get<scene::Camera>(), width_of(scene) / seconds_across,
            std::max(0.5, clearance_in_widths * width_of(scene)),
            [&scene](double x, double y) { return scene.scene.height_at(x, y); }};
}

std::size_t index_of(scene::TechniqueId id) {
    const auto catalogue = scene::technique_catalogue();
    const auto found = std::find_if(catalogue.begin(), catalogue.end(),
                                    [&](const auto& info) { return info.id == id; });
    return static_cast<std::size_t>(found - catalogue.begin());
}

} // namespace

struct Viewer::Binding {
    Key key;
    Action action;
};

Viewer::Viewer(TerrainScene& scene, scene::FlyPath path)
    : scene_(scene), path_(std::move(path)), flight_(make_flight(scene)) {
    if (camera().projection == scene::ProjectionKind::perspective) {
        camera() = flight_.camera();
    }
}

void Viewer::receive(const Event& event) {
    if (std::holds_alternative<CloseEvent>(event)) {
        close_ = true;
    } else if (std::holds_alternative<ResizeEvent>(event)) {
        redraw_ = true;
    } else if (const auto* key = std::get_if<KeyEvent>(&event); key != nullptr && receive_key(*key)) {
        return;
    } else if (!is_map()) {
        flight_.receive(event);
    }
}

bool Viewer::receive_key(const KeyEvent& event) {
    const bool pressed = event.pressed && !event.repeat;
    if (event.key >= Key::digit1 && event.key <= Key::digit9) {
        if (pressed) {
            choose_technique(static_cast<std::size_t>(event.key) -
                             static_cast<std::size_t>(Key::digit1));
        }
        return true;
    }
    // viewer_keys() says in words what stands here.
    static constexpr std::array<Binding, 10> bindings{{{Key::p, &Viewer::toggle_path},
                                                       {Key::t, &Viewer::next_technique},
                                                       {Key::f, &Viewer::toggle_wireframe},
                                                       {Key::o, &Viewer::toggle_map},
                                                       {Key::m, &Viewer::toggle_mouse_look},
                                                       {Key::f12, &Viewer::ask_for_screenshot},
                                                       {Key::c, &Viewer::ask_for_screenshot},
                                                       {Key::h, &Viewer::ask_for_help},
                                                       {Key::f1, &Viewer::ask_for_help},
                                                       {Key::escape, &Viewer::leave}}};
    const auto* const found =
        std::find_if(bindings.begin(), bindings.end(),
                     [&](const Binding& binding) { return binding.key == event.key; });
    if (found == bindings.end()) {
        return false;
    }
    if (pressed) {
        (this->*found->action)();
    }
    return true;
}

void Viewer::advance(double seconds) {
    const double step = std::isfinite(seconds) && seconds > 0.0 ? seconds : 0.0;
    if (playing_) {
        path_time_ = std::fmod(path_time_ + step, std::max(path_.duration(), 1e-9));
        const scene::FlyKey key = path_.at(path_.begin() + path_time_);
        scene::Camera next = camera();
        next.eye = key.eye;
        next.look = key.look;
        next.up = {0.0, 0.0, 1.0};
        flight_.set_camera(next);
        show_camera(flight_.camera());
        return;
    }
    moving_ = !is_map() && flight_.advance(step);
    if (moving_) {
        show_camera(flight_.camera());
    }
}

bool Viewer::take_redraw() { return std::exchange(redraw_, false); }
bool Viewer::take_screenshot_request() { return std::exchange(screenshot_, false); }
bool Viewer::take_help_request() { return std::exchange(help_, false); }

void Viewer::show_camera(const scene::Camera& camera) {
    this->camera() = camera;
    redraw_ = true;
}

void Viewer::toggle_path() {
    if (is_map()) {
        toggle_map();
    }
    playing_ = !playing_;
}

void Viewer::toggle_map() {
    if (is_map()) {
        show_camera(*std::exchange(before_map_, std::nullopt));
        return;
    }
    playing_ = false;
    before_map_ = camera();
    show_camera(scene::pose_camera(scene::Pose::map, scene_.bounds,
                                   [&](double x, double y) { return scene_.ground(x, y); }));
}

void Viewer::toggle_wireframe() {
    auto& material = scene_.terrain->get<scene::TerrainNode>()->material;
    material.wireframe = !material.wireframe;
    redraw_ = true;
}

void Viewer::toggle_mouse_look() {
    mouse_look_ = !mouse_look_;
    flight_.set_mouse_look(mouse_look_);
}

void Viewer::next_technique() {
    const auto& technique = scene_.terrain->get<scene::TerrainNode>()->material.technique;
    choose_technique((index_of(technique.id) + 1) % scene::technique_catalogue().size());
}

void Viewer::choose_technique(std::size_t index) {
    const auto catalogue = scene::technique_catalogue();
    if (index < catalogue.size()) {
        scene_.terrain->get<scene::TerrainNode>()->material.technique =
            scene::make_technique(catalogue[index].id);
        redraw_ = true;
    }
}

void Viewer::ask_for_screenshot() { screenshot_ = true; }
void Viewer::ask_for_help() { help_ = true; }

void Viewer::leave() {
    if (mouse_look_) {
        toggle_mouse_look();
    } else {
        close_ = true;
    }
}

std::string Viewer::title(const render::FrameStats& stats, double frame_ms) const {
    const auto& node = *scene_.terrain->get<scene::TerrainNode>();
    const scene::Camera& eye = *scene_.camera->get<scene::Camera>();
    std::string title =
        fmt::format("reljef - {} - {} - {:.1f} fps ({:.1f} ms) - {} triangles",
                    node.surface->terrain().name, scene::to_string(node.material.technique),
                    frame_ms > 0.0 ? 1000.0 / frame_ms : 0.0, frame_ms, stats.triangles);
    if (const auto ground = scene_.scene.height_at(eye.eye.x, eye.eye.y)) {
        title += fmt::format(" - {:.0f} m above ground", eye.eye.z - *ground);
    }
    if (const auto place = node.surface->placement().geodetic_from_world(eye.eye)) {
        title += fmt::format(" - {:.5f}, {:.5f}", place->latitude, place->longitude);
    }
    return title;
}

std::string viewer_keys() {
    std::string text = "  W A S D, arrows  move (shift: faster; wheel: speed)\n"
                       "  Q E              down, up (never under the ground)\n"
                       "  drag             turn\n";
    for (const auto& [name, meaning] :
         {std::pair{"P", "fly along the path, or stop"},
          std::pair{"T, 1 2 ...", "next technique, or a certain one"},
          std::pair{"F", "the triangles' edges only, or filled"},
          std::pair{"O", "map from straight above, and back"},
          std::pair{"M", "turn with every move of the mouse, or only with its button held"},
          std::pair{"C, F12", "save a picture here, reljef-0001.png and on"},
          std::pair{"H", "these lines"}, std::pair{"Esc", "let go of the mouse, or end"}}) {
        text += fmt::format("  {:<15}  {}\n", name, meaning);
    }
    return text;
}

std::filesystem::path next_screenshot(const std::filesystem::path& folder) {
    std::error_code ignored;
    for (int number = 1;; ++number) {
        auto file = folder / fmt::format("reljef-{:04}.png", number);
        if (!std::filesystem::exists(file, ignored)) {
            return file;
        }
    }
}

} // namespace reljef::app
