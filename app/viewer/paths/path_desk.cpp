#include "app/viewer/paths/path_desk.h"

#include "engine/session/flight_keys.h"

namespace reljef::app {

Result<void> PathDesk::set(Result<scene::CameraPath> path) {
    if (!path) {
        return path.error();
    }
    path_ = std::move(*path);
    is_own_ = true;
    return {};
}

Result<void> PathDesk::end_recording() {
    if (!recorder_) {
        return Error{"recording: none found; K begins one"};
    }
    auto recorded = recorder_->path();
    recorder_.reset();
    recorded_ = 0.0;
    return set(std::move(recorded));
}

void PathDesk::record(const scene::Camera& camera, double seconds) {
    if (recorder_) {
        recorder_->add({recorded_, camera.eye, camera.target});
        recorded_ += seconds;
    }
}

Result<void> PathDesk::append_key(const scene::Camera& camera) {
    const scene::Keyframe key{is_own_ ? path_.end() + seconds_between_keys : 0.0, camera.eye,
                              camera.target};
    return set(is_own_ ? scene::with_key(path_, key) : scene::CameraPath::create({key}));
}

Result<void> PathDesk::remove_key_at(double time) {
    return set(scene::without_key(path_, scene::nearest_key(path_, time)));
}

Result<std::vector<std::filesystem::path>> PathDesk::save(const scene::TerrainSurface& surface,
                                                          const std::filesystem::path& stem) const {
    const auto flight = session::flight_of(surface, path_);
    if (!flight) {
        return flight.error();
    }
    std::vector<std::filesystem::path> files{stem.string() + ".toml"};
    if (surface.heightfield().georeference) {
        files.emplace_back(stem.string() + ".gpx");
    }
    std::vector<AtomicFile> prepared;
    prepared.reserve(files.size());
    for (const std::filesystem::path& file : files) {
        auto one = io::prepare_flight(file, *flight);
        if (!one) {
            return one.error();
        }
        prepared.push_back(std::move(*one));
    }
    if (auto written = commit_all(prepared); !written) {
        return written.error();
    }
    return files;
}

} // namespace reljef::app
