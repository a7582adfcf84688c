#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/stress/stress_stage.h"

namespace reljef::bench {

struct StressView {
    std::string name;
    scene::Camera camera; ///< local metres
};

struct ViewCheck {
    std::string stress;
    bool has_row_per_view = false; ///< of the share of wrong pixels; otherwise one for all views
    bool exceeds_textures = false; ///< the surface exceeds what textures hold
};

/// Draws the views with every technique of the run and compares them with the exact hits. Rows of
/// each technique: pixels that are not finite, pixels of sky over ground, and the share of wrong
/// pixels; or the reason why the driver refuses.
Result<void> check_views(StressRun& run, const ViewCheck& check, std::string_view terrain,
                         StressStage& stage, const std::vector<StressView>& views);

} // namespace reljef::bench
