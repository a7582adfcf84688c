#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/view/frame_stats.h"

namespace reljef::bench {

/// The ends of the error scale, pixels; errors beyond them have the colour of the end.
inline constexpr double heat_low_px = 0.01;
inline constexpr double heat_high_px = 100.0;

/// The colour of an infinite error; not on the scale.
inline constexpr Rgba8 heat_unbounded{255, 0, 255, 255};

/// Colours of errors in equal steps of the logarithm, 16 per decade. Their lightness (Oklab) grows
/// in equal steps (Kovesi 2015, "Good Colour Maps: How to Design Them").
inline constexpr std::size_t heat_levels = 64;
std::array<Rgba8, heat_levels> heat_scale();

/// Colours errors, in pixels, by heat_scale(); infinite ones are heat_unbounded, NaN (no error) is
/// a grey hatch. Precondition: no error is negative.
Image heat_map(const Grid<float>& error_px);

/// Taps of a pixel at the ends of the same scale for work.
inline constexpr double work_low = 1.0;
inline constexpr double work_high = 10'000.0;
static_assert(work_high / work_low == heat_high_px / heat_low_px);

/// Colours the taps of pixels by heat_scale(); pixels without taps are the grey hatch.
Image work_map(const Grid<view::PixelWork>& pixels);

/// The picture of a technique, the true picture and the error; of one size, not empty.
struct ShownView {
    Image shown;
    std::shared_ptr<const Image> truth;
    Grid<float> reprojection;        ///< error, pixels; NaN: none
    Grid<view::PixelWork> work = {}; ///< empty: it was not counted
};

/// The pictures of a row, encoded.
struct RowView {
    using File = std::vector<std::byte>;

    glm::ivec2 size{0};                ///< of each, pixels
    File shown;                        ///< JPEG
    std::shared_ptr<const File> truth; ///< JPEG, shared by the rows of one truth
    File heat;                         ///< PNG, heat_map() of the reprojection error
    File work;                         ///< PNG, work_map(); empty: it was not counted
};

class RowViews {
public:
    /// Reduces larger pictures by a whole factor to at most `max_cols` columns; 0: never. Colours
    /// are averaged in linear light, of errors the maximum is taken.
    explicit RowViews(int max_cols = 0) : max_cols_(max_cols) {}

    Result<std::shared_ptr<const RowView>> make(const ShownView& view);

private:
    Result<std::shared_ptr<const RowView::File>> truth_of(const ShownView& view, int factor);

    int max_cols_;
    std::shared_ptr<const Image> truth_; // the last one; truth_file_ is its encoding
    std::shared_ptr<const RowView::File> truth_file_;
};

} // namespace reljef::bench
