#include "engine/io/formats/geoid_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <system_error>
#include <utility>

#include <cpl_string.h>
#include <fmt/format.h>
#include <ogr_srs_api.h>

#include "engine/io/checks/lowercase.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/georeferencing.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

constexpr float max_undulation = 150.0F; // metres; the Earth has -107 to 86
// EGM2008 at 1′ has 21,600 by 10,801 samples, which take 0.9 GB as floats.
constexpr int max_geoid_side = 1 << 15;
constexpr double max_geoid_samples = 1 << 28;
constexpr double max_longitude = 720.0; // degrees; two turns either way
constexpr double min_geoid_step = 1e-6; // degrees; 0.1 m

Result<geo::Geoid> unfit(const std::string& name, const std::string& found) {
    return Error{
        fmt::format("{}: {}, a geoid's heights on a grid of degrees were expected", name, found)};
}

/// The latitudes and longitudes of a raster's outermost samples if they are not on Earth or one.
std::optional<std::string> misplaced(const geo::PixelAffine& affine, GDALRasterBand& band) {
    const glm::dvec2 first = affine.crs_from_pixel(glm::dvec2(0.5));
    const glm::dvec2 last =
        affine.crs_from_pixel(glm::dvec2(band.GetXSize(), band.GetYSize()) - 0.5);
    constexpr double rounding = 1e-6; // degrees
    const double latitude = std::max(std::abs(first.y), std::abs(last.y));
    const double longitude = std::max(std::abs(first.x), std::abs(last.x));
    const double step = std::min(std::abs(affine.x_col), std::abs(affine.y_row));
    return latitude <= 90.0 + rounding && longitude <= max_longitude && step >= min_geoid_step
               ? std::nullopt
               : std::optional(fmt::format("lies between {:.6g},{:.6g} and {:.6g},{:.6g}", first.y,
                                           first.x, last.y, last.x));
}

std::optional<Grid<float>> undulation_of(GDALRasterBand& band) {
    Grid<float> heights(band.GetXSize(), band.GetYSize());
    const glm::ivec2 size(heights.cols(), heights.rows());
    if (!read_window(band, {{}, size, heights.samples().data(), size, GDT_Float32})) {
        return std::nullopt;
    }
    int has_void = 0;
    const auto void_height = static_cast<float>(band.GetNoDataValue(&has_void));
    if (has_void != 0) {
        std::replace(heights.samples().begin(), heights.samples().end(), void_height,
                     std::numeric_limits<float>::quiet_NaN());
    }
    return heights;
}

} // namespace

Result<geo::Geoid> read_geoid(const fs::path& path) {
    const std::string name = path.string();
    if (extension_of(path) == ".pgm") {
        return geo::Geoid::read_pgm(path);
    }
    GdalMessages messages;
    auto dataset = open_raster(path, messages);
    if (!dataset) {
        return dataset.error();
    }
    if (auto good = check_affine(**dataset, name); !good) {
        return good.error();
    }
    std::vector<std::string> ignored;
    const auto affine = affine_of(**dataset);
    const auto crs = horizontal_crs(**dataset, ignored);
    if (!affine || !crs || crs->IsGeographic() == 0 || affine->x_row != 0.0 ||
        affine->y_col != 0.0 || affine->x_col == 0.0 || affine->y_row == 0.0) {
        return unfit(name, "is no grid of degrees");
    }
    GDALRasterBand& band = *(*dataset)->GetRasterBand(1);
    if (band.GetXSize() < 4 || band.GetYSize() < 4 || band.GetXSize() > max_geoid_side ||
        band.GetYSize() > max_geoid_side ||
        static_cast<double>(band.GetXSize()) * band.GetYSize() > max_geoid_samples) {
        return unfit(name, fmt::format("has {}×{} samples", band.GetXSize(), band.GetYSize()));
    }
    if (const auto found = misplaced(*affine, band)) {
        return unfit(name, *found);
    }
    auto undulation = undulation_of(band);
    if (!undulation) {
        return unfit(name, "cannot be read" + messages.reason());
    }
    float extreme = 0.0F;
    for (const float height : undulation->samples()) {
        extreme = std::abs(height) > std::abs(extreme) ? height : extreme;
    }
    if (std::abs(extreme) > max_undulation) {
        return unfit(name, fmt::format("{:.0f} m from the ellipsoid found", extreme));
    }
    const glm::dvec2 first = affine->crs_from_pixel(glm::dvec2(0.5));
    return geo::Geoid(path.filename().string(), std::move(*undulation), {first.y, first.x},
                      {affine->y_row, affine->x_col});
}

std::optional<fs::path> installed_geoid() {
    std::vector<fs::path> folders;
    const CPLStringList proj(OSRGetPROJSearchPaths());
    folders.reserve(static_cast<std::size_t>(proj.size()) + 1);
    for (int i = 0; i < proj.size(); ++i) {
        folders.emplace_back(proj[i]);
    }
    folders.push_back(geo::Geoid::installed_folder());
    for (const fs::path& folder : folders) {
        for (const char* file :
             {"egm96_15.gtx", "us_nga_egm96_15.tif", "egm96-5.pgm", "egm96-15.pgm"}) {
            std::error_code ignored;
            if (fs::is_regular_file(folder / file, ignored)) {
                return folder / file;
            }
        }
    }
    return std::nullopt;
}

} // namespace reljef::io
