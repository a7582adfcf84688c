#include "bench/suites/streamed_errors.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/scene/tile_stream.h"
#include "engine/truth/geometric_error.h"

namespace reljef::bench {
namespace {

double bilinear(const SampleHeights& heights, glm::dvec2 sample) {
    const glm::dvec2 inside = glm::clamp(sample, 0.0, heights.side - 1.0);
    const glm::ivec2 first = glm::min(glm::ivec2(inside), heights.side - 2);
    const glm::dvec2 part = inside - glm::dvec2(first);
    const auto at = [&](int col, int row) {
        return heights.height_at(first + glm::ivec2(col, row));
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), part.x), glm::mix(at(0, 1), at(1, 1), part.x),
                    part.y);
}

} // namespace

std::vector<double> streamed_errors(const scene::TerrainNode& terrain, const SampleHeights& heights,
                                    const scene::Camera& camera, const HitBuffer& hits, int step) {
    const glm::ivec2 size(hits.cols(), hits.rows());
    std::vector<double> errors;
    for (int y = 0; y < size.y; y += step) {
        for (int x = 0; x < size.x; x += step) {
            const Hit& hit = hits(x, y);
            if (!truth::shows_terrain(hit)) {
                continue;
            }
            const glm::dvec2 sample = hit.place();
            const glm::dvec2 placed =
                terrain.stream != nullptr ? terrain.stream->maker().on_overview(sample) : sample;
            const scene::Projected shown =
                scene::project(camera, size,
                               terrain.surface->placement().world_from_sample(
                                   {placed, bilinear(heights, sample)}));
            errors.push_back(glm::distance(shown.pixel, glm::dvec2(x, y) + 0.5));
        }
    }
    return errors;
}

} // namespace reljef::bench
