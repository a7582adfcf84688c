#pragma once

#include <filesystem>
#include <memory>

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/result.h"

namespace reljef::app {

/// Where the pictures of a flight go.
class FrameSink {
public:
    virtual ~FrameSink() = default;
    virtual Result<void> write(const Image& picture, int index) = 0;
    /// Makes the output appear; without it nothing unfinished is left behind.
    virtual Result<void> finish() = 0;
};

/// Whether the file is a video by its extension (.mp4, .mkv, .webm, .mov).
bool is_video(const std::filesystem::path& path);

/// Fails, naming -o, where the name can hold no output: a number that is none, one in a folder's
/// name or in a video's, one picture for many frames, and a format that is none of pictures.
Result<void> check_output_name(const std::filesystem::path& output, int frames);

/// Whether the output is standard output: "-".
bool is_standard_output(const std::filesystem::path& output);

/// Whether the name stands for numbered pictures.
bool is_numbered(const std::filesystem::path& output);

/// The file of a numbered picture: the pattern's %d or %0Nd replaced. Fails when the pattern has
/// not exactly one of them.
Result<std::filesystem::path> numbered(const std::filesystem::path& pattern, int index);

struct FrameSinkOptions {
    glm::ivec2 size{1024, 768};
    int frames = 1;
    double frames_per_second = 25.0;
};

/// One picture, a picture on standard output as PNG ("-"), a numbered sequence ("frames/%04d.png";
/// missing folders are made) or a video (through ffmpeg), by what `output` looks like. Fails where
/// it cannot be written, where many frames would go to one picture, and where ffmpeg is needed and
/// missing.
Result<std::unique_ptr<FrameSink>> make_frame_sink(const std::filesystem::path& output,
                                                   const FrameSinkOptions& options);

} // namespace reljef::app
