#include "bench/claims/warp_phases.h"

#include <array>

#include <glm/vec4.hpp>

#include "engine/render/residency/prewarp.h"
#include "engine/scene/motion/poses.h"

namespace reljef::bench {
namespace {

// Heights above the plane and the eye, both in samples.
struct WarpedSurface {
    Grid<float> heights;
    render::Warp warp;
};

WarpedSurface surface_of(const CutCity& city) {
    const scene::TerrainSurface& whole = *city.whole.surface;
    const auto bounds = whole.bounds();
    Grid<float> heights = whole.heightfield().heights;
    const double spacing = (bounds.high.x - bounds.low.x) / (heights.cols() - 1);
    for (float& height : heights.samples()) {
        height = static_cast<float>((height - bounds.low.z) / spacing);
    }
    const glm::dvec3 eye = scene::pose_camera(scene::Pose::oblique, bounds, [&](double, double) {
                               return bounds.high.z;
                           }).eye;
    const glm::dvec4 in_samples((eye.x - bounds.low.x) / spacing, (bounds.high.y - eye.y) / spacing,
                                (eye.z - bounds.low.z) / spacing, 1.0);
    return {std::move(heights), render::Warp(in_samples)};
}

// `places`: of the size of the heights.
void move_points(const WarpedSurface& surface, Grid<glm::vec2>& places,
                 const ParallelOptions& parallel) {
    parallel_for(
        places.rows(),
        [&](int row) {
            for (int col = 0; col < places.cols(); ++col) {
                const float height = surface.heights(col, row);
                const auto seen = surface.warp.at(glm::dvec2(col, row), height);
                places(col, row) = seen ? glm::vec2(*seen) : glm::vec2(-1.0F);
            }
        },
        parallel);
}

} // namespace

Result<Measurement> measure_warp_phases(const CutCity& city, const MeasureOptions& options,
                                        unsigned threads) {
    const WarpedSurface surface = surface_of(city);
    const ParallelOptions parallel{threads, options.stop, {}};
    Grid<glm::vec2> places(surface.heights.cols(), surface.heights.rows());
    const DrawFrame move = [&]() -> Result<void> {
        move_points(surface, places, parallel);
        return {};
    };
    Grid<glm::vec2> rebuilt; // kept, so that no frame is left out as unused
    const DrawFrame rebuild = [&]() -> Result<void> {
        rebuilt = render::prewarped(surface.heights.view(), surface.warp, parallel);
        return {};
    };
    MeasureOptions timing = options;
    timing.null_pair = {0, 2};
    return measure(std::array{move, rebuild, move}, timing);
}

} // namespace reljef::bench
