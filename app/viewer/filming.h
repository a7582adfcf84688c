#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "app/viewer/message_history.h"
#include "app/viewer/paths/path_video.h"
#include "app/viewer/viewer.h"
#include "engine/core/event.h"
#include "engine/core/result.h"
#include "engine/scene/graph/camera.h"
#include "engine/session/log.h"

namespace reljef::app {

/// Renders the viewer's path into a video, frame by frame, in place of what the user sees.
class Filming {
public:
    /// Draws the scene's view with a size, pixels. Returns whether all its tiles were there.
    using DrawFrame = std::function<Result<bool>(glm::ivec2 size)>;
    /// The picture that was drawn last.
    using ReadFrame = std::function<Image()>;

    /// All outlive this. `open`: empty: there are no videos.
    Filming(session::TerrainScene& scene, Viewer& viewer, MessageHistory& messages, OpenVideo open)
        : scene_(scene), viewer_(viewer), messages_(messages), open_(std::move(open)) {}

    [[nodiscard]] bool is_on() const { return video_.has_value(); }
    [[nodiscard]] double progress() const { return video_ ? video_->progress() : 0.0; }
    /// Begins a video of that size under a free name in the current folder; failures are notes.
    void begin(glm::ivec2 size);
    /// Draws the next frame, and writes it if its tiles were there. Returns whether the video has
    /// ended: it is written, or has failed.
    bool film(const DrawFrame& draw, const ReadFrame& read);
    void cancel();
    /// Only Esc, which cancels, and closing count.
    void receive(const Event& event);

private:
    Result<void> film_frame(const DrawFrame& draw, const ReadFrame& read);
    void end();

    session::TerrainScene& scene_;
    Viewer& viewer_;
    MessageHistory& messages_;
    OpenVideo open_;
    std::optional<PathVideo> video_;
    std::unique_ptr<session::Task> task_;
    scene::Camera before_;
};

} // namespace reljef::app
