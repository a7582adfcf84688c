#include "engine/io/imagery/image_place.h"

#include <cmath>
#include <limits>
#include <memory>

#include <cpl_string.h>
#include <gdal_alg.h>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "engine/io/raster/georeferencing.h"

namespace reljef::io {
namespace {

/// Between an image's pixels and coordinates, with ground control points, too.
class PixelTransform {
public:
    PixelTransform(GDALDataset& image, const std::string& crs)
        : transform_(nullptr, &GDALDestroyGenImgProjTransformer) {
        CPLStringList options;
        options.SetNameValue("DST_SRS", crs.c_str());
        transform_.reset(GDALCreateGenImgProjTransformer2(GDALDataset::ToHandle(&image), nullptr,
                                                          options.List()));
    }
    [[nodiscard]] glm::dvec2 from_pixel(glm::dvec2 pixel) const { return apply(FALSE, pixel); }
    [[nodiscard]] glm::dvec2 to_pixel(glm::dvec2 place) const { return apply(TRUE, place); }

private:
    /// NaN where undefined.
    [[nodiscard]] glm::dvec2 apply(int inverse, glm::dvec2 point) const {
        double height = 0.0;
        int valid = FALSE;
        const bool done =
            transform_ != nullptr && GDALGenImgProjTransform(transform_.get(), inverse, 1, &point.x,
                                                             &point.y, &height, &valid) != FALSE;
        return done && valid != FALSE && std::isfinite(point.x) && std::isfinite(point.y)
                   ? point
                   : glm::dvec2(std::numeric_limits<double>::quiet_NaN());
    }

    std::unique_ptr<void, decltype(&GDALDestroyGenImgProjTransformer)> transform_;
};

/// The pixel of an image that is nearest to the middle of the ground.
glm::dvec2 pixel_near(const ImageryGround& ground, const PixelTransform& transform,
                      glm::dvec2 size) {
    const glm::dvec2 middle = 0.5 * glm::dvec2(ground.size);
    const glm::dvec2 pixel = transform.to_pixel(ground.affine.crs_from_pixel(middle));
    return std::isnan(pixel.x) ? 0.5 * size : glm::clamp(pixel, glm::dvec2(0.5), size - 0.5);
}

} // namespace

bool place_over(const ImageryGround& ground, const geo::PixelAffine& affine, GDALDataset& raster) {
    if (ground.crs.empty()) {
        return place_raster(raster, affine, nullptr);
    }
    const OGRSpatialReference crs = crs_from_text(ground.crs);
    return place_raster(raster, affine, &crs);
}

geo::PixelAffine stretched_over(const ImageryGround& ground, glm::ivec2 size) {
    const glm::dvec2 scale = glm::dvec2(ground.size - 1) / glm::dvec2(glm::max(size - 1, 1));
    return affine_of_samples(ground.affine, {0.5 - 0.5 * scale, scale});
}

std::optional<DegreeBox> degree_box(GDALDataset& raster) {
    constexpr int intervals = 8;
    const PixelTransform to_degrees(raster, wgs84_degrees);
    const glm::dvec2 size(raster.GetRasterXSize(), raster.GetRasterYSize());
    const double middle = to_degrees.from_pixel(0.5 * size).x;
    glm::dvec2 low(1e9);
    glm::dvec2 high(-1e9);
    for (int row = 0; row <= intervals; ++row) {
        for (int col = 0; col <= intervals; ++col) {
            glm::dvec2 place =
                to_degrees.from_pixel(glm::dvec2(col, row) / double{intervals} * size);
            place.x += 360.0 * std::round((middle - place.x) / 360.0);
            low = std::isnan(place.x) ? low : glm::min(low, place);
            high = std::isnan(place.x) ? high : glm::max(high, place);
        }
    }
    const glm::dvec2 margin = 0.1 * (high - low);
    return std::isnan(middle) ? std::nullopt
                              : std::optional(DegreeBox{low.x - margin.x, low.y - margin.y,
                                                        high.x + margin.x, high.y + margin.y});
}

std::vector<double> turns_to_meet(const DegreeBox& box, const DegreeBox& other) {
    std::vector<double> turns;
    for (const double turn : {0.0, -360.0, 360.0}) {
        if (box[0] + turn <= other[2] && box[2] + turn >= other[0] && box[1] <= other[3] &&
            box[3] >= other[1]) {
            turns.push_back(turn);
        }
    }
    return turns;
}

double units_in_degree(const std::string& crs) {
    if (crs.empty()) {
        return 0.0;
    }
    const OGRSpatialReference reference = crs_from_text(crs);
    return reference.IsGeographic() != 0 ? 1.0 / glm::degrees(reference.GetAngularUnits()) : 0.0;
}

std::optional<glm::dmat2> steps_over(const ImageryGround& ground, GDALDataset& image) {
    const glm::dvec2 size(image.GetRasterXSize(), image.GetRasterYSize());
    const PixelTransform to_ground(image, ground.crs);
    const glm::dvec2 pixel = pixel_near(ground, to_ground, size);
    const double around = 360.0 * units_in_degree(ground.crs);
    glm::dmat2 steps(0.0);
    for (const int axis : {0, 1}) {
        glm::dvec2 half(0.0);
        half[axis] = 0.5;
        steps[axis] = to_ground.from_pixel(pixel + half) - to_ground.from_pixel(pixel - half);
        steps[axis].x = around > 0.0 ? std::remainder(steps[axis].x, around) : steps[axis].x;
    }
    const double area = std::abs(glm::determinant(steps));
    return area > 0.0 && std::isfinite(area) ? std::optional(steps) : std::nullopt;
}

} // namespace reljef::io
