#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "bench/baselines/baseline_suite.h"
#include "bench/baselines/baseline_view.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// A row to measure, and how it is drawn.
struct BaselineEntry {
    BaselineRow row = {};
    bool is_other = true; ///< another program: without it the suite continues
    int max_rounds = std::numeric_limits<int>::max();
    /// Shows the view's camera. Not timed.
    std::function<Result<void>()> set_camera = [] { return Result<void>(); };
    /// Returns milliseconds; may set the row's triangles.
    std::function<Result<double>(BaselineRow& row)> draw = {};
    std::function<Result<HitBuffer>()> hits = {};
    std::vector<double> ms = {};
};

using BaselineEntries = Result<std::vector<BaselineEntry>>;

// The other programs. `view` must outlive the entries, which follow its camera. Each fails with a
// sentence that names the package if its library or program is missing.

/// Irrlicht's terrain node with 1, 3 and 5 levels; the last one also with a moving camera.
BaselineEntries irrlicht_terrain_entries(const BaselineView& view);
/// Irrlicht's parallax material on a flat square.
BaselineEntries irrlicht_relief_entries(const BaselineView& view);
/// OpenSceneGraph's terrain tile with a vertex for every sample.
BaselineEntries openscenegraph_entries(const BaselineView& view);
/// POV-Ray's height field, by the program `povray`.
BaselineEntries povray_entries(const BaselineView& view);
/// Embree's grid and quads.
BaselineEntries embree_entries(const BaselineView& view);

} // namespace reljef::bench
