#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include "engine/core/color.h"
#include "engine/core/parallel_for.h"
#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {

/// The value of an image's colours that is to be white where they are wider than 8 bits: 1 for
/// fractions, else the highest found; 0 for 8 bits, whose white is 255. Of huge images only a part
/// is looked at.
double white_of(GDALDataset& image, const std::stop_token& stop = {});

/// An image of any bands and type as 8-bit red, green, blue and perhaps alpha, still on disk, with
/// its overviews; it keeps `image` open. Values of more than 8 bits are divided by `white`. Null
/// where it has no whole last block, or cannot be taken for an image.
Dataset as_rgb(Dataset image, double white);

/// Of an image so large that reading all of it would take minutes every how-manieth pixel a side.
int subsampling_of(GDALDataset& image);
/// The same with only these pixels.
Dataset subsampled(Dataset rgb, int subsampling);

/// A GDAL raster of four bands whose pixels are those of `image`, which outlives it.
Dataset raster_over(Image& image);

/// How the pixels of a warp are found.
struct WarpOptions {
    int overview = -1; ///< the one to read; -1: the image itself; automatic_overview: by the size
    /// Pixels of the target in one of what is read, so that all parts of a picture are averaged
    /// over as much; 0: as GDAL finds it for each.
    double scale = 0.0;
    /// Bytes for what is read and drawn at a time; 0: as many as GDAL takes.
    std::size_t memory = 0;
    Progress progress;
    std::stop_token stop;
};
inline constexpr int automatic_overview = -2;

/// Draws an image into a raster over the same ground, in their own coordinate systems, bilinear;
/// where it shows nothing alpha is 0. Places are right to `max_warp_error`, those of the first and
/// the last column exactly. False where it could not be read, or was stopped.
bool warp(GDALDataset& rgb, GDALDataset& target, const WarpOptions& options);
inline constexpr double max_warp_error = 0.05; // pixels of the target

/// Puts an image of the same size beneath one that is transparent in places.
void lay_under(Image& top, const Image& beneath);

} // namespace reljef::io
