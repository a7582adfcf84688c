#include "engine/io/tile_layer.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gdal_utils.h>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include "engine/io/raster/georeferencing.h"
#include "engine/io/raster/sample_decoder.h"

namespace reljef::io {
namespace {

constexpr double same_sample = 1e-3; // samples

struct RasterPlace {
    glm::dvec2 size{0.0};
    geo::PixelAffine crs_from_pixel; // (0,0) is the outer corner
    std::string crs;                 // WKT

    [[nodiscard]] glm::dvec2 pixel_from_crs(glm::dvec2 point) const {
        const geo::PixelAffine& affine = crs_from_pixel;
        const glm::dmat2 steps(affine.x_col, affine.y_col, affine.x_row, affine.y_row);
        return glm::inverse(steps) * (point - glm::dvec2(affine.x0, affine.y0));
    }
};

std::optional<RasterPlace> place_of_raster(GDALDataset& dataset, const std::string& name) {
    std::vector<std::string> ignored;
    const auto affine = check_affine(dataset, name) ? affine_of(dataset) : std::nullopt;
    const auto crs = affine ? horizontal_crs(dataset, ignored) : std::nullopt;
    if (!crs || crs->IsLocal() != 0) {
        return std::nullopt;
    }
    return RasterPlace{{dataset.GetRasterXSize(), dataset.GetRasterYSize()}, *affine, wkt_of(*crs)};
}

bool is_same(const RasterPlace& now, const RasterPlace& before) {
    const auto miss = [&](glm::dvec2 pixel) {
        const glm::dvec2 moved =
            before.pixel_from_crs(now.crs_from_pixel.crs_from_pixel(pixel)) - pixel;
        return std::max(std::abs(moved.x), std::abs(moved.y));
    };
    return now.size == before.size && is_same_crs(now.crs, before.crs) &&
           std::max({miss({0.0, 0.0}), miss({now.size.x, 0.0}), miss({0.0, now.size.y})}) <
               same_sample;
}

/// Whether the border of the indexed samples lies on the raster.
bool covers(const RasterPlace& now, const RasterPlace& before) {
    constexpr int steps = 16;
    std::vector<glm::dvec2> points;
    for (int i = 0; i <= steps; ++i) {
        const double part = static_cast<double>(i) / steps;
        for (const glm::dvec2 at : {glm::dvec2(part, 0.0), {part, 1.0}, {0.0, part}, {1.0, part}}) {
            points.push_back(before.crs_from_pixel.crs_from_pixel(0.5 + at * (before.size - 1.0)));
        }
    }
    if (!is_same_crs(now.crs, before.crs)) {
        const auto transform = CrsTransform::create(before.crs, now.crs);
        if (!transform) {
            return false;
        }
        transform->apply(points);
    }
    return std::all_of(points.begin(), points.end(), [&](glm::dvec2 point) {
        const glm::dvec2 pixel = now.pixel_from_crs(point);
        return glm::all(glm::greaterThanEqual(pixel, glm::dvec2(-same_sample))) &&
               glm::all(glm::lessThanEqual(pixel, now.size + same_sample));
    });
}

bool is_north_up(const geo::PixelAffine& affine) {
    return affine.x_row == 0.0 && affine.y_col == 0.0 && affine.x_col > 0.0 && affine.y_row < 0.0;
}

/// Options of gdalwarp. Without a declared void, SRTM's void value is excluded.
CPLStringList warp_arguments(GDALRasterBand& band, const RasterPlace& before) {
    const glm::dvec2 low = before.crs_from_pixel.crs_from_pixel({0.0, before.size.y});
    const glm::dvec2 high = before.crs_from_pixel.crs_from_pixel({before.size.x, 0.0});
    CPLStringList arguments;
    const auto exact = [](double value) { return fmt::format("{:.17g}", value); };
    add_options(arguments,
                {"-of", "VRT", "-ot", "Float64", "-r", "bilinear", "-et", "0", "-novshift",
                 "-t_srs", before.crs, "-te", exact(low.x), exact(low.y), exact(high.x),
                 exact(high.y), "-ts", exact(before.size.x), exact(before.size.y)});
    int declared = 0;
    band.GetNoDataValue(&declared);
    if ((band.GetMaskFlags() & GMF_PER_DATASET) != 0) {
        add_options(arguments, {"-dstalpha"});
    } else if (declared == 0) {
        add_options(arguments, {"-srcnodata", "-32768", "-dstnodata", "-32768"});
    }
    return arguments;
}

/// Heights in metres at the indexed samples; null if GDAL fails. Keeps `now` open.
Dataset at_indexed_samples(Dataset now, const RasterPlace& before) {
    GDALRasterBand& band = *now->GetRasterBand(1);
    const double metres = height_unit_of(*now, band).metres;
    CPLStringList arguments = warp_arguments(band, before);
    const std::unique_ptr<GDALWarpAppOptions, decltype(&GDALWarpAppOptionsFree)> options(
        GDALWarpAppOptionsNew(arguments.List(), nullptr), &GDALWarpAppOptionsFree);
    if (options == nullptr) {
        return nullptr;
    }
    GDALDatasetH source = GDALDataset::ToHandle(now.get());
    Dataset made(
        GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &source, options.get(), nullptr)));
    if (made != nullptr) {
        GDALRasterBand& heights = *made->GetRasterBand(1);
        heights.SetScale(band.GetScale() * metres);
        heights.SetOffset(band.GetOffset() * metres);
        heights.SetUnitType("m");
        now.release()->ReleaseRef(); // `made` holds its own reference
    }
    return made;
}

} // namespace

Result<ReplacedFile> as_indexed(Dataset opened, const IndexedFile& indexed, const std::string& crs,
                                const std::string& name) {
    const RasterPlace before{{indexed.cols, indexed.rows}, indexed.crs_from_pixel, crs};
    const auto now = place_of_raster(*opened, name);
    const bool is_same_plane = crs == plane_metres && opened->GetRasterXSize() == indexed.cols &&
                               opened->GetRasterYSize() == indexed.rows;
    if (is_same_plane || (now && is_same(*now, before))) {
        return ReplacedFile{std::move(opened), {}};
    }
    const std::string found = fmt::format("{}: was replaced while it was open, by {}×{} samples",
                                          name, opened->GetRasterXSize(), opened->GetRasterYSize());
    Dataset at_samples;
    if (now && crs != plane_metres && covers(*now, before) && is_north_up(before.crs_from_pixel) &&
        kind_of_values(*opened) == ValueKind::plain) {
        at_samples = at_indexed_samples(std::move(opened), before);
    }
    if (at_samples == nullptr) {
        return Error{fmt::format("{} that are no heights over all the ground of the {}×{} before; "
                                 "the same ground was expected, or a new start",
                                 found, indexed.cols, indexed.rows)};
    }
    return ReplacedFile{
        std::move(at_samples),
        fmt::format("{}: they are read at the places of the {}×{} before until the next "
                    "start",
                    found, indexed.cols, indexed.rows)};
}

} // namespace reljef::io
