#pragma once

#include <optional>
#include <string>

#include "engine/core/result.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/tile_index.h"

namespace reljef::io {

/// What a file of an open tile set is now.
struct FileNow {
    Dataset dataset;                 ///< of the size and at the place that the index knows
    std::optional<std::string> note; ///< one sentence, where the file has others
};

/// A file of the index as it was opened just now. Where it was replaced by one of another size,
/// place or coordinate system that covers all samples of the indexed one, it is read at these
/// (bilinear, of finer samples their means). Fails where it was replaced by one that does not.
/// `crs`: WKT of the indexed file's.
Result<FileNow> as_indexed(Dataset opened, const IndexedFile& indexed, const std::string& crs,
                           const std::string& name);

} // namespace reljef::io
