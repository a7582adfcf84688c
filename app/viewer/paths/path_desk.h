#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/scene/graph/terrain_node.h"
#include "engine/scene/motion/camera_path.h"
#include "engine/scene/motion/path_editing.h"

namespace reljef::app {

/// The path that the viewer flies: given, recorded in flight, or made of keyframes.
class PathDesk {
public:
    static constexpr double seconds_between_keys = 3.0; ///< of keyframes that are appended

    explicit PathDesk(scene::CameraPath path) : path_(std::move(path)) {}

    [[nodiscard]] const scene::CameraPath& path() const { return path_; }
    /// Replaces the path by an edited one (path_editing.h); an error changes nothing.
    Result<void> set(Result<scene::CameraPath> path);

    void begin_recording() { recorder_.emplace(); }
    /// Ends it; the recorded path becomes the path. Fails if nothing was recorded.
    Result<void> end_recording();
    [[nodiscard]] bool is_recording() const { return recorder_.has_value(); }
    /// The view after `seconds` more; nothing without a recording.
    void record(const scene::Camera& camera, double seconds);

    /// Appends the view as a keyframe. The first one replaces a path that was given.
    Result<void> append_key(const scene::Camera& camera);
    /// Removes the keyframe nearest to a time. Fails for the only one.
    Result<void> remove_key_at(double time);

    /// Writes STEM.toml, and STEM.gpx for a terrain with a place on Earth. Returns the files.
    [[nodiscard]] Result<std::vector<std::filesystem::path>>
    save(const scene::TerrainSurface& surface, const std::filesystem::path& stem) const;

private:
    scene::CameraPath path_;
    std::optional<scene::PathRecorder> recorder_;
    double recorded_ = 0.0; // seconds
    bool is_own_ = false;   // made of the user's views
};

} // namespace reljef::app
