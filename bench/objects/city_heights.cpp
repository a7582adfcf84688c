#include "bench/objects/city_heights.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/core/parallel_for.h"
#include "engine/truth/mesh_caster.h"

namespace reljef::bench {

Result<Grid<float>> heights_of_city(const session::TerrainScene& city, unsigned threads,
                                    const std::stop_token& stop) {
    if (city.source != nullptr) {
        return Error{"a streamed city found, one that fits into memory was expected"};
    }
    const auto meshes = truth::MeshCaster::create(city.scene);
    if (!meshes) {
        return meshes.error();
    }
    const scene::TerrainSurface& ground = *city.terrain->get<scene::TerrainNode>()->surface;
    const glm::dmat4 world_from_local = city.terrain->world_from_local();
    const double above = meshes->bounds().high.z + 1.0;
    Grid<float> heights = ground.heightfield().heights;
    const auto raise = [&](int col, int row) {
        float& height = heights(col, row);
        const glm::dvec3 place = ground.placement().world_from_sample({col, row, height});
        const glm::dvec3 origin(world_from_local * glm::dvec4(place, 1.0));
        const Ray down{{origin.x, origin.y, above}, {0.0, 0.0, -1.0}};
        const reljef::Interval to_ground{0.0, std::max(above - origin.z, 0.0)};
        if (const auto hit = meshes->first_hit(down, to_ground)) {
            height += static_cast<float>(down.at(hit->t).z - origin.z);
        }
    };
    if (!meshes->empty() &&
        !for_each_cell(heights.cols(), heights.rows(), {threads, stop, {}}, raise)) {
        return Error{"interrupted while the heights of the city were made"};
    }
    return heights;
}

std::string scan_difference(const std::string& city, const terrain::Heightfield& scanned,
                            const terrain::Heightfield& heights) {
    const glm::ivec2 found(scanned.heights.cols(), scanned.heights.rows());
    const glm::ivec2 expected(heights.heights.cols(), heights.heights.rows());
    if (found != expected) {
        return fmt::format("{}: a surface model of {}x{} samples found, {}x{} as of the ground "
                           "were expected: not compared",
                           city, found.x, found.y, expected.x, expected.y);
    }
    const double spacing = std::min(heights.spacing.x, heights.spacing.y);
    double squares = 0.0;
    std::size_t count = 0;
    std::size_t far = 0;
    for (std::size_t i = 0; i < heights.heights.size(); ++i) {
        if (!scanned.void_mask.empty() && scanned.void_mask.samples()[i] != 0) {
            continue;
        }
        const double off =
            double{scanned.heights.samples()[i]} - double{heights.heights.samples()[i]};
        squares += off * off;
        far += std::abs(off) > spacing ? 1U : 0U;
        ++count;
    }
    const double samples = std::max(static_cast<double>(count), 1.0);
    return fmt::format("{}: the scanned surface model differs from the ground with its buildings "
                       "by {:.3g} m RMS, and by more than {:.3g} m at {:.1f} % of the samples. "
                       "Heights are those of ground and buildings, without what else was scanned "
                       "(trees), so that all forms are one city",
                       city, std::sqrt(squares / samples), spacing,
                       100.0 * static_cast<double>(far) / samples);
}

} // namespace reljef::bench
