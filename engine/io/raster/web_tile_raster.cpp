#include "engine/io/raster/web_tile_raster.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <cpl_vsi.h>
#include <fmt/format.h>

#include "engine/core/atomic_file.h"
#include "engine/io/raster/gdal_drivers.h"
#include "engine/io/raster/web_tiles.h"
#include "engine/io/remote/remote_files.h"

namespace reljef::io {
namespace {

constexpr const char* web_driver = "web tiles";
constexpr std::size_t max_tile_bytes = std::size_t{4} << 20;
// Half the side of the web mercator square, metres.
constexpr double half_side = std::numbers::pi * 6378137.0;
constexpr int channels = 3;
constexpr std::size_t tile_pixels = std::size_t{web_tiles_side} * web_tiles_side;
using TilePixels = std::array<GByte, channels * tile_pixels>;

/// The file of a tile; absent if there is none.
Result<std::optional<std::string>> tile_file(const WebTileSource& source, const std::string& name) {
    if (source.on_server) {
        return read_remote_file(name, max_tile_bytes);
    }
    std::error_code ignored;
    if (!std::filesystem::exists(name, ignored)) {
        return std::optional<std::string>();
    }
    auto file = read_text_file(name, max_tile_bytes);
    return file ? Result<std::optional<std::string>>(std::move(*file)) : file.error();
}

/// Replaces indexes, which are in the first channel.
void expand(const GDALColorTable& palette, TilePixels& pixels) {
    for (std::size_t i = 0; i < tile_pixels; ++i) {
        GDALColorEntry color{};
        palette.GetColorEntryAsRGB(pixels[i], &color);
        pixels[i] = static_cast<GByte>(color.c1);
        pixels[tile_pixels + i] = static_cast<GByte>(color.c2);
        pixels[2 * tile_pixels + i] = static_cast<GByte>(color.c3);
    }
}

/// Red, green and blue, one after the other. Grey counts as all three.
bool decode(std::string& file, TilePixels& pixels) {
    const std::string name = fmt::format("/vsimem/web_tile_{}", static_cast<const void*>(&file));
    auto* bytes = reinterpret_cast<GByte*>(file.data());
    VSIFCloseL(VSIFileFromMemBuffer(name.c_str(), bytes, file.size(), FALSE));
    constexpr std::array<const char*, 4> formats{"PNG", "JPEG", "WEBP", nullptr};
    constexpr std::array<const char*, 1> no_siblings{nullptr};
    OpenRequest request;
    request.formats = formats.data();
    request.siblings = no_siblings.data();
    auto opened = open_checked(name, request);
    Dataset picture = opened ? std::move(*opened) : nullptr;
    bool good = picture != nullptr && picture->GetRasterXSize() == web_tiles_side &&
                picture->GetRasterYSize() == web_tiles_side;
    if (good) {
        std::array<int, channels> bands{1, 2, 3};
        if (picture->GetRasterCount() < channels) {
            bands.fill(1);
        }
        good = picture->RasterIO(GF_Read, 0, 0, web_tiles_side, web_tiles_side, pixels.data(),
                                 web_tiles_side, web_tiles_side, GDT_Byte, channels, bands.data(),
                                 0, 0, 0, nullptr) == CE_None;
        const GDALColorTable* palette = picture->GetRasterBand(1)->GetColorTable();
        if (good && palette != nullptr) {
            expand(*palette, pixels);
        }
    }
    picture.reset();
    VSIUnlink(name.c_str());
    return good;
}

class WebTileBand;

/// One level; the finest has the others as overviews.
class WebTileLevel final : public GDALDataset {
public:
    WebTileLevel(const WebTileSource& source, int level, bool has_coarser);

    CPLErr GetGeoTransform(double* affine) override {
        const double pixel = 2.0 * half_side / nRasterXSize;
        const std::array<double, 6> own{-half_side, pixel, 0.0, half_side, 0.0, -pixel};
        std::copy(own.begin(), own.end(), affine);
        return CE_None;
    }
    const OGRSpatialReference* GetSpatialRef() const override { return &mercator_; }

    [[nodiscard]] int coarser_levels() const { return static_cast<int>(coarser_.size()); }
    GDALRasterBand* coarser_band(int index, int band) {
        const bool exists = index >= 0 && index < coarser_levels();
        return exists ? coarser_[static_cast<std::size_t>(index)]->GetRasterBand(band) : nullptr;
    }

    /// Reads a tile for all bands; stores that of `band` into `into`.
    CPLErr read_tile(glm::ivec2 tile, int band, void* into);

private:
    WebTileSource source_;
    int level_;
    OGRSpatialReference mercator_;
    std::vector<std::unique_ptr<WebTileLevel>> coarser_;
};

class WebTileBand final : public GDALRasterBand {
public:
    WebTileBand(WebTileLevel& level, int band) : level_(level) {
        poDS = &level;
        nBand = band;
        eDataType = GDT_Byte;
        nBlockXSize = nBlockYSize = web_tiles_side;
    }
    GDALColorInterp GetColorInterpretation() override {
        return static_cast<GDALColorInterp>(GCI_RedBand + nBand - 1);
    }
    int GetOverviewCount() override { return level_.coarser_levels(); }
    GDALRasterBand* GetOverview(int index) override { return level_.coarser_band(index, nBand); }

protected:
    CPLErr IReadBlock(int col, int row, void* into) override {
        return level_.read_tile({col, row}, nBand, into);
    }

private:
    WebTileLevel& level_;
};

WebTileLevel::WebTileLevel(const WebTileSource& source, int level, bool has_coarser)
    : source_(source), level_(level) {
    poDriver = GetGDALDriverManager()->GetDriverByName(web_driver);
    eAccess = GA_ReadOnly;
    nRasterXSize = nRasterYSize = web_tiles_side << level;
    mercator_.importFromEPSG(3857);
    mercator_.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    for (int band = 1; band <= channels; ++band) {
        SetBand(band, new WebTileBand(*this, band)); // owned by the dataset
    }
    for (int coarse = level - 1; has_coarser && coarse >= 0; --coarse) {
        coarser_.push_back(std::make_unique<WebTileLevel>(source, coarse, false));
    }
}

CPLErr WebTileLevel::read_tile(glm::ivec2 tile, int band, void* into) {
    const std::string name = source_.name(tile, level_);
    auto file = tile_file(source_, name);
    auto pixels = std::make_unique<TilePixels>();
    if (!file) {
        CPLError(CE_Failure, CPLE_HttpResponse, "%s", file.error().message.c_str());
        return CE_Failure;
    }
    if (file->has_value() && !decode(**file, *pixels)) {
        CPLError(CE_Failure, CPLE_FileIO, "%s is no picture of %d×%d pixels", name.c_str(),
                 web_tiles_side, web_tiles_side);
        return CE_Failure;
    }
    for (int other = 1; other <= channels; ++other) {
        const GByte* channel = pixels->data() + tile_pixels * static_cast<std::size_t>(other - 1);
        if (other == band) {
            std::memcpy(into, channel, tile_pixels);
        } else if (GDALRasterBlock* block =
                       GetRasterBand(other)->GetLockedBlockRef(tile.x, tile.y, TRUE)) {
            std::memcpy(block->GetDataRef(), channel, tile_pixels);
            block->DropLock();
        }
    }
    return CE_None;
}

} // namespace

Result<Dataset> open_web_tiles(const std::filesystem::path& path) {
    const auto source = web_tile_source(path);
    if (!source) {
        return source.error();
    }
    return Dataset(new WebTileLevel(*source, source->level, true));
}

void register_web_tiles() {
    auto driver = std::make_unique<GDALDriver>();
    driver->SetDescription(web_driver);
    driver->SetMetadataItem(GDAL_DCAP_RASTER, "YES");
    GetGDALDriverManager()->RegisterDriver(driver.release());
}

} // namespace reljef::io
