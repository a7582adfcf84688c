// What the viewer's keys and panels do beside steering.
#include <fmt/format.h>

#include "app/viewer/camera_text.h"
#include "app/viewer/viewer.h"
#include "engine/session/ground.h"

namespace reljef::app {
namespace {

const scene::TerrainSurface& surface_of(const session::TerrainScene& scene) {
    return *scene.terrain->get<scene::TerrainNode>()->surface;
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
    output_ += *text + '\n';
    clipboard_ = std::move(*text);
}

std::optional<glm::dvec3> Viewer::ground_under_pointer() const {
    return navigation_.pointer() ? navigation_.ground_at(camera(), *navigation_.pointer())
                                 : std::nullopt;
}

Result<Bookmarks::List> Viewer::bookmarks() const {
    return bookmarks_ ? bookmarks_->of(terrain_)
                      : Error{"bookmarks: $XDG_DATA_HOME and $HOME are no absolute paths, one "
                              "was expected"};
}

Result<void> Viewer::save_bookmark(const std::string& name) {
    const auto there = bookmarks();
    const auto camera = camera_options();
    if (!there || !camera) {
        return there ? camera.error() : there.error();
    }
    const Bookmark bookmark{
        terrain_, name.empty() ? fmt::format("view {}", there->bookmarks.size() + 1) : name,
        *camera};
    if (auto added = bookmarks_->add(bookmark); !added) {
        return added;
    }
    output_ += fmt::format("bookmark {}: {}\n", bookmark.name, bookmark.camera);
    return {};
}

Result<void> Viewer::remove_bookmark(const Bookmark& bookmark) {
    const auto there = bookmarks();
    return there ? bookmarks_->remove(bookmark) : there.error();
}

Result<void> Viewer::go_to_bookmark(const Bookmark& bookmark) {
    const auto found = camera_from_text(surface_of(scene_), bookmark.camera, flight_.camera());
    if (!found) {
        return Error{fmt::format("bookmark {}: {} found, a place of this terrain was expected",
                                 bookmark.name, bookmark.camera)};
    }
    fly_to(*found);
    output_ += fmt::format("bookmark {}\n", bookmark.name);
    return {};
}

void Viewer::next_bookmark() {
    const auto there = bookmarks();
    if (!there) {
        notes_.note(there.error().message);
        return;
    }
    if (!there->note.empty()) {
        notes_.note(there->note);
    }
    if (there->bookmarks.empty()) {
        notes_.note("this terrain has no bookmark; B makes one");
        return;
    }
    report(go_to_bookmark(there->bookmarks[next_bookmark_++ % there->bookmarks.size()]));
}

} // namespace reljef::app
