#include "engine/io/raster/raster.h"

#include "engine/io/checks/lowercase.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/georeferencing.h"

namespace reljef::io {

bool names_geotiff(const std::filesystem::path& path) {
    const std::string extension = extension_of(path);
    return extension == ".tif" || extension == ".tiff";
}

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
    std::vector<std::string> ignored;
    if (const auto crs = horizontal_crs(dataset, ignored)) {
        info.crs_name = names_of(*crs).name;
    }
    return info;
}

} // namespace reljef::io
