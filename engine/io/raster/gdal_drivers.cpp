#include "engine/io/raster/gdal_drivers.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <string_view>
#include <vector>

#include <cpl_error.h>
#include <fmt/format.h>
#include <gdal_frmts.h>
#include <ogrsf_frmts.h>

#include "engine/io/checks/jpeg2000_bytes.h"
#include "engine/io/checks/picture_bytes.h"
#include "engine/io/raster/references.h"
#include "engine/io/remote/read_scope.h"

namespace reljef::io {
namespace {

// A picture a day for 27 years. GDAL keeps about a kilobyte for each band.
constexpr int max_bands = 10'000;
constexpr int max_depth = 2; // an overview's mask, a mask's overview
constexpr const char* front_driver = "reljef";

/// Whether files in the format may consist of several files, or name others.
enum FileCount { several_files, single_file };

struct Format {
    const char* name;
    void (*register_driver)();
    FileCount files = several_files;
};

// In GDAL's order: the last ones take files that others know better. None of them follows names to
// files that references.h does not check; netCDF-4 and HDF5 do. GIF is missing: GDAL decodes all
// pictures of a file when it opens the first.
constexpr std::array formats{Format{"VRT", &GDALRegister_VRT},
                             Format{"GTiff", &GDALRegister_GTiff, single_file},
                             Format{"HFA", &GDALRegister_HFA},
                             Format{"AIG", &GDALRegister_AIGrid},
                             Format{"AAIGrid", &GDALRegister_AAIGrid, single_file},
                             Format{"GRASSASCIIGrid", &GDALRegister_GRASSASCIIGrid, single_file},
                             Format{"ISG", &GDALRegister_ISG, single_file},
                             Format{"DTED", &GDALRegister_DTED, single_file},
                             Format{"PNG", &GDALRegister_PNG, single_file},
                             Format{"JPEG", &GDALRegister_JPEG, single_file},
                             Format{"BMP", &GDALRegister_BMP, single_file},
                             Format{"SRTMHGT", &GDALRegister_SRTMHGT, single_file},
                             Format{"Leveller", &GDALRegister_Leveller},
                             Format{"Terragen", &GDALRegister_Terragen, single_file},
                             Format{"JP2OpenJPEG", &GDALRegister_JP2OpenJPEG, single_file},
                             Format{"RST", &GDALRegister_IDRISI},
                             Format{"GSAG", &GDALRegister_GSAG, single_file},
                             Format{"GSBG", &GDALRegister_GSBG, single_file},
                             Format{"GS7BG", &GDALRegister_GS7BG, single_file},
                             Format{"WEBP", &GDALRegister_WEBP, single_file},
                             Format{"PNM", &GDALRegister_PNM},
                             Format{"BT", &GDALRegister_BT, single_file},
                             Format{"GTX", &GDALRegister_GTX, single_file},
                             Format{"BYN", &GDALRegister_BYN},
                             Format{"USGSDEM", &GDALRegister_USGSDEM, single_file},
                             Format{"SAGA", &GDALRegister_SAGA},
                             Format{"XYZ", &GDALRegister_XYZ, single_file},
                             Format{"HF2", &GDALRegister_HF2, single_file},
                             Format{"ZMap", &GDALRegister_ZMap},
                             Format{"NGSGEOID", &GDALRegister_NGSGEOID},
                             Format{"SIGDEM", &GDALRegister_SIGDEM},
                             Format{"TGA", &GDALRegister_TGA},
                             Format{"ENVI", &GDALRegister_ENVI},
                             Format{"EHdr", &GDALRegister_EHdr}};

bool is_format(std::string_view name) {
    return std::any_of(formats.begin(), formats.end(),
                       [&](const Format& format) { return format.name == name; });
}

std::atomic<bool>& external_allowed() {
    static std::atomic<bool> allowed{false};
    return allowed;
}

/// The name of the file on a server that this thread is opening; null: none.
thread_local const std::string* server_file = nullptr;

class ServerFileScope {
public:
    explicit ServerFileScope(const std::string& name) {
        server_file = is_on_server(name) ? &name : outer_;
    }
    ~ServerFileScope() { server_file = outer_; }
    ServerFileScope(const ServerFileScope&) = delete;
    ServerFileScope& operator=(const ServerFileScope&) = delete;

private:
    const std::string* outer_ = server_file;
};

std::string_view format_of(GDALDataset& dataset) {
    return dataset.GetDriver() != nullptr ? dataset.GetDriver()->GetDescription() : "";
}

/// Bands of which a block holds samples. Masks and overviews may be datasets of their own, which
/// may not tell their order: then all of their bands count.
int bands_of_block(GDALRasterBand& band, bool is_other_dataset) {
    GDALDataset* const dataset = band.GetDataset();
    if (dataset == nullptr) {
        return 1;
    }
    const char* const order = dataset->GetMetadataItem("INTERLEAVE", "IMAGE_STRUCTURE");
    const bool is_interleaved = order != nullptr ? EQUAL(order, "PIXEL") : is_other_dataset;
    return is_interleaved ? dataset->GetRasterCount() : 1;
}

/// GDAL always reads whole blocks; `bands`: those that a block holds.
Result<void> check_block(GDALRasterBand& band, int bands, const std::string& name) {
    int cols = 0;
    int rows = 0;
    band.GetBlockSize(&cols, &rows);
    const double bytes = static_cast<double>(cols) * rows * bands *
                         GDALGetDataTypeSizeBytes(band.GetRasterDataType());
    if (bytes <= static_cast<double>(max_block_bytes)) {
        return {};
    }
    return Error{fmt::format("{}: is stored in blocks of {}×{} samples{}, which take {} each, "
                             "blocks of at most {} were expected",
                             name, cols, rows, bands > 1 ? fmt::format(" of {} bands", bands) : "",
                             size_text(bytes), size_text(static_cast<double>(max_block_bytes)))};
}

/// Of a band, its overviews and its mask, and of their overviews and masks. Those of virtual
/// rasters are other files, which are checked when they are opened.
// NOLINTNEXTLINE(misc-no-recursion): max_depth
Result<void> check_band(GDALRasterBand& band, const std::string& name, int depth = 0) {
    auto good = check_block(band, bands_of_block(band, depth > 0), name);
    GDALDataset* const dataset = band.GetDataset();
    if (depth == max_depth || (dataset != nullptr && format_of(*dataset) == "VRT")) {
        return good;
    }
    for (int i = 0; good && i < band.GetOverviewCount(); ++i) {
        GDALRasterBand* const overview = band.GetOverview(i);
        good = overview != nullptr ? check_band(*overview, name, depth + 1) : good;
    }
    GDALRasterBand* const mask = good ? band.GetMaskBand() : nullptr;
    return mask != nullptr ? check_band(*mask, name, depth + 1) : good;
}

Result<void> check_sizes(GDALDataset& dataset, const std::string& name) {
    const int bands = dataset.GetRasterCount();
    if (bands > max_bands) {
        return Error{
            fmt::format("{}: has {} bands, at most {} were expected", name, bands, max_bands)};
    }
    const std::string_view format = format_of(dataset);
    for (int i = 1; i <= bands; ++i) {
        if (auto good = check_band(*dataset.GetRasterBand(i), name); !good) {
            return good;
        }
    }
    const double bytes =
        static_cast<double>(dataset.GetRasterXSize()) * dataset.GetRasterYSize() * bands;
    if (format == "WEBP" && bytes > static_cast<double>(max_block_bytes)) {
        return Error{fmt::format("{}: takes {} and is in a format that is read whole, at most {} "
                                 "were expected",
                                 name, size_text(bytes),
                                 size_text(static_cast<double>(max_block_bytes)))};
    }
    return format == "TGA" ? check_tga(name, dataset.GetRasterXSize(), dataset.GetRasterYSize())
                           : Result<void>();
}

Result<void> check_opened(GDALDataset& dataset, const std::string& name) {
    auto good = check_named_files(dataset);
    good = good ? check_sizes(dataset, name) : good;
    // Of the formats, it alone lists parts of any name.
    const bool has_parts = EQUAL(dataset.GetDriver()->GetDescription(), "HFA");
    return good && has_parts ? check_parts(dataset) : good;
}

/// Opens what the formats open, checked; stops GDAL from trying its other drivers.
GDALDataset* open_in_front(GDALOpenInfo* info) {
    if ((info->nOpenFlags & GDAL_OF_RASTER) == 0 || info->eAccess == GA_Update) {
        return nullptr;
    }
    if (server_file != nullptr && !std::string_view(info->pszFilename).starts_with(*server_file)) {
        CPLError(CE_Failure, CPLE_AppDefined, "%s refers to %s, one file was expected of a server",
                 server_file->c_str(), info->pszFilename);
        return nullptr;
    }
    const CPLStringList names = format_names();
    OpenRequest request;
    request.formats = names.List();
    request.options = info->papszOpenOptions;
    request.siblings = info->AreSiblingFilesLoaded() ? info->GetSiblingFiles() : nullptr;
    request.flags = static_cast<unsigned>(info->nOpenFlags);
    auto dataset = open_checked(info->pszFilename, request);
    if (!dataset) {
        CPLError(CE_Failure, CPLE_AppDefined, "%s", dataset.error().message.c_str());
        return nullptr;
    }
    if (*dataset == nullptr && CPLGetLastErrorType() < CE_Failure) {
        CPLError(CE_Failure, CPLE_OpenFailed, "%s is in none of the formats that are read",
                 info->pszFilename);
    }
    return dataset->release();
}

/// In front of drivers that the process has registered already.
void register_front_driver() {
    auto& manager = *GetGDALDriverManager();
    std::vector<GDALDriver*> drivers;
    while (manager.GetDriverCount() > 0) {
        drivers.push_back(manager.GetDriver(0));
        manager.DeregisterDriver(drivers.back());
    }
    auto front = std::make_unique<GDALDriver>();
    front->SetDescription(front_driver);
    front->SetMetadataItem(GDAL_DCAP_RASTER, "YES");
    front->pfnOpen = &open_in_front;
    manager.RegisterDriver(front.release()); // the manager owns it
    for (GDALDriver* const driver : drivers) {
        manager.RegisterDriver(driver);
    }
}

} // namespace

void register_formats() {
    register_front_driver();
    for (const Format& format : formats) {
        format.register_driver();
    }
    GDALRegister_MEM(); // rasters in memory
    RegisterOGRGPX();   // tracks
    RegisterOGRLIBKML();
    RegisterOGRKML();
    RegisterOGRGeoJSON();
    RegisterOGRShape(); // footprints, besides those of tracks
    RegisterOGRGeoPackage();
    RegisterOGRFlatGeobuf();
}

CPLStringList format_names() {
    CPLStringList names;
    auto& manager = *GetGDALDriverManager();
    for (int i = 0; i < manager.GetDriverCount(); ++i) {
        const char* const name = manager.GetDriver(i)->GetDescription();
        if (is_format(name) || (allows_external() && !EQUAL(name, front_driver))) {
            names.AddString(name);
        }
    }
    return names;
}

CPLStringList single_file_formats() {
    CPLStringList names;
    for (const Format& format : formats) {
        if (format.files == single_file) {
            names.AddString(format.name);
        }
    }
    return names;
}

bool has_format(const std::string& name) {
    const CPLStringList names = format_names();
    return GDALIdentifyDriverEx(name.c_str(), GDAL_OF_RASTER, names.List(), nullptr) != nullptr;
}

bool allows_external() {
    return external_allowed();
}

void allow_external(bool allowed) {
    register_drivers();
    external_allowed() = allowed;
    if (allowed) {
        GDALAllRegister();
    }
}

Result<Dataset> open_checked(const std::string& name, const OpenRequest& request) {
    if (ReadScope::stop_requested()) {
        return Error{fmt::format("{}: reading was stopped", name)};
    }
    const ServerFileScope scope(name);
    auto good = check_references(name);
    good = good ? check_png(name, PngPart::until_pixels) : good;
    good = good ? check_jpeg2000(name) : good;
    if (!good) {
        return good.error();
    }
    Dataset dataset(GDALDataset::Open(name.c_str(), request.flags, request.formats, request.options,
                                      request.siblings));
    if (dataset != nullptr) {
        good = check_opened(*dataset, name);
        if (!good) {
            return good.error();
        }
    }
    return dataset;
}

} // namespace reljef::io
