#include "bench/suites/streamed_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/truth/scene_caster.h"
#include "engine/truth/streamed_truth.h"

namespace reljef::bench {
namespace {

constexpr std::size_t memory_of_truth = std::size_t{8} << 20U; // bytes

// The pixels between the checked ones become sky.
HitBuffer thinned(const HitBuffer& hits, int step) {
    HitBuffer some(hits.cols(), hits.rows());
    for (int y = 0; y < hits.rows(); y += step) {
        for (int x = 0; x < hits.cols(); x += step) {
            some(x, y) = hits(x, y);
        }
    }
    return some;
}

bool is_streamed(const scene::Scene& scene) {
    bool streamed = false;
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4&) {
        const auto* terrain = node.get<scene::TerrainNode>();
        streamed = streamed || (terrain != nullptr && terrain->stream != nullptr);
    });
    return streamed;
}

Result<Grid<double>> errors_in_memory(const scene::Scene& scene, const HitBuffer& hits) {
    const auto caster = truth::SceneCaster::create(scene);
    if (!caster) {
        return caster.error();
    }
    check(caster->terrains().size() == 1, "a scene with one terrain was expected");
    const truth::PlacedTerrain& terrain = caster->terrains().front();
    const truth::SurfaceView view{terrain.surface->heightfield().heights.view(),
                                  terrain.surface->placement(), terrain.world_from_local,
                                  scene.camera()};
    Grid<double> errors(hits.cols(), hits.rows(), std::numeric_limits<double>::quiet_NaN());
    for (int y = 0; y < hits.rows(); ++y) {
        for (int x = 0; x < hits.cols(); ++x) {
            if (truth::shows_terrain(hits(x, y))) {
                errors(x, y) =
                    truth::reprojection_error(view, {hits.cols(), hits.rows()}, {x, y}, hits(x, y));
            }
        }
    }
    return errors;
}

Result<Grid<double>> errors_of_samples(const scene::Scene& scene, const HitBuffer& hits,
                                       const ParallelOptions& parallel) {
    if (!is_streamed(scene)) {
        return errors_in_memory(scene, hits);
    }
    auto truth = truth::StreamedTruth::create(scene, memory_of_truth);
    return truth ? truth->reprojection_errors(scene.camera(), hits, parallel)
                 : Result<Grid<double>>(truth.error());
}

// Whether all pixels at the corners and sides of a square around the pixel show terrain.
bool is_surrounded(const HitBuffer& hits, glm::ivec2 pixel, int reach) {
    for (const int i : {0, 1, 2, 3, 5, 6, 7, 8}) {
        const glm::ivec2 at = pixel + reach * glm::ivec2(i % 3 - 1, i / 3 - 1);
        const bool is_inside = at.x >= 0 && at.y >= 0 && at.x < hits.cols() && at.y < hits.rows();
        if (!is_inside || hits(at.x, at.y).is_sky()) {
            return false;
        }
    }
    return true;
}

std::vector<glm::ivec2> surrounded_sky(const HitBuffer& hits, int reach) {
    std::vector<glm::ivec2> pixels;
    for (int y = 0; y < hits.rows(); ++y) {
        for (int x = 0; x < hits.cols(); ++x) {
            if (hits(x, y).is_sky() && is_surrounded(hits, {x, y}, reach)) {
                pixels.emplace_back(x, y);
            }
        }
    }
    return pixels;
}

} // namespace

Result<std::size_t> streamed_holes(const scene::Scene& scene, const HitBuffer& hits, int reach,
                                   const ParallelOptions& parallel) {
    std::vector<glm::ivec2> pixels = surrounded_sky(hits, reach);
    if (pixels.empty()) {
        return 0;
    }
    auto truth = truth::StreamedTruth::create(scene, memory_of_truth);
    const auto exact = truth
                           ? truth->draw_hits(scene.camera(), {hits.cols(), hits.rows()}, parallel)
                           : Result<HitBuffer>(truth.error());
    if (!exact) {
        return exact.error();
    }
    return static_cast<std::size_t>(
        std::count_if(pixels.begin(), pixels.end(), [&](glm::ivec2 pixel) {
            return !(*exact)(pixel.x, pixel.y).is_sky() && is_surrounded(*exact, pixel, reach);
        }));
}

Result<std::vector<double>> streamed_errors(const scene::Scene& scene, const HitBuffer& hits,
                                            int step, const ParallelOptions& parallel) {
    const auto errors = errors_of_samples(scene, thinned(hits, step), parallel);
    if (!errors) {
        return errors.error();
    }
    std::vector<double> list;
    for (const double error : errors->samples()) {
        if (!std::isnan(error)) {
            list.push_back(error);
        }
    }
    return list;
}

} // namespace reljef::bench
