#include "app/viewer/filming.h"

#include <variant>

#include <fmt/format.h>

#include "engine/session/streaming.h"

namespace reljef::app {

void Filming::begin(glm::ivec2 size) {
    if (!open_) {
        return;
    }
    const auto file = next_file(".", "reljef", ".mp4");
    auto video = PathVideo::begin(viewer_.path_desk().path(), file, size, open_);
    if (!video) {
        messages_.note(video.error().message);
        return;
    }
    video_.emplace(std::move(*video));
    before_ = *scene_.camera->get<scene::Camera>();
    task_ = messages_.start("video " + file.filename().string());
}

void Filming::end() {
    task_.reset();
    video_.reset();
    *scene_.camera->get<scene::Camera>() = before_;
    viewer_.fly_to(before_);
}

void Filming::cancel() {
    if (is_on()) {
        end();
        messages_.note("the video is cancelled, nothing is saved");
    }
}

bool Filming::film(const DrawFrame& draw, const ReadFrame& read) {
    viewer_.seek(video_->time());
    session::take_arrivals(scene_.scene);
    if (const auto filmed = film_frame(draw, read); !filmed) {
        end();
        messages_.note(filmed.error().message);
        return true;
    }
    return !is_on();
}

Result<void> Filming::film_frame(const DrawFrame& draw, const ReadFrame& read) {
    const auto is_whole = draw(video_->size());
    if (!is_whole) {
        return is_whole.error();
    }
    if (!*is_whole) {
        return {}; // draws this frame again
    }
    task_->update(video_->progress());
    if (auto written = video_->write(read()); !written || !video_->is_complete()) {
        return written;
    }
    if (auto finished = video_->finish(); !finished) {
        return finished;
    }
    const std::string name = video_->file().filename().string();
    end();
    messages_.report(fmt::format("saved {}\n", name));
    return {};
}

void Filming::receive(const Event& event) {
    const auto* key = std::get_if<KeyEvent>(&event);
    if (key != nullptr && key->pressed && key->key == Key::escape) {
        cancel();
    } else if (std::holds_alternative<CloseEvent>(event) ||
               std::holds_alternative<ResizeEvent>(event)) {
        viewer_.receive(event);
    }
}

} // namespace reljef::app
