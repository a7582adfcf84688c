#include "app/cli/lifted_frames.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/session/flight_keys.h"
#include "engine/session/scene_setup.h"

namespace reljef::cli {

void LiftedFrames::add(const session::Lift& lift) {
    ++frames_;
    lifted_ += lift ? 1 : 0;
    underground_ += lift.depth > 0.0 ? 1 : 0;
    max_metres_ = std::max(max_metres_, lift.metres);
}

Result<void> LiftedFrames::report(session::Log& log, const std::string& path) const {
    if (lifted_ == 0) {
        return {};
    }
    const std::string text =
        fmt::format("--path {}: {} of {} frames would be under the ground or too close to it; "
                    "lifted by up to {:.1f} m; --allow-underground keeps them",
                    path, lifted_, frames_, max_metres_);
    if (underground_ > 0 && session::is_path_file(path)) {
        return Error{text};
    }
    log.note(text);
    return {};
}

Result<void> report_lift(const session::Lift& lift, const std::string& source, bool is_of_file,
                         session::Log& log) {
    if (!lift) {
        return {};
    }
    const std::string text = session::lift_note(lift, source);
    if (is_of_file) {
        return Error{text};
    }
    log.note(text);
    return {};
}

} // namespace reljef::cli
