#pragma once

#include <string>

#include "engine/core/result.h"
#include "engine/session/ground.h"
#include "engine/session/log.h"

namespace reljef::cli {

/// Counts the frames whose camera was lifted above the ground.
class LiftedFrames {
public:
    void add(const session::Lift& lift);

    /// Notes lifted frames. They are an error if a path file leads below the ground; measured
    /// tracks are only inaccurate, and built-in paths may graze a summit.
    [[nodiscard]] Result<void> report(session::Log& log, const std::string& path) const;

private:
    int frames_ = 0;
    int lifted_ = 0;
    int underground_ = 0;
    double max_metres_ = 0.0;
};

/// A camera that `source` placed below the ground: an error if that is a scene file, else a note.
Result<void> report_lift(const session::Lift& lift, const std::string& source, bool is_of_file,
                         session::Log& log);

} // namespace reljef::cli
