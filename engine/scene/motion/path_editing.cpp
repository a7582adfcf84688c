#include "engine/scene/motion/path_editing.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace reljef::scene {
namespace {

std::vector<Keyframe> keys_of(const CameraPath& path) {
    return {path.keys().begin(), path.keys().end()};
}

Error no_such_key(const CameraPath& path, std::size_t index) {
    return Error{fmt::format("path: keyframe {} found, 1 to {} were expected", index + 1,
                             path.keys().size())};
}

bool is_number(const Keyframe& key) {
    const glm::dvec3 sum = key.eye + key.target;
    return std::isfinite(key.time + sum.x + sum.y + sum.z);
}

bool has_same_view(const Keyframe& a, const Keyframe& b) {
    return a.eye == b.eye && a.target == b.target;
}

} // namespace

Result<CameraPath> with_key(const CameraPath& path, const Keyframe& key) {
    std::vector<Keyframe> keys = keys_of(path);
    keys.push_back(key); // the last one at a time counts
    return CameraPath::create(std::move(keys));
}

Result<CameraPath> without_key(const CameraPath& path, std::size_t index) {
    std::vector<Keyframe> keys = keys_of(path);
    if (index >= keys.size()) {
        return no_such_key(path, index);
    }
    if (keys.size() == 1) {
        return Error{"path: its only keyframe found, one to remove beside another was expected"};
    }
    keys.erase(keys.begin() + static_cast<std::ptrdiff_t>(index));
    return CameraPath::create(std::move(keys));
}

Result<CameraPath> with_moved_key(const CameraPath& path, std::size_t index, const Keyframe& view) {
    std::vector<Keyframe> keys = keys_of(path);
    if (index >= keys.size()) {
        return no_such_key(path, index);
    }
    keys[index].eye = view.eye;
    keys[index].target = view.target;
    return CameraPath::create(std::move(keys));
}

Result<CameraPath> with_retimed_key(const CameraPath& path, std::size_t index, double time) {
    std::vector<Keyframe> keys = keys_of(path);
    if (index >= keys.size()) {
        return no_such_key(path, index);
    }
    for (std::size_t other = 0; other < keys.size(); ++other) {
        if (other != index && keys[other].time == time) {
            return Error{fmt::format("path: keyframe {} at {} s found, a free time was expected",
                                     other + 1, time)};
        }
    }
    keys[index].time = time;
    return CameraPath::create(std::move(keys));
}

Result<CameraPath> with_duration(const CameraPath& path, double seconds) {
    if (!(path.duration() > 0.0) || !(seconds > 0.0)) {
        return Error{fmt::format("path: {} s for {} keyframes found, a time over 0 and at least "
                                 "two keyframes were expected",
                                 seconds, path.keys().size())};
    }
    std::vector<Keyframe> keys = keys_of(path);
    for (Keyframe& key : keys) {
        key.time = path.begin() + (key.time - path.begin()) / path.duration() * seconds;
    }
    return CameraPath::create(std::move(keys));
}

std::size_t nearest_key(const CameraPath& path, double time) {
    const auto keys = path.keys();
    const auto nearest =
        std::min_element(keys.begin(), keys.end(), [time](const Keyframe& a, const Keyframe& b) {
            return std::abs(a.time - time) < std::abs(b.time - time);
        });
    return static_cast<std::size_t>(nearest - keys.begin());
}

void PathRecorder::add(const Keyframe& view) {
    if (!is_number(view) || (last_ && !(view.time > last_->time))) {
        return;
    }
    const bool moves_again = last_ && !keys_.empty() && has_same_view(*last_, keys_.back()) &&
                             !has_same_view(view, *last_);
    if (moves_again && last_->time > keys_.back().time) {
        keys_.push_back(*last_); // the end of a rest
    }
    const bool is_due = keys_.empty() || (view.time - keys_.back().time >= interval &&
                                          !has_same_view(view, keys_.back()));
    if (is_due) {
        keys_.push_back(view);
    }
    last_ = view;
}

Result<CameraPath> PathRecorder::path() const {
    std::vector<Keyframe> keys = keys_;
    if (last_) {
        keys.push_back(*last_);
    }
    return CameraPath::create(std::move(keys));
}

} // namespace reljef::scene
