#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/core/result.h"
#include "engine/scene/motion/camera_path.h"

namespace reljef::scene {

// Each edit returns a changed copy of a path. Indices count the keyframes from 0 in the order of
// their times. An error leaves all as it was; it names what was found and what was expected.

/// Inserts a keyframe. It replaces the one at the same time, if there is one.
Result<CameraPath> with_key(const CameraPath& path, const Keyframe& key);
/// Removes a keyframe. Fails for the last one that remains.
Result<CameraPath> without_key(const CameraPath& path, std::size_t index);
/// Gives a keyframe the view of another one; it keeps its time.
Result<CameraPath> with_moved_key(const CameraPath& path, std::size_t index, const Keyframe& view);
/// Moves a keyframe to another time, also beyond its neighbours. Fails if another one is there.
Result<CameraPath> with_retimed_key(const CameraPath& path, std::size_t index, double time);
/// Stretches all times from the beginning on, so that the path takes `seconds` > 0. Fails for a
/// path with one keyframe.
Result<CameraPath> with_duration(const CameraPath& path, double seconds);

/// The keyframe whose time is nearest; the earlier one of two.
std::size_t nearest_key(const CameraPath& path, double time);

/// Records a flight as keyframes: four a second, and the last view. While the view is still, there
/// are only two.
class PathRecorder {
public:
    static constexpr double interval = 0.25; ///< seconds

    /// The view at a time since the start, seconds; times ascend. Ignores what is not finite.
    void add(const Keyframe& view);
    /// The recorded path. Fails if nothing was recorded.
    [[nodiscard]] Result<CameraPath> path() const;
    [[nodiscard]] double seconds() const { return last_ ? last_->time : 0.0; }

private:
    std::vector<Keyframe> keys_;
    std::optional<Keyframe> last_; // the last view; it may be none of the keys
};

} // namespace reljef::scene
