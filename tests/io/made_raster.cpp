#include "tests/io/made_raster.h"

#include <memory>

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <ogr_spatialref.h>

namespace reljef::test {
namespace {

struct Closer {
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, Closer>;

GDALDriver* driver(const std::string& name) {
    GDALAllRegister();
    return GetGDALDriverManager()->GetDriverByName(name.c_str());
}

CPLStringList list_of(const std::vector<std::string>& words) {
    CPLStringList list;
    for (const std::string& word : words) {
        list.AddString(word.c_str());
    }
    return list;
}

void describe(GDALDataset& dataset, const MadeRaster& raster) {
    if (raster.geotransform) {
        std::array<double, 6> t = *raster.geotransform;
        dataset.SetGeoTransform(t.data());
    }
    if (!raster.crs.empty()) {
        OGRSpatialReference crs;
        crs.SetFromUserInput(raster.crs.c_str());
        crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        dataset.SetSpatialRef(&crs);
    }
}

void add_metadata(GDALDataset& dataset, const MadeRaster& raster) {
    for (const auto& [domain, key, value] : raster.metadata) {
        dataset.SetMetadataItem(key.c_str(), value.c_str(), domain.c_str());
    }
}

void describe(GDALRasterBand& band, const MadeRaster& raster) {
    if (raster.nodata) {
        band.SetNoDataValue(*raster.nodata);
    }
    if (!raster.unit.empty()) {
        band.SetUnitType(raster.unit.c_str());
    }
    if (raster.scale != 1.0 || raster.offset != 0.0) {
        band.SetScale(raster.scale);
        band.SetOffset(raster.offset);
    }
    if (!raster.palette.empty()) {
        GDALColorTable table;
        for (std::size_t i = 0; i < raster.palette.size(); ++i) {
            table.SetColorEntry(static_cast<int>(i), &raster.palette[i]);
        }
        band.SetColorInterpretation(GCI_PaletteIndex);
        band.SetColorTable(&table);
    }
}

bool fill(GDALDataset& dataset, const MadeRaster& raster) {
    describe(dataset, raster);
    add_metadata(dataset, raster);
    const std::size_t samples =
        static_cast<std::size_t>(raster.cols) * static_cast<std::size_t>(raster.rows);
    for (int i = 0; i < raster.bands; ++i) {
        GDALRasterBand& band = *dataset.GetRasterBand(i + 1);
        describe(band, raster);
        if (static_cast<std::size_t>(i) < raster.colors.size()) {
            band.SetColorInterpretation(raster.colors[static_cast<std::size_t>(i)]);
        }
        auto* values = const_cast<double*>(&raster.values[static_cast<std::size_t>(i) * samples]);
        if (band.RasterIO(GF_Write, 0, 0, raster.cols, raster.rows, values, raster.cols,
                          raster.rows, GDT_Float64, 0, 0, nullptr) != CE_None) {
            return false;
        }
    }
    auto overviews = raster.overviews;
    return overviews.empty() ||
           dataset.BuildOverviews("AVERAGE", static_cast<int>(overviews.size()), overviews.data(),
                                  0, nullptr, nullptr, nullptr) == CE_None;
}

} // namespace

QuietGdal::QuietGdal() {
    CPLPushErrorHandler(&CPLQuietErrorHandler);
}
QuietGdal::~QuietGdal() {
    CPLPopErrorHandler();
}

bool write(const MadeRaster& raster, const std::filesystem::path& path) {
    const QuietGdal quiet;
    GDALDriver* requested = driver(raster.format);
    if (requested == nullptr) {
        return false;
    }
    const bool direct = raster.format == "GTiff";
    CPLStringList options = list_of(raster.options);
    CPLStringList none;
    const Dataset dataset((direct ? requested : driver("MEM"))
                              ->Create(path.c_str(), raster.cols, raster.rows, raster.bands,
                                       raster.type, (direct ? options : none).List()));
    if (dataset == nullptr || !fill(*dataset, raster)) {
        return false;
    }
    if (direct) {
        return true;
    }
    const Dataset copy(requested->CreateCopy(path.c_str(), dataset.get(), FALSE, options.List(),
                                             nullptr, nullptr));
    return copy != nullptr;
}

bool write(const SparseTiff& tiff, const std::filesystem::path& path) {
    std::vector<std::string> texts = tiff.options;
    texts.insert(texts.end(), {"SPARSE_OK=TRUE", "COMPRESS=DEFLATE"});
    CPLStringList options = list_of(texts);
    const Dataset made(driver("GTiff")->Create(path.c_str(), tiff.cols, tiff.rows, tiff.bands,
                                               GDT_Byte, options.List()));
    return made != nullptr;
}

bool add_to_zip(const std::filesystem::path& archive, const std::string& member,
                const std::string& bytes) {
    const std::string name = "/vsizip/" + archive.string() + "/" + member;
    VSILFILE* const file = VSIFOpenL(name.c_str(), "wb");
    return file != nullptr && VSIFWriteL(bytes.data(), 1, bytes.size(), file) == bytes.size() &&
           VSIFCloseL(file) == 0;
}

std::string stretched_vrt(const std::string& source, const StretchedVrt& vrt) {
    return fmt::format(
        R"(<VRTDataset rasterXSize="65536" rasterYSize="65536"><SRS>EPSG:32631</SRS>)"
        "<GeoTransform>300000, {0}, 0, 5600000, 0, -{0}</GeoTransform>"
        R"(<VRTRasterBand dataType="{1}" band="1"><SimpleSource>)"
        R"(<SourceFilename relativeToVRT="1">{2}</SourceFilename>)"
        R"(<SrcRect xOff="0" yOff="0" xSize="256" ySize="256"/>)"
        R"(<DstRect xOff="0" yOff="0" xSize="65536" ySize="65536"/></SimpleSource>)"
        "</VRTRasterBand>{3}</VRTDataset>",
        vrt.step, vrt.type, source,
        vrt.overviews.empty() ? "" : fmt::format("<OverviewList>{}</OverviewList>", vrt.overviews));
}

} // namespace reljef::test
