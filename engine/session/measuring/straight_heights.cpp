#include "engine/session/measuring/straight_heights.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "engine/io/formats/raster_writer.h"
#include "engine/material/straight_walls.h"

namespace reljef::session {

Result<StraightHeights> write_straight_heights(const std::filesystem::path& path,
                                               const terrain::Terrain& terrain,
                                               std::optional<double> wall_height,
                                               const ParallelOptions& parallel) {
    const terrain::Heightfield& field = terrain.heightfield;
    if (field.reduction > 1.0) {
        return Error{fmt::format("--memory: too little found for all samples of {}, more, or a "
                                 "part of it, was expected",
                                 terrain.name)};
    }
    if (field.georeference && field.georeference->geodetic.rows().wrap().around) {
        return Error{fmt::format("{}: a terrain around the Earth found, a part of it was expected",
                                 terrain.name)};
    }
    const double steep = std::max({material::wall_height, field.spacing.x, field.spacing.y});
    auto made = material::straight_walls(field.heights.view(), field.void_mask,
                                         wall_height.value_or(steep), parallel);
    if (made.heights.empty()) {
        return Error{"interrupted"};
    }
    terrain::Heightfield straight = field;
    straight.heights = std::move(made.heights);
    if (auto written = io::write_heightfield(path, straight); !written) {
        return written.error();
    }
    return StraightHeights{made.changed, made.largest};
}

} // namespace reljef::session
