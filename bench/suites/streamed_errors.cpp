#include "bench/suites/streamed_errors.h"

#include <cmath>

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

} // namespace

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
