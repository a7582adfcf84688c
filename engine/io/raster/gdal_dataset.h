#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal_priv.h>
#include <glm/vec2.hpp>

#include "engine/core/atomic_file.h"
#include "engine/core/result.h"

namespace reljef::io {

/// Collects this thread's GDAL messages instead of printing them; a truncated JPEG is an error.
class GdalMessages {
public:
    GdalMessages();
    ~GdalMessages();
    GdalMessages(const GdalMessages&) = delete;
    GdalMessages& operator=(const GdalMessages&) = delete;

    /// The last error as " (GDAL: …)", at most 200 characters in one line; empty without errors.
    /// A server's failure wins, as " (…)".
    [[nodiscard]] std::string reason() const;
    /// "FILE: cannot be written (GDAL: …)". GDAL's message names the target, not the
    /// temporary file.
    [[nodiscard]] Error cannot_write(const AtomicFile& file) const;
    /// Number of errors. GDAL may report success after an error.
    [[nodiscard]] std::size_t errors() const { return errors_; }
    /// Whether GDAL silently returned empty blocks of a damaged TIFF.
    [[nodiscard]] bool has_lost_blocks() const { return has_lost_blocks_; }
    /// Distinct warnings and errors in order, at most ten.
    [[nodiscard]] const std::vector<std::string>& all() const { return all_; }

private:
    static void handle(CPLErr kind, CPLErrorNum number, const char* text);

    CPLConfigOptionSetter strict_jpeg_;
    std::vector<std::string> all_;
    std::string last_error_;
    std::size_t errors_ = 0;
    bool is_of_server_ = false; ///< the last error
    bool has_lost_blocks_ = false;
};

struct DatasetCloser {
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, DatasetCloser>;

/// "1.5 GB" or "1.5 MB".
std::string size_text(double bytes);

/// Appends options.
void add_options(CPLStringList& list, std::initializer_list<std::string> options);

/// Whether GDAL reads the path from a server ("https://…") or a virtual file system ("/vsi…").
bool is_remote(const std::filesystem::path& path);

/// One name for a file, however its path is written; remote ones stay as they are.
std::string full_name(const std::filesystem::path& path);

/// A part of a band, and the buffer for its samples, row after row.
struct BandWindow {
    glm::ivec2 first{0};
    glm::ivec2 size{0};
    void* into = nullptr;
    glm::ivec2 into_size{0};
    GDALDataType type = GDT_Float64;
};
/// Ends at a stop (ReadScope). From a server, one deadline is for the whole window (ReadDeadline).
bool read_window(GDALRasterBand& band, const BandWindow& window);

/// Opens a raster read-only; the first one of a .zip. Fails without bands, and as open_checked
/// (gdal_drivers.h).
Result<Dataset> open_raster(const std::filesystem::path& path, const GdalMessages& messages);
/// Ignores overviews.
Result<Dataset> open_without_overviews(const std::filesystem::path& path,
                                       const GdalMessages& messages);
/// Reads an ASCII grid of whole numbers as floating-point numbers.
Result<Dataset> open_with_floats(const std::filesystem::path& path, const GdalMessages& messages);

/// Registers formats (gdal_drivers.h) once and limits GDAL's block cache to 256 MB. Thread-safe.
void register_drivers();

} // namespace reljef::io
