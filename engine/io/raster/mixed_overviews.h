#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {

/// Whether overviews average heights with undeclared voids, which leaves pits around each void.
/// Compares the eight steepest drops of one small overview with the full-resolution samples behind
/// them. Misses a single void if that overview is coarser than 1/16 or if cliffs are steeper.
/// Absent if the samples cannot be read.
std::optional<bool> overviews_mix_voids(GDALDataset& dataset, const std::filesystem::path& path);

/// The usual voids that a file does not declare and that are isolated from its heights
/// (SampleDecoder::isolated_voids): from all samples of a raster of up to 2^21, else from an
/// overview, else from up to 64 blocks that are spread over it. Absent if the samples cannot be
/// read. Precondition: the dataset has no overviews that mix voids with heights.
std::optional<std::vector<double>> undeclared_voids(GDALDataset& dataset,
                                                    const std::filesystem::path& path);

/// Note about a file whose overviews mix voids with heights, after its name.
inline constexpr const char* mixed_overviews_note =
    "its overviews are averages of heights and of voids that it does not declare: they are not "
    "used";

} // namespace reljef::io
