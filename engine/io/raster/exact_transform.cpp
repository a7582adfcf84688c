#include "engine/io/raster/exact_transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace reljef::io {
namespace {

OGRSpatialReference wgs84() {
    OGRSpatialReference crs;
    crs.importFromEPSG(4326);
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return crs;
}

/// West, south, east, north of a grid's outline; false where it spans half the globe or more.
bool area_of(const ExactTransform& rough, const SampleGrid& grid, std::array<double, 4>& area) {
    constexpr int points = 21;
    std::vector<glm::dvec2> outline;
    for (int i = 0; i < points; ++i) {
        const double t = static_cast<double>(i) / (points - 1);
        const glm::dvec2 last(grid.cols - 1, grid.rows - 1);
        outline.insert(outline.end(), {glm::dvec2(t, 0.0) * last, glm::dvec2(t, 1.0) * last,
                                       glm::dvec2(0.0, t) * last, glm::dvec2(1.0, t) * last});
    }
    if (!rough.positions(grid, outline)) {
        return false;
    }
    const auto by_latitude = [](glm::dvec2 a, glm::dvec2 b) { return a.x < b.x; };
    const auto by_longitude = [](glm::dvec2 a, glm::dvec2 b) { return a.y < b.y; };
    const auto [south, north] = std::minmax_element(outline.begin(), outline.end(), by_latitude);
    const auto [west, east] = std::minmax_element(outline.begin(), outline.end(), by_longitude);
    area = {west->y, south->x, east->y, north->x};
    return area[2] - area[0] < 180.0 && area[0] >= -180.0 && area[2] <= 180.0;
}

} // namespace

glm::dvec2 crs_from_sample(const geo::PixelAffine& affine, const SampleGrid& grid,
                           glm::dvec2 sample) {
    return affine.crs_from_pixel(grid.pixel_from_sample(sample));
}

std::optional<ExactTransform> ExactTransform::create(const OGRSpatialReference& crs,
                                                     const geo::PixelAffine& affine,
                                                     const SampleGrid& grid) {
    const OGRSpatialReference target = wgs84();
    Transformation rough(OGRCreateCoordinateTransformation(&crs, &target));
    if (rough == nullptr) {
        return std::nullopt;
    }
    ExactTransform result(std::move(rough), affine);
    std::array<double, 4> area{};
    if (!area_of(result, grid, area)) {
        return result;
    }
    OGRCoordinateTransformationOptions options;
    options.SetAreaOfInterest(area[0], area[1], area[2], area[3]);
    Transformation best(OGRCreateCoordinateTransformation(&crs, &target, options));
    if (best != nullptr) {
        result.transform_ = std::move(best);
    }
    return result;
}

bool ExactTransform::positions(const SampleGrid& grid, std::span<glm::dvec2> samples) const {
    std::vector<double> x(samples.size());
    std::vector<double> y(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const glm::dvec2 point = crs_from_sample(affine_, grid, samples[i]);
        x[i] = point.x;
        y[i] = point.y;
    }
    std::vector<int> done(samples.size(), 0);
    transform_->Transform(static_cast<int>(samples.size()), x.data(), y.data(), nullptr,
                          done.data());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (done[i] == 0 || !std::isfinite(x[i]) || !(std::abs(y[i]) <= 90.0 + 1e-9)) {
            return false;
        }
        samples[i] = {y[i], x[i]};
    }
    return true;
}

} // namespace reljef::io
