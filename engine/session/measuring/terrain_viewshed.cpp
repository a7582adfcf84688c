#include "engine/session/measuring/terrain_viewshed.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/io/formats/raster_writer.h"
#include "engine/io/image/image.h"
#include "engine/io/raster/raster.h"
#include "engine/terrain/measure/sight.h"

namespace reljef::session {
namespace {

constexpr auto in_void = static_cast<std::uint8_t>(terrain::SeenState::unknown);
constexpr auto in_sight = static_cast<std::uint8_t>(terrain::SeenState::visible);

Result<glm::dvec2> sample_of_eye(const terrain::Terrain& terrain, glm::dvec2 place) {
    const terrain::Heightfield& field = terrain.heightfield;
    if (!field.georeference) {
        return Error{fmt::format("{}: no place on Earth found, a georeferenced terrain was "
                                 "expected",
                                 terrain.name)};
    }
    const auto sample = field.georeference->geodetic.sample(place.x, place.y);
    const glm::dvec2 last(field.heights.cols() - 1, field.heights.rows() - 1);
    const bool is_inside = sample && sample->x >= 0.0 && sample->y >= 0.0 && sample->x <= last.x &&
                           sample->y <= last.y;
    if (!is_inside || terrain::uses_void(field, *sample)) {
        return Error{fmt::format("--from: {},{} found{}, a place on {} was expected", place.x,
                                 place.y, is_inside ? ", which is a void" : "", terrain.name)};
    }
    return *sample;
}

// Without the rows and columns that close a globe.
Grid<std::uint8_t> source_samples(const Grid<std::uint8_t>& seen,
                                  const terrain::Heightfield& heightfield) {
    const geo::GlobalWrap wrap = heightfield.georeference
                                     ? heightfield.georeference->geodetic.rows().wrap()
                                     : geo::GlobalWrap();
    Grid<std::uint8_t> samples(seen.cols() - wrap.cols(), seen.rows() - wrap.rows());
    for (int row = 0; row < samples.rows(); ++row) {
        for (int col = 0; col < samples.cols(); ++col) {
            samples(col, row) = seen(col, row + wrap.north_rows());
        }
    }
    return samples;
}

Image grey_picture(const Grid<std::uint8_t>& seen) {
    Image picture(seen.cols(), seen.rows());
    for (int row = 0; row < seen.rows(); ++row) {
        for (int col = 0; col < seen.cols(); ++col) {
            const std::uint8_t grey = seen(col, row);
            picture(col, row) = Rgba8{grey, grey, grey, 255};
        }
    }
    return picture;
}

} // namespace

Result<TerrainViewshed> viewshed_of(const terrain::Terrain& terrain, const ViewshedRequest& request,
                                    const ParallelOptions& parallel) {
    const auto sample = sample_of_eye(terrain, request.from);
    if (!sample) {
        return sample.error();
    }
    const terrain::Heightfield& field = terrain.heightfield;
    const auto placement = terrain::Placement::create(field, request.placement);
    if (!placement) {
        return placement.error();
    }
    const terrain::MinMaxPyramid pyramid(field.heights.view());
    const double ground = terrain::bilinear_height(field.heights.view(), *sample);
    auto seen =
        terrain::viewshed(field, pyramid, *placement, {*sample, ground + request.eye_height},
                          {request.target_height, request.max_distance, parallel});
    if (!seen) {
        return Error{"interrupted"};
    }
    const auto samples = seen->samples();
    const auto visible = std::count(samples.begin(), samples.end(), in_sight);
    const auto voids = std::count(samples.begin(), samples.end(), in_void);
    const auto known = static_cast<double>(samples.size()) - static_cast<double>(voids);
    return TerrainViewshed{std::move(*seen), static_cast<double>(visible) / std::max(known, 1.0)};
}

Result<void> check_viewshed_name(const std::filesystem::path& path) {
    return io::names_geotiff(path) ? Result<void>() : io::check_image_name(path);
}

Result<void> write_viewshed(const std::filesystem::path& path, const TerrainViewshed& viewshed,
                            const terrain::Heightfield& heightfield) {
    const Grid<std::uint8_t> seen = source_samples(viewshed.seen, heightfield);
    return io::names_geotiff(path) ? io::write_bytes(path, seen, heightfield.georeference, in_void)
                                   : io::write_image(path, grey_picture(seen));
}

} // namespace reljef::session
