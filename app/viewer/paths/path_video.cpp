#include "app/viewer/paths/path_video.h"

#include <cmath>

#include <fmt/format.h>

namespace reljef::app {

Result<PathVideo> PathVideo::begin(const scene::CameraPath& path, std::filesystem::path file,
                                   glm::ivec2 size, const OpenVideo& open) {
    constexpr double max_frames = 1e6; // eleven hours
    if (!(path.duration() > 0.0)) {
        return Error{"video: a path with one keyframe found, at least two were expected; K records "
                     "a path, Insert appends a keyframe"};
    }
    constexpr double rounding = 1e-6; // of a frame: a duration is a difference of times
    const double frames = std::floor(path.duration() * frames_per_second + rounding) + 1.0;
    if (!(frames <= max_frames)) {
        return Error{fmt::format("video: {:.0f} frames found, at most {:.0f} were expected", frames,
                                 max_frames)};
    }
    auto output = open(file, size, frames_per_second);
    if (!output) {
        return output.error();
    }
    return PathVideo(std::move(*output), std::move(file), size, static_cast<int>(frames));
}

Result<void> PathVideo::write(const Image& picture) {
    if (auto written = output_.write(picture, written_); !written) {
        return written;
    }
    ++written_;
    return {};
}

} // namespace reljef::app
