#include "engine/view/frame_stats.h"

#include <algorithm>
#include <array>
#include <optional>

namespace reljef::view {
namespace {

template <typename T, typename Count, std::size_t N>
void add(T& sum, const T& part, const std::array<Count T::*, N>& counts) {
    for (Count T::*count : counts) {
        sum.*count += part.*count;
    }
}

std::optional<double> larger(std::optional<double> a, std::optional<double> b) {
    return a && b ? std::max(*a, *b) : (a ? a : b);
}

FrameStats::Skipped together(FrameStats::Skipped sum, const FrameStats::Skipped& part) {
    using Skipped = FrameStats::Skipped;
    add(sum, part,
        std::array{&Skipped::nodes_outside_frustum, &Skipped::tiles_outside_frustum,
                   &Skipped::tiles_occluded, &Skipped::selections_unchanged,
                   &Skipped::details_too_small, &Skipped::cuts_unchanged,
                   &Skipped::uploads_unchanged});
    add(sum, part,
        std::array{&Skipped::triangles_outside_frustum, &Skipped::triangles_under_error});
    return sum;
}

} // namespace

FrameStats together(const FrameStats& a, const FrameStats& b) {
    FrameStats sum = a;
    add(sum, b,
        std::array{&FrameStats::tiles, &FrameStats::tiles_missing, &FrameStats::tiles_cut,
                   &FrameStats::tiles_unproven, &FrameStats::reliefs_as_triangles,
                   &FrameStats::draws, &FrameStats::state_changes, &FrameStats::uploads});
    add(sum, b,
        std::array{&FrameStats::triangles, &FrameStats::slivers, &FrameStats::rays,
                   &FrameStats::upload_bytes});
    add(sum, b, std::array{&FrameStats::cpu_ms, &FrameStats::gpu_ms});
    sum.kept_error = larger(a.kept_error, b.kept_error);
    sum.mesh_error = larger(a.mesh_error, b.mesh_error);
    sum.lacks_triangles = a.lacks_triangles || b.lacks_triangles;
    sum.exceeded_by_rounding = a.exceeded_by_rounding || b.exceeded_by_rounding;
    sum.skipped = together(a.skipped, b.skipped);
    if (a.choice && b.choice) {
        add(*sum.choice, *b.choice,
            std::array{&Choice::tiles_as_triangles, &Choice::tiles_by_rays});
    } else if (b.choice) {
        sum.choice = b.choice;
    }
    return sum;
}

void add_mesh_error(FrameStats& stats) {
    stats.kept_error = larger(stats.kept_error, stats.mesh_error);
}

WorkTotals totals_of(const PictureWork& work) {
    WorkTotals totals{.taps = work.beam_taps};
    for (const PixelWork& pixel : work.pixels.samples()) {
        totals.taps += pixel.taps;
        totals.steps += pixel.steps;
        totals.rays += pixel.rays;
    }
    return totals;
}

} // namespace reljef::view
