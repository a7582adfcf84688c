#include "engine/io/raster/gdal_dataset.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <string_view>
#include <system_error>
#include <utility>

#include <OpenImageIO/imageio.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>

#include "engine/io/raster/raster.h"
#include "engine/io/raster/web_tiles.h"

namespace reljef::io {
namespace fs = std::filesystem;
namespace {

constexpr GIntBig max_cached_bytes = GIntBig{1} << 28;
constexpr std::size_t max_messages = 10;
constexpr std::size_t longest_message = 200;
constexpr int max_archive_entries = 1000;
constexpr std::size_t largest_block = std::size_t{1} << 28; // bytes

std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
    while (!text.empty() && (text.back() == '.' || text.back() == ' ')) {
        text.pop_back();
    }
    if (text.size() > longest_message) {
        text.resize(longest_message);
        text += "…";
    }
    return text;
}

std::string extension_of(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return extension;
}

std::string raster_in_zip(const fs::path& path) {
    const std::string archive = "/vsizip/{" + path.string() + "}";
    const CPLStringList entries(VSIReadDirRecursive(archive.c_str()));
    for (int i = 0; i < std::min(entries.size(), max_archive_entries); ++i) {
        std::string entry = archive + "/" + entries[i];
        if (entry.back() != '/' && GDALIdentifyDriver(entry.c_str(), nullptr) != nullptr) {
            return entry;
        }
    }
    return path.string();
}

Result<std::string> name_for_gdal(const fs::path& path) {
    if (is_web_tiles(path)) {
        return web_tiles_description(path);
    }
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

/// Drivers of GDAL 3.6 for formats that files are named by (SRTMHGT) crash where one cannot be
/// read.
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

// A block is read as a whole, whatever part of it is wanted.
Result<void> check_blocks(GDALDataset& dataset, const fs::path& path) {
    for (int index = 1; index <= dataset.GetRasterCount(); ++index) {
        GDALRasterBand& band = *dataset.GetRasterBand(index);
        int cols = 0;
        int rows = 0;
        band.GetBlockSize(&cols, &rows);
        const double bytes =
            static_cast<double>(cols) * rows * GDALGetDataTypeSizeBytes(band.GetRasterDataType());
        if (bytes > static_cast<double>(largest_block)) {
            return Error{fmt::format("{}: is stored in blocks of {}×{} samples, which take {} "
                                     "each, blocks of at most {} were expected",
                                     path.string(), cols, rows, size_text(bytes),
                                     size_text(static_cast<double>(largest_block)))};
        }
    }
    return {};
}

/// Unless the user has set it.
void set_default(const char* option, const char* value) {
    if (CPLGetConfigOption(option, nullptr) == nullptr) {
        CPLSetConfigOption(option, value);
    }
}

} // namespace

bool is_remote(const fs::path& path) {
    const std::string name = path.string();
    const std::array<std::string_view, 4> beginnings{"http://", "https://", "ftp://", "/vsi"};
    return is_web_tiles(path) ||
           std::any_of(beginnings.begin(), beginnings.end(),
                       [&](std::string_view beginning) { return name.starts_with(beginning); });
}

void register_drivers() {
    static std::once_flag once;
    std::call_once(once, [] {
        // At the first TIFF of each, OpenImageIO and GDAL take the TIFF library's errors for
        // themselves: GDAL, which comes later now, hears them.
        static_cast<void>(OIIO::ImageInput::create("a.tif"));
        GDALAllRegister();
        // Of larger folders not each file's opening lists the whole.
        set_default("GDAL_READDIR_LIMIT_ON_OPEN", "50");
        set_default("GDAL_HTTP_CONNECTTIMEOUT", "10"); // seconds
        set_default("GDAL_HTTP_TIMEOUT", "60");
        // What hangs holds up a thread, and the program's end, no longer than this.
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

void GdalMessages::handle(CPLErr kind, CPLErrorNum /*number*/, const char* text) {
    auto* self = static_cast<GdalMessages*>(CPLGetErrorHandlerUserData());
    if (kind != CE_Warning && kind != CE_Failure && kind != CE_Fatal) {
        return;
    }
    std::string message = one_line(text);
    if (kind != CE_Warning) {
        self->last_error_ = message;
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
    return last_error_.empty() ? "" : fmt::format(" (GDAL: {})", last_error_);
}

void GdalMessages::clear() {
    all_.clear();
    last_error_.clear();
    errors_ = 0;
    has_lost_blocks_ = false;
}

std::string size_text(double bytes) {
    return bytes >= 1e9 ? fmt::format("{:.1f} GB", bytes / 1e9)
                        : fmt::format("{:.1f} MB", bytes / 1e6);
}

namespace {

Result<Dataset> open_with(const fs::path& path, const GdalMessages& messages,
                          const char* const* options) {
    register_drivers();
    const bool remote = is_remote(path);
    if (auto file = remote ? Result<void>() : check_file(path); !file) {
        return file.error();
    }
    const auto name = name_for_gdal(path);
    if (!name) {
        return name.error();
    }
    constexpr unsigned flags = GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR;
    // What lies beside a file on a server is not asked for: it would cost a request for each name.
    constexpr std::array<const char*, 1> nothing_beside{nullptr};
    Dataset dataset(GDALDataset::Open(name->c_str(), flags, nullptr, options,
                                      remote ? nothing_beside.data() : nullptr));
    if (dataset == nullptr) {
        return Error{
            fmt::format("{}: cannot be opened as a raster{}, a whole file in one of GDAL's "
                        "formats was expected",
                        path.string(), messages.reason())};
    }
    if (dataset->GetRasterCount() == 0) {
        return Error{fmt::format(
            "{}: holds no raster of its own, a file with one raster was expected", path.string())};
    }
    if (auto blocks = check_blocks(*dataset, path); !blocks) {
        return blocks.error();
    }
    return dataset;
}

} // namespace

Result<Dataset> open_raster(const fs::path& path, const GdalMessages& messages) {
    return open_with(path, messages, nullptr);
}

Result<Dataset> open_without_overviews(const fs::path& path, const GdalMessages& messages) {
    constexpr std::array<const char*, 2> options{"OVERVIEW_LEVEL=NONE", nullptr};
    return open_with(path, messages, options.data());
}

} // namespace reljef::io
