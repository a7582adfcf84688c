#pragma once

#include <filesystem>
#include <functional>

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/scene/motion/camera_path.h"

namespace reljef::app {

/// A file that pictures of one size are written to. Without finish() nothing remains of it.
struct VideoFile {
    std::function<Result<void>(const Image& picture, int index)> write;
    std::function<Result<void>()> finish;
};
/// Opens a file for pictures of a size, pixels, at a number of frames a second.
using OpenVideo = std::function<Result<VideoFile>(const std::filesystem::path& file,
                                                  glm::ivec2 size, double frames_per_second)>;

/// A flight along a path, frame by frame, into a video. The destructor cancels it.
class PathVideo {
public:
    static constexpr double frames_per_second = 25.0;

    /// Fails for a path with one keyframe, and as `open`.
    static Result<PathVideo> begin(const scene::CameraPath& path, std::filesystem::path file,
                                   glm::ivec2 size, const OpenVideo& open);

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] glm::ivec2 size() const { return size_; }
    [[nodiscard]] int frames() const { return frames_; }
    [[nodiscard]] bool is_complete() const { return written_ == frames_; }
    [[nodiscard]] double progress() const { return static_cast<double>(written_) / frames_; }
    /// Of the next frame, seconds since the path's beginning.
    [[nodiscard]] double time() const { return written_ / frames_per_second; }

    /// The next frame. Precondition: not complete; a picture of size().
    Result<void> write(const Image& picture);
    /// Precondition: complete.
    Result<void> finish() { return output_.finish(); }

private:
    PathVideo(VideoFile output, std::filesystem::path file, glm::ivec2 size, int frames)
        : output_(std::move(output)), file_(std::move(file)), size_(size), frames_(frames) {}

    VideoFile output_;
    std::filesystem::path file_;
    glm::ivec2 size_;
    int frames_;
    int written_ = 0;
};

} // namespace reljef::app
