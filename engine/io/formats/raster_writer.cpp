#include "engine/io/formats/raster_writer.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "engine/core/atomic_file.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/georeferencing.h"

namespace reljef::io {
namespace fs = std::filesystem;
namespace {

constexpr int written_block = 256;     // samples per side
constexpr int min_overview = 256;      // samples per side
constexpr double writing_share = 0.75; // of the progress; the rest is for the overviews
constexpr int utm_zone_32_north = 32632;
constexpr float void_metres = -32768.0F;

Dataset create_geotiff(const fs::path& path, const HeightRaster& raster) {
    register_drivers();
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    const std::string side = fmt::format("={}", written_block);
    CPLStringList options;
    add_options(options,
                {"TILED=YES", "BLOCKXSIZE" + side, "BLOCKYSIZE" + side, "BIGTIFF=IF_SAFER"});
    return Dataset(
        driver->Create(path.c_str(), raster.cols, raster.rows, 1, GDT_Float32, options.List()));
}

bool place(GDALDataset& dataset, const HeightRaster& raster) {
    OGRSpatialReference crs;
    const glm::dvec2 corner = raster.first + raster.spacing * glm::dvec2(-0.5, 0.5);
    return crs.importFromEPSG(utm_zone_32_north) == OGRERR_NONE &&
           place_raster(dataset, {corner.x, raster.spacing, 0.0, corner.y, 0.0, -raster.spacing},
                        &crs);
}

// False if unwritable or stopped.
bool write_bands(GDALDataset& dataset, const FillHeights& fill, const ParallelOptions& parallel) {
    const int cols = dataset.GetRasterXSize();
    const int rows = dataset.GetRasterYSize();
    for (int row = 0; row < rows; row += written_block) {
        Grid<float> band(cols, std::min(written_block, rows - row));
        fill(row, band.view());
        if (parallel.stop.stop_requested() ||
            dataset.GetRasterBand(1)->RasterIO(GF_Write, 0, row, cols, band.rows(),
                                               band.samples().data(), cols, band.rows(),
                                               GDT_Float32, 0, 0, nullptr) != CE_None) {
            return false;
        }
        if (parallel.progress) {
            parallel.progress(writing_share * (row + band.rows()) / rows);
        }
    }
    return true;
}

int CPL_STDCALL overview_progress(double fraction, const char* /*message*/, void* context) {
    const auto& parallel = *static_cast<const ParallelOptions*>(context);
    if (parallel.progress) {
        parallel.progress(writing_share + (1.0 - writing_share) * fraction);
    }
    return parallel.stop.stop_requested() ? FALSE : TRUE;
}

bool write_overviews(GDALDataset& dataset, const HeightRaster& raster,
                     const ParallelOptions& parallel) {
    std::vector<int> factors;
    for (int factor = raster.finest_overview;
         std::max(raster.cols, raster.rows) / factor >= min_overview; factor *= 4) {
        factors.push_back(factor);
    }
    ParallelOptions context = parallel;
    return factors.empty() ||
           dataset.BuildOverviews("AVERAGE", static_cast<int>(factors.size()), factors.data(), 0,
                                  nullptr, overview_progress, &context) == CE_None;
}

// At the samples of a georeference; without a CRS, at its coordinates only.
bool place(GDALDataset& dataset, const geo::Georeference& georeference) {
    geo::PixelAffine affine = georeference.crs_from_pixel;
    const glm::dvec2 corner = affine.crs_from_pixel({-0.5, -0.5});
    affine.x0 = corner.x;
    affine.y0 = corner.y;
    OGRSpatialReference crs;
    const bool has_crs = crs.importFromWkt(georeference.wkt.c_str()) == OGRERR_NONE;
    if (has_crs && crs.IsCompound() != 0 && crs.GetTargetLinearUnits("COMPD_CS|VERT_CS") != 1.0) {
        crs.StripVertical(); // heights are metres
    }
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return place_raster(dataset, affine, has_crs ? &crs : nullptr);
}

Result<void> finish(Dataset dataset, AtomicFile& file, const GdalMessages& messages) {
    const CPLErr before = CPLGetLastErrorType();
    dataset.reset(); // flushes
    if (before < CE_Failure && CPLGetLastErrorType() >= CE_Failure) {
        return messages.cannot_write(file);
    }
    return file.commit();
}

struct SampleFormat {
    GDALDataType type = GDT_Byte;
    std::optional<double> in_void = std::nullopt;
};

// `place`: sets where the samples lie; false on failure.
template <class Sample, class Place>
Result<void> write_samples(const fs::path& path, Grid<Sample> samples, const SampleFormat& format,
                           const Place& place) {
    auto file = AtomicFile::create(path);
    if (!file) {
        return file.error();
    }
    const GdalMessages messages;
    register_drivers();
    CPLStringList options;
    add_options(options, {"COMPRESS=DEFLATE", "TILED=YES", "BIGTIFF=IF_SAFER"});
    const int cols = samples.cols();
    const int rows = samples.rows();
    Dataset dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        file->temporary().c_str(), cols, rows, 1, format.type, options.List()));
    const bool written =
        dataset != nullptr && place(*dataset) &&
        (!format.in_void ||
         dataset->GetRasterBand(1)->SetNoDataValue(*format.in_void) == CE_None) &&
        dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, cols, rows, samples.samples().data(),
                                            cols, rows, format.type, 0, 0, nullptr) == CE_None;
    return written ? finish(std::move(dataset), *file, messages) : messages.cannot_write(*file);
}

} // namespace

Result<void> write_heights(const fs::path& path, const HeightRaster& raster,
                           const FillHeights& fill, const ParallelOptions& parallel) {
    check(raster.cols > 0 && raster.rows > 0 && raster.finest_overview >= 2, "no raster to write");
    auto file = AtomicFile::create(path);
    if (!file) {
        return file.error();
    }
    const GdalMessages messages;
    Dataset dataset = create_geotiff(file->temporary(), raster);
    const bool written = dataset != nullptr && place(*dataset, raster) &&
                         write_bands(*dataset, fill, parallel) &&
                         write_overviews(*dataset, raster, parallel);
    if (parallel.stop.stop_requested()) {
        return Error{fmt::format("{}: stopped", path.string())};
    }
    if (!written) {
        return messages.cannot_write(*file);
    }
    return finish(std::move(dataset), *file, messages);
}

Result<void> write_bytes(const fs::path& path, const Grid<std::uint8_t>& bytes,
                         const std::optional<geo::Georeference>& georeference,
                         std::uint8_t in_void) {
    return write_samples(
        path, bytes, {GDT_Byte, static_cast<double>(in_void)},
        [&](GDALDataset& dataset) { return !georeference || place(dataset, *georeference); });
}

Result<void> write_heightfield(const fs::path& path, const terrain::Heightfield& heightfield) {
    Grid<float> metres = heightfield.heights;
    for (std::size_t i = 0; i < heightfield.void_mask.samples().size(); ++i) {
        if (heightfield.void_mask.samples()[i] != 0) {
            metres.samples()[i] = void_metres;
        }
    }
    const bool has_voids = heightfield.void_count > 0;
    return write_samples(
        path, std::move(metres),
        {GDT_Float32, has_voids ? std::optional<double>(void_metres) : std::nullopt},
        [&](GDALDataset& dataset) {
            const glm::dvec2 spacing = heightfield.spacing;
            return heightfield.georeference
                       ? place(dataset, *heightfield.georeference)
                       : place_raster(dataset, {0.0, spacing.x, 0.0, 0.0, 0.0, -spacing.y},
                                      nullptr);
        });
}

} // namespace reljef::io
