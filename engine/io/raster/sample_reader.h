#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gdal_priv.h>

#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/height_unit.h"
#include "engine/io/raster/raster.h"
#include "engine/io/raster/sample_grid.h"

namespace reljef::io {

/// Where the samples come from: a window of the full raster or of one of its overviews, and how
/// many of its samples a side are averaged into one.
struct ReadPlan {
    int overview = -1; ///< index; −1: the raster itself
    int col = 0;       ///< of the window, in the overview's samples
    int row = 0;
    int reduction = 1;
    SampleGrid grid; ///< the samples in the full raster
};

/// The finest reading that fits the memory budget; of overviews the one that spares the most
/// reading and is at most a third coarser. Adds a note when it reduces.
Result<ReadPlan> plan_reading(GDALDataset& dataset, const std::string& name,
                              const RasterOptions& options, std::vector<std::string>& notes);

/// Every `reduction`-th part of a window a side, from the coarsest overview that is fine enough;
/// finer where the window is smaller. Precondition: the window lies inside and is not empty.
ReadPlan plan_window(GDALDataset& dataset, const RasterOptions::Window& window, int reduction);

struct Samples {
    Grid<float> heights;          ///< metres; 0 at voids
    Grid<std::uint8_t> void_mask; ///< empty when there are none
    std::size_t void_count = 0;
};

/// Reads and decodes: palette or luminance of pictures, scale, offset, unit, voids. Adds notes on
/// what it took for heights and on voids that are not declared.
Result<Samples> read_samples(GDALDataset& dataset, const ReadPlan& plan, const std::string& name,
                             const RasterOptions& options, const GdalMessages& messages,
                             std::vector<std::string>& notes);

/// The same, with the digits of double: metres, void_value at voids. The notes are those on voids
/// alone, without numbers (SampleDecoder::found_words).
Result<Grid<double>> read_heights(GDALDataset& dataset, const ReadPlan& plan,
                                  const std::string& name, const RasterOptions& options,
                                  const GdalMessages& messages, std::vector<std::string>& notes);

} // namespace reljef::io
