#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/parallel_for.h"
#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {

/// The colour value to display as white, for more than 8 bits: 1 for fractions, else the highest
/// value found in sampled_windows(). 0 for 8 bits, whose white is 255.
double white_of(GDALDataset& image, const std::stop_token& stop = {});

/// A part of an image, pixels.
struct PixelWindow {
    glm::ivec2 first{0};
    glm::ivec2 size{0};
};
/// Windows over an image of `size` pixels in blocks of `block`: all of it, or evenly spread ones
/// with about `max_sampled_pixels` in total. A window has at most `max_window_pixels`.
std::vector<PixelWindow> sampled_windows(glm::ivec2 size, glm::ivec2 block);
inline constexpr int max_sampled_pixels = 1 << 22;
inline constexpr int max_window_pixels = 1 << 18;

/// An image of any bands and type as 8-bit RGB(A) on disk, with its overviews.
struct RgbImage {
    Dataset dataset;
    double white = 0.0; ///< see white_of; values of more than 8 bits are divided by it
};
/// Fails with its name for heights, a truncated or unsuitable image, and an absurd geotransform.
/// `white`: if known.
Result<RgbImage> open_rgb(const std::filesystem::path& path, std::optional<double> white,
                          const GdalMessages& messages, const std::stop_token& stop = {});

/// A GDAL raster of four bands over the pixels of `image`, which must outlive it.
Dataset raster_over(Image& image);

struct WarpOptions {
    int overview = -1;      ///< index; -1: full resolution
    glm::dvec2 scale{1.0};  ///< target pixels per source pixel read, along columns and rows
    std::size_t memory = 0; ///< bytes for warping; 0: GDAL's default
    Progress progress;
    std::stop_token stop;
};

/// Reprojects an image into `target`, bilinear; alpha is 0 outside the image. Positions err by up
/// to `max_warp_error`, and not in the first and last column. False if unreadable or stopped.
bool warp(GDALDataset& rgb, GDALDataset& target, const WarpOptions& options);
inline constexpr double max_warp_error = 0.05; // target pixels

/// "cannot be read as an image" with GDAL's reason.
Error unreadable_image(const std::filesystem::path& path, const GdalMessages& messages);

bool is_opaque(const Image& image);

/// Composites `top` over an image of the same size.
void composite_under(Image& top, const Image& beneath);

} // namespace reljef::io
