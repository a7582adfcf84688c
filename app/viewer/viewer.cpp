#include "app/viewer/viewer.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/geo/place.h"
#include "engine/scene/motion/poses.h"
#include "engine/session/ground.h"
#include "engine/session/scene_daylight.h"
#include "engine/session/streaming.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::app {
namespace {

constexpr double seconds_across = 20.0;   // duration of a flight across the terrain
constexpr double first_step = 1.0 / 60.0; // longest step after rest, seconds
constexpr double min_duration = 1e-9;     // of a path, seconds
constexpr double min_lift = 1e-3;         // metres; less is rounding

scene::FreeFlight make_flight(const session::TerrainScene& scene, const scene::Camera& start,
                              bool allow_underground) {
    const scene::TerrainNode& terrain = *scene.terrain->get<scene::TerrainNode>();
    const auto surface = terrain.surface;
    scene::FreeFlightOptions options;
    options.speed = std::max(scene.bounds.size().x, scene.bounds.size().y) / seconds_across;
    options.clearance = session::min_clearance(scene);
    if (!allow_underground) {
        options.ground = [node = scene.terrain](glm::dvec3 eye) { // its stream may change
            return session::ground_below(*node->get<scene::TerrainNode>(), eye);
        };
    }
    options.up = [surface](glm::dvec3 world) { return surface->placement().up(world); };
    options.north = [surface](glm::dvec3 world) { return surface->placement().north(world); };
    return {start, std::move(options)};
}

NavigationOptions navigation_options(const session::TerrainScene& scene, glm::ivec2 size,
                                     bool allow_underground) {
    constexpr double clearances_apart = 4.0; // of an eye from the point that it zooms to
    constexpr double sides_apart = 20.0;     // of an eye that zooms out, in sides of the terrain
    const auto surface = scene.terrain->get<scene::TerrainNode>()->surface;
    const double clearance = session::min_clearance(scene);
    NavigationOptions options;
    options.middle = scene.bounds.center();
    scene::GestureWorld& world = options.world;
    world.size = glm::max(size, glm::ivec2(1));
    world.up = [surface](glm::dvec3 at) { return surface->placement().up(at); };
    world.north = [surface](glm::dvec3 at) { return surface->placement().north(at); };
    if (!allow_underground) {
        world.lifted = [node = scene.terrain, clearance](glm::dvec3 eye) {
            return session::above_ground(*node->get<scene::TerrainNode>(), eye, clearance);
        };
    }
    if (surface->placement().kind() == terrain::PlacementKind::ellipsoid) {
        const glm::dvec2 radii = geo::radii_of_earth();
        world.radius = (2.0 * radii.x + radii.y) / 3.0;
    }
    world.min_distance = clearances_apart * clearance;
    world.max_distance = sides_apart * std::max(scene.bounds.size().x, scene.bounds.size().y);
    options.pick = [&scene](const Ray& ray) {
        const auto hit = session::pick_place(scene, ray);
        return hit ? std::optional(hit->world) : std::nullopt;
    };
    return options;
}

// The start of a flight, also for a scene that begins as a map.
scene::Camera perspective_start(const session::TerrainScene& scene, glm::ivec2 size) {
    scene::Camera camera = *scene.camera->get<scene::Camera>();
    if (camera.projection == scene::ProjectionKind::perspective) {
        return camera;
    }
    const scene::Camera whole = scene::whole_camera(
        session::whole_bounds(scene), camera.vertical_fov, static_cast<double>(size.x) / size.y);
    camera.projection = scene::ProjectionKind::perspective;
    camera.eye = whole.eye;
    camera.target = whole.target;
    camera.up = whole.up;
    return camera;
}

} // namespace

Viewer::Viewer(session::TerrainScene& scene, scene::CameraPath path, glm::ivec2 size,
               const ViewerOptions& options)
    : scene_(scene), desk_(std::move(path)), size_(size), start_(perspective_start(scene, size)),
      switch_(scene, options.maps), techniques_(scene, switch_, material().technique),
      surface_switch_(scene, options.maps.threads, options.maps.largest_side), levels_(scene),
      contours_(scene), flight_(make_flight(scene, start_, options.allow_underground)),
      navigation_(navigation_options(scene, size, options.allow_underground)), measuring_(scene),
      comparison_(scene, options.maps), terrain_(options.terrain) {
    if (options.bookmarks) {
        bookmarks_.emplace(*options.bookmarks);
    }
    read_bookmarks();
    for (const scene::Material* const shown : scene_.materials()) {
        start_techniques_.push_back(shown->technique);
    }
    const scene::Technique technique = material().technique;
    if (const scene::Technique first = first_technique(scene); first != technique) {
        switch_.request(first);
        switch_.request(technique);
    }
    if (options.proves_errors) {
        proofs_.emplace(scene);
    }
    if (camera().projection == scene::ProjectionKind::orthographic) {
        map_.emplace(camera(), scene_.bounds, size_);
    } else {
        show_camera(flight_.camera());
    }
}

void Viewer::receive(const Event& event) {
    if (std::holds_alternative<CloseEvent>(event)) {
        close_ = true;
    }
    if (const auto* resize = std::get_if<ResizeEvent>(&event)) {
        size_ = resize->framebuffer;
        navigation_.receive(event, flight_.camera());
        redraw_ = true;
    }
    if (const auto* key = std::get_if<KeyEvent>(&event); key != nullptr && receive_key(*key)) {
        return;
    }
    if (comparison_.receive(event, size_)) {
        return;
    }
    if (map_) {
        map_->receive(event);
        receive_click();
        return;
    }
    const bool is_moved = !mouse_look_ && receive_mouse(event);
    receive_click();
    if (is_moved) {
        return;
    }
    flight_.receive(event);
    if (flight_.is_steered()) { // ends the flight along the path, or to a place
        playing_ = false;
        navigation_.let_go();
    }
}

bool Viewer::receive_mouse(const Event& event) {
    const auto* wheel = std::get_if<ScrollEvent>(&event);
    if (wheel != nullptr && wheel->modifiers.control) {
        flight_.change_speed(wheel->offset.y);
        return true;
    }
    const auto moved = navigation_.receive(event, flight_.camera());
    if (moved) {
        playing_ = false;
        steer(*moved);
    }
    return moved.has_value();
}

void Viewer::steer(const scene::Camera& camera) {
    flight_.set_camera(camera);
    show_camera(flight_.camera());
}

std::vector<scene::Camera> Viewer::upcoming() const {
    std::vector<scene::Camera> cameras;
    if (!is_moving()) {
        return cameras;
    }
    for (const double ahead : {0.5, 1.5, 3.0}) { // seconds
        if (playing_) {
            const double time =
                std::fmod(path_time_ + ahead, std::max(desk_.path().duration(), min_duration));
            cameras.push_back(
                scene::at_key(camera(), desk_.path().at(desk_.path().begin() + time)));
        } else {
            cameras.push_back(session::camera_ahead(before_, camera(), last_step_, ahead));
        }
    }
    return cameras;
}

bool Viewer::is_moving() const {
    return playing_ ||
           (map_ ? map_->is_steered() : flight_.is_steered() || navigation_.is_moving());
}

// What was measured is no longer on the ground.
void Viewer::leave_measured_ground() {
    if (!measuring_.points().empty()) {
        notes_.note("the ground has changed: the measured points are removed");
    }
    if (shows_viewshed()) {
        notes_.note("the ground has changed: the colours of the viewshed are removed");
        surface_switch_.request(std::shared_ptr<const Image>());
    }
    measuring_.clear();
    measuring_.forget_viewshed();
}

void Viewer::update_appearance() {
    redraw_ = switch_.update() || redraw_;
    redraw_ = comparison_.take_redraw() || redraw_;
    bool& hides_overlay = scene_.terrain->get<scene::TerrainNode>()->hides_overlay;
    redraw_ = std::exchange(hides_overlay, comparison_.is_on()) != comparison_.is_on() || redraw_;
    redraw_ = (proofs_ && proofs_->update(size_)) || redraw_;
    redraw_ = levels_.update() || redraw_;
    const auto before = scene_.terrain->get<scene::TerrainNode>()->surface;
    if (surface_switch_.update(switch_.technique(), switch_.light(), size_)) {
        const auto& shown = *scene_.terrain->get<scene::TerrainNode>()->surface;
        const bool is_same_ground =
            &before->terrain() == &shown.terrain() &&
            before->placement().exaggeration() == shown.placement().exaggeration();
        if (!is_same_ground) {
            leave_measured_ground();
        }
        show_camera(camera());
        if (!map_) { // the ground may have risen above it
            flight_.set_camera(camera());
            show_camera(flight_.camera());
        }
    }
}

void Viewer::move(double step) {
    if (playing_) {
        advance_path(step);
    } else if (map_ && map_->advance(step)) {
        show_camera(map_->camera());
    } else if (!map_) {
        if (const auto moved = navigation_.advance(step)) {
            steer(*moved);
        }
        if (flight_.advance(step)) {
            show_camera(flight_.camera());
        }
    }
}

void Viewer::advance(double seconds) {
    double step = std::isfinite(seconds) && seconds > 0.0 ? seconds : 0.0;
    if (rested_) {
        step = std::min(step, first_step);
    }
    rested_ = !is_moving();
    update_appearance();
    before_ = camera();
    last_step_ = step;
    move(step);
    desk_.record(flight_.camera(), step);
    content_changed_ = contours_.update(size_, is_moving(), notes_) || content_changed_;
    const auto seen_before = measuring_.seen();
    if (const auto viewshed = measuring_.update()) {
        report(*viewshed ? Result<void>() : viewshed->error());
        output_ += *viewshed ? **viewshed : std::string();
    }
    if (measuring_.seen() != seen_before) {
        report(act(ShowViewshed{}));
    }
}

void Viewer::advance_path(double seconds) {
    path_time_ = std::fmod(path_time_ + seconds, std::max(desk_.path().duration(), min_duration));
    show_path();
}

void Viewer::show_path() {
    const scene::Camera requested =
        scene::at_key(camera(), desk_.path().at(desk_.path().begin() + path_time_));
    flight_.set_camera(requested);
    const scene::Camera next = flight_.camera();
    if (const double lifted = glm::distance(requested.eye, next.eye); lifted > min_lift) {
        path_lifted_ = std::max(path_lifted_, lifted);
    }
    if (next.eye != camera().eye || next.target != camera().target) {
        show_camera(next);
    }
}

void Viewer::relay_to(session::Log& log) {
    notes_.relay_to(log);
    switch_.relay_to(log);
    surface_switch_.relay_to(log);
    comparison_.relay_to(log);
    levels_.relay_to(log);
    if (proofs_) {
        proofs_->relay_to(log);
    }
}

std::shared_ptr<const view::PreparedLight> Viewer::take_light() {
    auto light = switch_.take_light();
    light = light == nullptr ? surface_switch_.take_light() : light;
    return light == nullptr && proofs_ ? proofs_->take_light() : light;
}

bool Viewer::undo_technique() {
    const bool is_undone = switch_.undo();
    redraw_ = redraw_ || is_undone;
    return is_undone;
}

void Viewer::show_camera(const scene::Camera& camera) {
    *scene_.camera->get<scene::Camera>() = camera;
    redraw_ = true;
}

void Viewer::toggle_path() {
    if (map_) {
        toggle_map();
    }
    navigation_.let_go();
    playing_ = !playing_;
}

void Viewer::go_to_start() {
    playing_ = false;
    map_.reset();
    navigation_.let_go();
    steer(start_);
}

void Viewer::toggle_map() {
    if (map_) {
        map_.reset();
        show_camera(flight_.camera());
        return;
    }
    playing_ = false;
    if (mouse_look_) {
        toggle_mouse_look();
    }
    flight_.let_go();
    navigation_.let_go();
    scene::Camera from_above = whole_map(scene_.bounds, size_);
    from_above.vertical_fov = camera().vertical_fov;
    from_above.near = camera().near;
    map_.emplace(from_above, scene_.bounds, size_);
    show_camera(map_->camera());
}

void Viewer::toggle_wireframe() {
    const bool wireframe = !material().wireframe;
    for (scene::Material* const shown : scene_.materials()) {
        shown->wireframe = wireframe;
    }
    redraw_ = true;
}

void Viewer::turn_light() {
    constexpr double step = 15.0; // degrees
    scene::Light light = switch_.light();
    light.azimuth = std::fmod(light.azimuth + step, 360.0);
    switch_.request(light);
    redraw_ = redraw_ || !switch_.is_preparing();
}

void Viewer::toggle_mouse_look() {
    mouse_look_ = !mouse_look_ && !map_;
    flight_.set_mouse_look(mouse_look_);
}

void Viewer::leave() {
    const bool makes_viewshed = !measuring_.progress().label.empty();
    if (mouse_look_) {
        toggle_mouse_look();
    } else if (desk_.is_recording()) {
        toggle_recording();
    } else if (makes_viewshed && !leaves_viewshed_) {
        notes_.note("a viewshed is being made: Esc again closes the window without it");
        leaves_viewshed_ = true;
    } else {
        close_ = true;
    }
}

std::filesystem::path next_stem(const std::filesystem::path& folder, const std::string& stem,
                                std::initializer_list<std::string_view> extensions) {
    for (int number = 1;; ++number) {
        const std::string name = fmt::format("{}-{:04}", stem, number);
        if (std::none_of(extensions.begin(), extensions.end(), [&](std::string_view extension) {
                std::error_code ignored;
                return std::filesystem::exists(std::filesystem::symlink_status(
                    folder / (name + std::string(extension)), ignored));
            })) {
            return folder / name;
        }
    }
}

std::filesystem::path next_file(const std::filesystem::path& folder, const std::string& stem,
                                const std::string& extension) {
    return next_stem(folder, stem, {extension}).string() + extension;
}

} // namespace reljef::app
