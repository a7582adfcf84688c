#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <cpl_conv.h>
#include <gdal_priv.h>

#include "engine/core/result.h"

namespace reljef::io {

/// Keeps what GDAL says in the current thread, instead of letting it print, until the end of scope.
/// Meanwhile a JPEG cut short is an error, not a grey rest.
class GdalMessages {
public:
    GdalMessages();
    ~GdalMessages();
    GdalMessages(const GdalMessages&) = delete;
    GdalMessages& operator=(const GdalMessages&) = delete;

    /// GDAL's last error in one line of at most 200 characters, ready to follow a sentence:
    /// " (GDAL: …)"; empty when there was none.
    [[nodiscard]] std::string reason() const;
    /// How many errors there were: what GDAL returns as read need not be.
    [[nodiscard]] std::size_t errors() const { return errors_; }
    /// Whether GDAL took blocks of a TIFF whose place it could not read for blocks without values:
    /// nothing else tells.
    [[nodiscard]] bool has_lost_blocks() const { return has_lost_blocks_; }
    /// Each different warning and error once, in order, at most ten.
    [[nodiscard]] const std::vector<std::string>& all() const { return all_; }
    void clear();

private:
    static void handle(CPLErr kind, CPLErrorNum number, const char* text);

    CPLConfigOptionSetter strict_jpeg_;
    std::vector<std::string> all_;
    std::string last_error_;
    std::size_t errors_ = 0;
    bool has_lost_blocks_ = false;
};

struct DatasetCloser {
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, DatasetCloser>;

/// "1.5 GB", for sentences.
std::string size_text(double bytes);

/// Whether GDAL reads it from a server ("https://…") or another of its file systems ("/vsi…").
bool is_remote(const std::filesystem::path& path);

/// A file's raster, read-only; inside a .zip the first that GDAL opens. At least one band; no band
/// is stored in blocks so large that reading one would take more than 256 MB.
Result<Dataset> open_raster(const std::filesystem::path& path, const GdalMessages& messages);
/// The same, as if the file had no overviews.
Result<Dataset> open_without_overviews(const std::filesystem::path& path,
                                       const GdalMessages& messages);

/// The drivers are registered once, however many threads ask, and GDAL's cache of blocks, which all
/// readers share, is kept to 256 MB.
void register_drivers();

} // namespace reljef::io
