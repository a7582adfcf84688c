#include "engine/io/raster/raster.h"

#include <vector>

#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/georeferencing.h"
#include "engine/io/raster/sample_decoder.h"

namespace reljef::io {

Result<RasterInfo> read_raster_info(const std::filesystem::path& path) {
    GdalMessages messages;
    auto opened = open_raster(path, messages);
    if (!opened) {
        return opened.error();
    }
    GDALDataset& dataset = **opened;
    GDALRasterBand& band = *dataset.GetRasterBand(1);
    RasterInfo info;
    info.cols = dataset.GetRasterXSize();
    info.rows = dataset.GetRasterYSize();
    info.format = dataset.GetDriver()->GetDescription();
    info.type = GDALGetDataTypeName(band.GetRasterDataType());
    info.vertical_unit = height_unit_of(dataset, band).name;
    std::vector<std::string> ignored;
    if (const auto crs = horizontal_crs(dataset, ignored)) {
        CrsWords words = words_of(*crs);
        info.crs_name = std::move(words.name);
        info.crs_code = std::move(words.code);
        info.horizontal_unit = std::move(words.horizontal_unit);
    }
    return info;
}

} // namespace reljef::io
