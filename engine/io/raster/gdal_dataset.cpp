#include "engine/io/raster/gdal_dataset.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <mutex>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include <cpl_error.h>
#include <cpl_vsi.h>
#include <fmt/format.h>

#include "engine/io/checks/lowercase.h"
#include "engine/io/checks/zip_archive.h"
#include "engine/io/raster/gdal_drivers.h"
#include "engine/io/raster/raster.h"
#include "engine/io/raster/references.h"
#include "engine/io/raster/web_tile_raster.h"
#include "engine/io/raster/web_tiles.h"
#include "engine/io/remote/read_scope.h"
#include "engine/io/remote/remote_files.h"

namespace reljef::io {
namespace fs = std::filesystem;
namespace {

constexpr GIntBig max_cached_bytes = GIntBig{1} << 28;
constexpr std::size_t max_messages = 10;
constexpr std::size_t max_message_length = 200;
constexpr std::size_t max_archive_entries = 1000; // that are opened
// 100 million heights of ten characters. GDAL scans all of a text before it reads a height.
constexpr double max_server_text_bytes = 1e9;

std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
    while (!text.empty() && (text.back() == '.' || text.back() == ' ')) {
        text.pop_back();
    }
    if (text.size() > max_message_length) {
        text.resize(max_message_length);
        text += "…";
    }
    return text;
}

Result<std::string> raster_in_zip(const fs::path& path) {
    const auto members = archive_members(path);
    if (!members) {
        return members.error();
    }
    const std::size_t count = std::min(members->size(), max_archive_entries);
    for (const ArchiveMember& member : std::span(*members).first(count)) {
        if (ReadScope::stop_requested()) {
            return Error{fmt::format("{}: reading was stopped", path.string())};
        }
        if (has_format(member.name)) {
            return member.name;
        }
    }
    return Error{fmt::format("{}: has no raster among its first {} files, an archive with one was "
                             "expected",
                             path.string(), count)};
}

Result<std::string> name_for_gdal(const fs::path& path) {
    if (is_remote(path)) {
        const std::string name = path.string();
        return name.starts_with("/vsi") ? name : "/vsicurl/" + name;
    }
    const std::string extension = extension_of(path);
    if (extension == ".zip") {
        return raster_in_zip(path);
    }
    return extension == ".gz" ? "/vsigzip/" + fs::absolute(path).string() : path.string();
}

/// Prevents crashes of GDAL 3.6: SRTMHGT crashes on unreadable files.
Result<void> check_file(const fs::path& path) {
    const std::string name = path.string();
    std::error_code code;
    const fs::file_status status = fs::status(path, code);
    if (!fs::exists(status)) {
        return Error{fmt::format("{}: does not exist, a raster file was expected", name)};
    }
    if (fs::is_directory(status)) {
        return Error{fmt::format("{}: is a folder, one raster file was expected", name)};
    }
    if (!fs::is_regular_file(status)) {
        return Error{fmt::format("{}: is no regular file, a raster file was expected", name)};
    }
    if (const std::ifstream stream(path); !stream) {
        return Error{fmt::format("{}: cannot be read: {}, a raster file was expected", name,
                                 std::strerror(errno))};
    }
    if (fs::file_size(path, code) == 0) {
        return Error{fmt::format("{}: is empty, a raster file was expected", name)};
    }
    return {};
}

/// Sets an option unless the user has set it.
void set_default(const char* option, const char* value) {
    if (CPLGetConfigOption(option, nullptr) == nullptr) {
        CPLSetConfigOption(option, value);
    }
}

/// The length of a text on a server, before decompression in a .gz, bytes.
double server_text_bytes(const std::string& name) {
    const bool is_gzip = name.starts_with("/vsigzip/"); // GDAL would read all of it
    const std::string file = is_gzip ? name.substr(std::string_view("/vsigzip/").size()) : name;
    VSIStatBufL status{};
    return VSIStatL(file.c_str(), &status) == 0
               ? static_cast<double>(static_cast<vsi_l_offset>(status.st_size))
               : 0.0;
}

/// Fails if a readable file on a server may not be opened there.
Result<void> check_server_format(const std::string& name, const fs::path& path,
                                 const char* const* siblings) {
    constexpr std::array<std::string_view, 6> texts{"AAIGrid", "GRASSASCIIGrid", "GSAG",
                                                    "ISG",     "USGSDEM",        "XYZ"};
    CPLStringList formats = format_names();
    GDALDriverH driver =
        GDALIdentifyDriverEx(name.c_str(), GDAL_OF_RASTER, formats.List(), siblings);
    if (driver == nullptr) {
        return {};
    }
    const char* const format = GDALGetDescription(driver);
    if (single_file_formats().FindString(format) < 0) {
        return Error{fmt::format("{}: is in the format {}, which may name other files, one "
                                 "whole raster in one file was expected of a server",
                                 path.string(), GDALGetDriverLongName(driver))};
    }
    const bool is_text = std::find(texts.begin(), texts.end(), format) != texts.end();
    const double bytes = is_text ? server_text_bytes(name) : 0.0;
    if (bytes > max_server_text_bytes) {
        return Error{fmt::format("{}: is a text of {}, at most {} were expected of a server",
                                 path.string(), size_text(bytes),
                                 size_text(max_server_text_bytes))};
    }
    return {};
}

/// The name for GDAL of a raster that may be opened.
Result<std::string> checked_name(const fs::path& path) {
    if (const auto good = check_typed_name(path.string()); !good) {
        return good.error();
    }
    const auto good = is_remote(path) ? check_archives_of(path.string()) : check_file(path);
    return good ? name_for_gdal(path) : good.error();
}

Result<Dataset> open_with(const fs::path& path, const GdalMessages& messages,
                          const char* const* options) {
    register_drivers();
    const ReadDeadline deadline;
    if (is_web_tiles(path)) {
        return open_web_tiles(path);
    }
    const auto name = checked_name(path);
    if (!name) {
        return name.error();
    }
    CPLStringList formats = format_names();
    // No requests for sidecar files on servers. GDAL takes an empty list for none.
    const std::array<const char*, 2> only_itself{CPLGetFilename(name->c_str()), nullptr};
    OpenRequest request;
    request.formats = formats.List();
    request.options = options;
    if (is_on_server(*name)) {
        request.siblings = only_itself.data();
        if (const auto good = check_server_format(*name, path, request.siblings); !good) {
            return good.error();
        }
        formats = single_file_formats();
        request.formats = formats.List();
    }
    auto dataset = open_checked(*name, request);
    if (ReadScope::stop_requested() && (!dataset || *dataset == nullptr)) {
        return Error{fmt::format("{}: reading was stopped", path.string())};
    }
    if (!dataset) {
        std::string message = dataset.error().message;
        if (message.starts_with(*name)) {
            message.replace(0, name->size(), path.string());
        }
        return Error{std::move(message)};
    }
    if (*dataset == nullptr) {
        return Error{fmt::format("{}: cannot be opened as a raster{}, a whole file in one of the "
                                 "formats of elevation and pictures was expected",
                                 path.string(), messages.reason())};
    }
    if ((*dataset)->GetRasterCount() == 0) {
        return Error{fmt::format(
            "{}: holds no raster of its own, a file with one raster was expected", path.string())};
    }
    return dataset;
}

/// GDAL installs its handlers of libtiff's messages as it opens its first TIFF.
void install_tiff_handlers() {
    constexpr const char* name = "/vsimem/reljef-no-tiff";
    std::array<GByte, 8> header{'I', 'I', '*', 0, 0, 0, 0, 0};
    constexpr std::array<const char*, 2> formats{"GTiff", nullptr};
    const GdalMessages unprinted;
    VSIFCloseL(VSIFileFromMemBuffer(name, header.data(), header.size(), FALSE));
    const Dataset none(GDALDataset::Open(name, GDAL_OF_RASTER, formats.data()));
    VSIUnlink(name);
}

} // namespace

bool is_remote(const fs::path& path) {
    const std::string name = path.string();
    const std::array<std::string_view, 4> beginnings{"http://", "https://", "ftp://", "/vsi"};
    return is_web_tiles(path) ||
           std::any_of(beginnings.begin(), beginnings.end(),
                       [&](std::string_view beginning) { return name.starts_with(beginning); });
}

std::string full_name(const fs::path& path) {
    std::error_code ignored;
    const fs::path full = fs::weakly_canonical(path, ignored);
    return is_remote(path) || full.empty() ? path.string() : full.string();
}

void register_drivers() {
    static std::once_flag once;
    std::call_once(once, [] {
        register_formats();
        install_tiff_handlers();
        register_web_tiles();
        install_remote_files();
        // Virtual rasters run no programs.
        set_default("GDAL_VRT_ENABLE_PYTHON", "NO");
        // Raw rasters are read by lines: otherwise what a short file lacks is zeros without an
        // error.
        set_default("GDAL_ONE_BIG_READ", "NO");
        // Avoids listing a large folder for each file.
        set_default("GDAL_READDIR_LIMIT_ON_OPEN", "50");
        set_default("OGR_GEOJSON_MAX_OBJ_SIZE", "64"); // MB of memory
        set_default("GDAL_HTTP_CONNECTTIMEOUT", "10"); // seconds
        set_default("GDAL_HTTP_TIMEOUT", "60");
        // A stalled transfer blocks a thread and the program's exit no longer than this.
        set_default("GDAL_HTTP_LOW_SPEED_TIME", "10");
        set_default("GDAL_HTTP_LOW_SPEED_LIMIT", "100"); // bytes a second
        set_default("GDAL_HTTP_MAX_RETRY", "2");
        set_default("GDAL_HTTP_RETRY_DELAY", "1");
        GDALSetCacheMax64(std::min(GDALGetCacheMax64(), max_cached_bytes));
    });
}

void limit_block_cache(std::size_t bytes) {
    register_drivers();
    GDALSetCacheMax64(std::min(static_cast<GIntBig>(bytes), max_cached_bytes));
}

GdalMessages::GdalMessages() : strict_jpeg_("GDAL_ERROR_ON_LIBJPEG_WARNING", "TRUE", false) {
    CPLPushErrorHandlerEx(&GdalMessages::handle, this);
}

GdalMessages::~GdalMessages() {
    CPLPopErrorHandler();
}

void GdalMessages::handle(CPLErr kind, CPLErrorNum number, const char* text) {
    auto* self = static_cast<GdalMessages*>(CPLGetErrorHandlerUserData());
    if (kind != CE_Warning && kind != CE_Failure && kind != CE_Fatal) {
        return;
    }
    std::string message = one_line(text);
    if (kind != CE_Warning) {
        // Later errors follow from one of a server.
        const bool of_server = number == CPLE_HttpResponse;
        if (of_server || !self->is_of_server_) {
            self->last_error_ = message;
            self->is_of_server_ = of_server;
        }
        ++self->errors_;
        self->has_lost_blocks_ =
            self->has_lost_blocks_ || message.find("_TIFFPartialReadStrip") != std::string::npos;
    }
    std::vector<std::string>& all = self->all_;
    if (all.size() < max_messages && std::find(all.begin(), all.end(), message) == all.end()) {
        all.push_back(std::move(message));
    }
}

std::string GdalMessages::reason() const {
    return last_error_.empty() ? ""
                               : fmt::format(" ({}{})", is_of_server_ ? "" : "GDAL: ", last_error_);
}

Error GdalMessages::cannot_write(const AtomicFile& file) const {
    std::string why = reason();
    for (const auto& [temporary, asked] :
         {std::pair(file.temporary().string(), file.target().string()),
          std::pair(file.temporary().filename().string(), file.target().filename().string())}) {
        for (std::size_t at = why.find(temporary); at != std::string::npos;
             at = why.find(temporary, at + asked.size())) {
            why.replace(at, temporary.size(), asked);
        }
    }
    return Error{fmt::format("{}: cannot be written{}", file.target().string(), why)};
}

std::string size_text(double bytes) {
    return bytes >= 1e9 ? fmt::format("{:.1f} GB", bytes / 1e9)
                        : fmt::format("{:.1f} MB", bytes / 1e6);
}

void add_options(CPLStringList& list, std::initializer_list<std::string> words) {
    for (const std::string& word : words) {
        list.AddString(word.c_str());
    }
}

bool read_window(GDALRasterBand& band, const BandWindow& window) {
    const ReadDeadline deadline;
    GDALRasterIOExtraArg extra;
    INIT_RASTERIO_EXTRA_ARG(extra);
    extra.pfnProgress = &continues_reading;
    return band.RasterIO(GF_Read, window.first.x, window.first.y, window.size.x, window.size.y,
                         window.into, window.into_size.x, window.into_size.y, window.type, 0, 0,
                         &extra) == CE_None;
}

Result<Dataset> open_raster(const fs::path& path, const GdalMessages& messages) {
    return open_with(path, messages, nullptr);
}

Result<Dataset> open_without_overviews(const fs::path& path, const GdalMessages& messages) {
    constexpr std::array<const char*, 2> options{"OVERVIEW_LEVEL=NONE", nullptr};
    return open_with(path, messages, options.data());
}

Result<Dataset> open_with_floats(const fs::path& path, const GdalMessages& messages) {
    constexpr std::array<const char*, 2> options{"DATATYPE=Float64", nullptr};
    return open_with(path, messages, options.data());
}

} // namespace reljef::io
