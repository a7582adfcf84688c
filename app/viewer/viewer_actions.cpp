// What the viewer's keys and panels do beside steering.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/viewer/camera_text.h"
#include "app/viewer/viewer.h"
#include "engine/scene/graph/daylight.h"
#include "engine/session/ground.h"
#include "engine/terrain/field/color_ramp.h"

namespace reljef::app {
namespace {

const scene::TerrainSurface& surface_of(const session::TerrainScene& scene) {
    return *scene.terrain->get<scene::TerrainNode>()->surface;
}

std::vector<scene::Technique> techniques_of(const session::TerrainScene& scene) {
    std::vector<scene::Technique> techniques;
    for (const scene::Material* const material : scene.materials()) {
        techniques.push_back(material->technique);
    }
    return techniques;
}

// "view 1", "view 2" and so on.
std::string free_name(const std::vector<Bookmark>& bookmarks) {
    std::string name;
    std::size_t number = 0;
    do {
        name = fmt::format("view {}", ++number);
    } while (std::any_of(bookmarks.begin(), bookmarks.end(),
                         [&](const Bookmark& bookmark) { return bookmark.name == name; }));
    return name;
}

} // namespace

void Viewer::report(const Result<void>& result) {
    if (!result) {
        notes_.note(result.error().message);
    }
}

void Viewer::fly_to(const scene::Camera& camera) {
    if (map_) {
        toggle_map();
    }
    playing_ = false;
    navigation_.fly_to(flight_.camera(), camera);
}

Result<std::string> Viewer::camera_options() const {
    if (map_) {
        return Error{"the map has no --camera; O leaves the map"};
    }
    return camera_text(surface_of(scene_), flight_.camera());
}

void Viewer::copy_camera() {
    auto text = camera_options();
    if (!text) {
        notes_.note(text.error().message);
        return;
    }
    output_ += fmt::format("copied: {}\n", *text);
    clipboard_ = std::move(*text);
}

Result<BookmarkContent> Viewer::bookmarks() const {
    return bookmarks_ ? bookmarks_->of(terrain_)
                      : Error{"bookmarks: $XDG_DATA_HOME and $HOME are no absolute paths, one "
                              "was expected"};
}

// Other windows may have changed the file.
void Viewer::read_bookmarks() {
    auto there = bookmarks();
    known_bookmarks_ = there ? std::move(*there) : BookmarkContent{{}, there.error().message};
    content_changed_ = true;
}

Result<void> Viewer::save_bookmark(const std::string& name) {
    const auto there = bookmarks();
    const auto camera = camera_options();
    if (!there || !camera) {
        return there ? camera.error() : there.error();
    }
    const Bookmark bookmark{terrain_, name.empty() ? free_name(there->bookmarks) : name, *camera};
    auto added = bookmarks_->add(bookmark);
    read_bookmarks();
    output_ += added ? fmt::format("saved bookmark {}: {}\n", bookmark.name, bookmark.camera)
                     : std::string();
    return added;
}

Result<void> Viewer::remove_bookmark(const Bookmark& bookmark) {
    if (!bookmarks_) {
        return bookmarks().error();
    }
    auto removed = bookmarks_->remove(bookmark);
    read_bookmarks();
    output_ += removed ? fmt::format("deleted bookmark {}\n", bookmark.name) : std::string();
    return removed;
}

Result<void> Viewer::rename_bookmark(const Bookmark& bookmark, const std::string& name) {
    if (!bookmarks_) {
        return bookmarks().error();
    }
    auto renamed = bookmarks_->rename(bookmark, name);
    read_bookmarks();
    return renamed;
}

Result<void> Viewer::go_to_bookmark(const Bookmark& bookmark) {
    const auto found = camera_from_text(surface_of(scene_), bookmark.camera, flight_.camera());
    if (!found) {
        return Error{fmt::format("bookmark {}: {} found, a place of this terrain was expected",
                                 bookmark.name, bookmark.camera)};
    }
    fly_to(*found);
    output_ += fmt::format("flying to bookmark {}\n", bookmark.name);
    return {};
}

void Viewer::next_bookmark() {
    read_bookmarks();
    const auto& [list, note] = known_bookmarks_;
    if (!note.empty()) {
        notes_.note(note);
    }
    if (!list.empty()) {
        report(go_to_bookmark(list[next_bookmark_++ % list.size()]));
    } else if (bookmarks()) {
        notes_.note("this terrain has no bookmark; B makes one");
    }
}

void Viewer::receive_click() {
    const auto pixel = map_ ? map_->take_click() : navigation_.take_click();
    if (!pixel || !measuring_.is_on()) {
        return;
    }
    auto picked = measuring_.pick(place_at(*pixel));
    report(picked ? Result<void>() : picked.error());
    output_ += picked ? *picked : std::string();
    content_changed_ = true;
}

void Viewer::toggle_measuring() {
    measuring_.set_on(!measuring_.is_on());
    content_changed_ = true;
    if (measuring_.is_on()) {
        measuring_.clear();
    }
    output_ += measuring_.is_on() ? "measuring: click on the ground\n" : "measuring ends\n";
}

Result<void> Viewer::save_profile() {
    const auto file = next_file(".", "reljef-profile", ".csv");
    auto saved = measuring_.save_profile(file);
    output_ += saved ? fmt::format("saved {}\n", file.filename().string()) : std::string();
    return saved;
}

Result<void> Viewer::begin_viewshed() {
    return measuring_.begin_viewshed(next_file(".", "reljef-viewshed", ".tif"));
}

Result<void> Viewer::act(const ShowViewshed& set) {
    if (set.shown && measuring_.seen() == nullptr) {
        return Error{"viewshed: none found, one was expected; U makes it"};
    }
    surface_switch_.request(set.shown ? measuring_.seen() : std::shared_ptr<const Image>());
    content_changed_ = true;
    return {};
}

void Viewer::seek(double seconds) {
    if (map_) {
        toggle_map();
    }
    navigation_.let_go();
    playing_ = false;
    path_time_ = std::isfinite(seconds) ? std::clamp(seconds, 0.0, desk_.path().duration()) : 0.0;
    show_path();
}

void Viewer::toggle_recording() {
    if (!desk_.is_recording()) {
        desk_.begin_recording();
        output_ += "recording the flight; K ends it\n";
        return;
    }
    const auto ended = desk_.end_recording();
    report(ended ? save_path() : ended);
    path_time_ = 0.0;
}

Result<void> Viewer::set_path(Result<scene::CameraPath> path) {
    auto set = desk_.set(std::move(path));
    path_time_ = std::min(path_time_, desk_.path().duration());
    content_changed_ = true;
    return set;
}

Result<void> Viewer::act(const InsertPathKey& insert) {
    const scene::Camera& view = flight_.camera();
    return set_path(scene::with_key(
        desk_.path(), {desk_.path().begin() + insert.seconds, view.eye, view.target}));
}

Result<void> Viewer::act(const MovePathKey& move) {
    const scene::Camera& view = flight_.camera();
    return set_path(scene::with_moved_key(desk_.path(), move.key, {0.0, view.eye, view.target}));
}

Result<void> Viewer::act(const RetimePathKey& retime) {
    return set_path(
        scene::with_retimed_key(desk_.path(), retime.key, desk_.path().begin() + retime.seconds));
}

Result<void> Viewer::act(const RemovePathKey& remove) {
    return set_path(scene::without_key(desk_.path(), remove.key));
}

Result<void> Viewer::act(const SetPathDuration& set) {
    return set_path(scene::with_duration(desk_.path(), set.seconds));
}

void Viewer::append_key() {
    report(desk_.append_key(flight_.camera()));
    path_time_ = desk_.path().duration(); // there Delete removes it again
    output_ += fmt::format("keyframe {}\n", desk_.path().keys().size());
}

void Viewer::remove_key() {
    const auto removed = desk_.remove_key_at(desk_.path().begin() + path_time_);
    report(removed);
    output_ += removed ? fmt::format("{} keyframes\n", desk_.path().keys().size()) : std::string();
}

void Viewer::ask_for_video() {
    if (map_) {
        toggle_map();
    }
    video_ = true;
}

Result<void> Viewer::save_path() {
    const auto saved =
        desk_.save(surface_of(scene_), next_stem(".", "reljef-path", {".toml", ".gpx"}));
    if (!saved) {
        return saved.error();
    }
    for (const std::filesystem::path& written : *saved) {
        output_ += fmt::format("saved {}\n", written.filename().string());
    }
    return {};
}

void Viewer::next_technique() {
    change_technique([&] { techniques_.next(); });
}

void Viewer::choose_technique(std::size_t index) {
    change_technique([&] { techniques_.choose(index); });
}

void Viewer::restore_techniques() {
    switch_.request(start_techniques_);
    redraw_ = redraw_ || !switch_.is_preparing();
}

void Viewer::step_parameter(int steps) {
    change_technique([&] { techniques_.step_parameter(steps); });
}

void Viewer::change_technique(const std::function<void()>& change) {
    const auto before = techniques_of(scene_);
    change();
    redraw_ = redraw_ || before != techniques_of(scene_);
}

Result<void> Viewer::act(const SwapTechniques& /*action*/) {
    const scene::Technique left = switch_.technique();
    auto swapped = request(ChooseTechnique{comparison_.technique(), {}});
    return swapped ? comparison_.choose(left) : swapped;
}

Result<void> Viewer::act(const SelectModel& choice) {
    techniques_.select_model(choice.model);
    return {};
}

Result<void> Viewer::act(const SelectParameter& choice) {
    techniques_.select_parameter(choice.index);
    return {};
}

Result<void> Viewer::act(const SetWipe& set) {
    comparison_.set_share(set.share);
    return {};
}

Result<void> Viewer::act(const SeekPath& seek) {
    this->seek(seek.seconds);
    return {};
}

Result<void> Viewer::act(const ClearPoints& /*action*/) {
    measuring_.clear();
    return {};
}

Result<void> Viewer::act(const SetSpeed& set) {
    flight_.set_speed(set.speed);
    return {};
}

Result<void> Viewer::act(const SetExaggeration& set) {
    if (const std::string obstacle = exaggeration_obstacle(); !obstacle.empty()) {
        return Error{obstacle};
    }
    set_exaggeration(set.factor);
    return {};
}

Result<void> Viewer::act(const SetSun& sun) {
    set_sun(sun);
    return {};
}

void Viewer::select_parameter(int steps) {
    techniques_.select_next_parameter(steps);
    content_changed_ = true;
}

Result<void> Viewer::request(const ChooseTechnique& choice) {
    auto requested = techniques_.request(choice.technique);
    redraw_ = redraw_ || !switch_.is_preparing();
    return requested;
}

void Viewer::set_sun(const SetSun& sun) {
    scene::Light light = switch_.light();
    light.azimuth = sun.azimuth;
    light.altitude = sun.altitude;
    // The colours that session::set_daylight() gives it: its maps are prepared with them.
    const scene::Daylight daylight =
        scene::daylight_at(light.altitude, scene_.surroundings.turbidity);
    light.color = daylight.sun;
    light.ambient = daylight.ambient;
    switch_.follow(light);
    redraw_ = redraw_ || !switch_.is_preparing();
}

Result<void> Viewer::act(const SetTurbidity& set) {
    scene_.surroundings.turbidity = set.turbidity;
    const scene::Light light = switch_.light();
    set_sun({light.azimuth, light.altitude});
    return {};
}

Result<void> Viewer::act(const SetGrain& set) {
    scene_.terrain->get<scene::TerrainNode>()->grain = static_cast<float>(set.strength);
    scene_.usual_grain.reset();
    redraw_ = true;
    return {};
}

Result<void> Viewer::act(const SetContours& set) {
    const double metres =
        set.metres > 0.0 ? std::clamp(set.metres, scene::min_contours, scene::max_contours) : 0.0;
    scene_.terrain->get<scene::TerrainNode>()->contours = metres;
    redraw_ = true;
    if (metres != set.metres) {
        notes_.note(fmt::format("contours every {} m found, 0 (none) or {} to {} m was expected: "
                                "they are every {} m",
                                set.metres, scene::min_contours, scene::max_contours, metres));
    }
    return {};
}

Result<void> Viewer::act(const SetEyeDome& set) {
    scene_.scene.set_eye_dome(set.strength);
    redraw_ = true;
    return {};
}

Result<void> Viewer::act(const SetContourLabels& set) {
    scene_.terrain->get<scene::TerrainNode>()->labels_contours = set.shown;
    redraw_ = true;
    return {};
}

Result<void> Viewer::act(const SetVisibility& set) {
    if (auto sky = scene_.scene.sky()) {
        scene_.surroundings.visibility = set.metres;
        sky->visibility = set.metres;
        scene_.scene.set_sky(*sky);
        redraw_ = true;
    }
    return {};
}

Result<void> Viewer::act(const SetRamp& set) {
    if (const std::string obstacle = exaggeration_obstacle(); !obstacle.empty()) {
        return Error{obstacle};
    }
    auto ramp = terrain::named_ramp(set.name);
    if (!ramp) {
        return Error{fmt::format("colours: '{}' found, a built-in ramp was expected", set.name)};
    }
    surface_switch_.request(std::move(*ramp), surface_switch_.imagery_share());
    return {};
}

Result<void> Viewer::act(const SetImageryShare& set) {
    if (const std::string obstacle = exaggeration_obstacle(); !obstacle.empty()) {
        return Error{obstacle};
    }
    surface_switch_.request(surface_switch_.ramp(), set.share);
    return {};
}

session::RelayedLog::TaskProgress Viewer::progress() const {
    if (switch_.is_preparing()) {
        return switch_.progress();
    }
    auto preparing = surface_switch_.is_preparing() || !proofs_ ? surface_switch_.progress()
                                                                : proofs_->progress();
    preparing = preparing.label.empty() ? levels_.progress() : preparing;
    return preparing.label.empty() ? measuring_.progress() : preparing;
}

bool Viewer::keeps_techniques() const {
    return techniques_of(scene_) == start_techniques_;
}

std::optional<session::PickedPlace> Viewer::place_at_pixel(glm::dvec2 pixel) const {
    return scene_.models.empty() ? place_at(pixel) : std::nullopt;
}

std::optional<session::PickedPlace> Viewer::place_at(glm::dvec2 pixel) const {
    return session::pick_place(scene_, scene::view_ray(camera(), navigation_.world().size, pixel));
}

} // namespace reljef::app
