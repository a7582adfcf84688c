#pragma once

#include <filesystem>

#include <glm/vec2.hpp>
#include <sys/types.h>

#include "app/rendering/frame_sink.h"
#include "engine/core/atomic_file.h"
#include "engine/core/memory_file.h"

namespace reljef::app {

/// Pipes pictures to ffmpeg, which must be installed.
class VideoEncoder : public FrameSink {
public:
    static Result<VideoEncoder> create(const std::filesystem::path& file, glm::ivec2 size,
                                       double frames_per_second);
    VideoEncoder(VideoEncoder&& other) noexcept;
    ~VideoEncoder() override;

    /// Precondition: the picture has the size given to create().
    Result<void> write(const Image& picture, int index) override;
    Result<void> finish(std::vector<AtomicFile>& outputs) override;

private:
    VideoEncoder(AtomicFile file, MemoryFile messages, pid_t process, int pipe)
        : file_(std::move(file)), messages_(std::move(messages)), process_(process), pipe_(pipe) {}
    [[nodiscard]] Error failed(std::string_view what) const;

    AtomicFile file_;
    MemoryFile messages_; // stderr of ffmpeg
    pid_t process_ = -1;
    int pipe_ = -1;
};

} // namespace reljef::app
