#pragma once

#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/atomic_file.h"
#include "engine/core/color.h"
#include "engine/core/result.h"

namespace reljef::app {

class FrameSink {
public:
    virtual ~FrameSink() = default;
    virtual Result<void> write(const Image& picture, int index) = 0;
    /// Completes the output. Adds a picture or video that the caller commits with its other
    /// outputs; numbered pictures are in their places. Without it no unfinished file remains.
    virtual Result<void> finish(std::vector<AtomicFile>& outputs) = 0;
};

/// Whether the extension is .mp4, .mkv, .webm or .mov.
bool is_video(const std::filesystem::path& path);

/// Fails if the name cannot hold the frames: a wrong number pattern, a number in a folder's or
/// video's name, one picture for many frames, an unknown picture format. The error names -o.
Result<void> check_output_name(const std::filesystem::path& output, int frames);

bool is_standard_output(const std::filesystem::path& output);

/// Fails if standard output is a terminal, or `other`, an option, also writes to it; empty: none.
Result<void> check_standard_output(std::string_view other);

/// Whether the name contains a number pattern.
bool is_numbered(const std::filesystem::path& output);

/// The pattern with `index` for %d or %0Nd. Fails unless the pattern has exactly one of them.
Result<std::filesystem::path> numbered(const std::filesystem::path& pattern, int index);

struct FrameSinkOptions {
    glm::ivec2 size{1024, 768};
    int frames = 1;
    double frames_per_second = 25.0;
};

/// A sink for a picture, PNG on standard output ("-"), numbered pictures ("frames/%04d.png",
/// creates folders) or a video (through ffmpeg), by the name. Errors: as check_output_name(), a
/// file that cannot be written, no ffmpeg.
Result<std::unique_ptr<FrameSink>> make_frame_sink(const std::filesystem::path& output,
                                                   const FrameSinkOptions& options);

/// The evenly spread frames of a contact sheet, at most 24.
class SheetPictures {
public:
    SheetPictures(bool is_requested, int frames);

    void add(Image picture, int index);
    /// Adds the sheet to the outputs if it is requested.
    [[nodiscard]] Result<void> prepare(const std::filesystem::path& file,
                                       std::vector<AtomicFile>& outputs) const;

private:
    int step_; // 0: not requested
    std::vector<Image> pictures_;
};

} // namespace reljef::app
