#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/georeferencing.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::io {

/// A window of the full raster or of an overview, and the reduction per side.
struct ReadPlan {
    int overview = -1; ///< index; −1: full resolution
    int col = 0;       ///< first sample of the window, in the overview
    int row = 0;
    int reduction = 1;
    SampleGrid grid; ///< in the full raster
};

/// The finest plan that fits the memory budget. Uses the overview that saves the most reading and
/// is at most a third coarser. Adds a note on a reduction.
Result<ReadPlan> plan_reading(GDALDataset& dataset, const std::string& name,
                              const RasterOptions& options, std::vector<std::string>& notes);

/// Reduces a window by `reduction` per side, from the coarsest overview that is fine enough; less
/// if the window is smaller. Precondition: the window lies inside and is not empty.
ReadPlan plan_window(GDALDataset& dataset, const RasterOptions::Window& window, int reduction);

struct Samples {
    Grid<float> heights;          ///< metres; 0 at voids
    Grid<std::uint8_t> void_mask; ///< 1: void; empty: no voids
    std::size_t void_count = 0;
};

/// Reads and decodes. Adds notes on the interpretation of values and on undeclared voids.
Result<Samples> read_samples(GDALDataset& dataset, const ReadPlan& plan, const std::string& name,
                             const RasterOptions& options, const GdalMessages& messages,
                             std::vector<std::string>& notes);

/// As read_samples in double precision; void_value at voids. Notes: SampleDecoder::found_notes.
Result<Grid<double>> read_heights(GDALDataset& dataset, const ReadPlan& plan,
                                  const std::string& name, const RasterOptions& options,
                                  const GdalMessages& messages, std::vector<std::string>& notes);

/// Orients the samples, fills voids and closes a global raster. Moves the place's georeference.
terrain::Heightfield heightfield_of(Samples samples, Place& place, double reduction);

/// The spacing of samples whose own is unknown, metres: 1, or if the relief would exceed half the
/// width, what makes it a tenth of the width, in two digits. `steps`: along both sides of the
/// raster. Adds a note.
double assumed_spacing(const terrain::HeightRange& range, glm::dvec2 steps,
                       std::vector<std::string>& notes);

} // namespace reljef::io
