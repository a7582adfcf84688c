#pragma once

#include <string>

#include "engine/core/result.h"
#include "engine/session/ground.h"
#include "engine/session/log.h"

namespace reljef::cli {

/// Counts the frames of a camera path whose camera was raised above the ground.
class RaisedFrames {
public:
    void add(const session::Lift& lift);

    /// Reports raised frames. A path file that leads below the ground is an error; a measured track
    /// is only inaccurate, and a built-in path may graze a summit.
    [[nodiscard]] Result<void> report(session::Log& log, const std::string& path) const;

private:
    int frames_ = 0;
    int raised_ = 0;
    int underground_ = 0;
    double max_metres_ = 0.0;
};

} // namespace reljef::cli
