#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <gdal_priv.h>

#include "engine/core/result.h"
#include "engine/io/raster/raster.h"
#include "engine/io/raster/web_tiles.h"

namespace reljef::io {

/// What the values of a raster are: numbers, indices into a palette that is no grey ramp, or red,
/// green and blue.
enum class ValueKind { plain, palette, color };
ValueKind kind_of_values(GDALDataset& dataset);

inline constexpr double void_value = std::numeric_limits<double>::quiet_NaN();

/// Turns stored values into metres, voids into void_value.
class SampleDecoder {
public:
    /// Fails for complex values. Adds notes on what is taken for heights.
    static Result<SampleDecoder> create(GDALDataset& dataset, const std::string& name,
                                        const RasterOptions& options,
                                        std::vector<std::string>& notes);

    /// Bands to read for one value: 1, or 3 for colours.
    [[nodiscard]] int bands() const { return kind_ == ValueKind::color ? 3 : 1; }

    /// Whether stored values, as decode() takes them, can be what the raster is read as.
    [[nodiscard]] bool fits(std::span<const double> first, std::span<const double> others) const;

    /// In place in `first`, which holds the stored values of the first band; `others` holds those
    /// of the second and third after one another, or nothing. A mask value of 0 is a void. Values
    /// of one call lie near each other: -9999 m is a void if all others are far above it.
    void decode(std::span<double> first, std::span<const double> others,
                std::span<const unsigned char> mask);

    /// Whether a stored value can be a void that is not declared.
    [[nodiscard]] bool can_find_voids() const { return sentinels_ || floating_; }

    /// What was found without being declared; empty when nothing.
    [[nodiscard]] std::string undeclared_voids_note() const;
    /// What was taken for heights and may have been meant for voids; empty when nothing.
    [[nodiscard]] std::string doubtful_heights_note() const;
    /// Both in few words each, without numbers: of parts that are read again and again.
    [[nodiscard]] std::vector<std::string> found_words() const;

private:
    [[nodiscard]] double metres(double value);
    [[nodiscard]] double of_color(double red, double green, double blue);
    [[nodiscard]] double bounded(double height);
    void find_usual_voids(std::span<double> heights);

    ValueKind kind_ = ValueKind::plain;
    HeightEncoding encoding_ = HeightEncoding::none; ///< of colours; none: their luminance
    std::array<double, 256> palette_{};
    std::optional<double> nodata_; ///< as the band's own type holds it
    bool sentinels_ = false;       ///< −32768 and −32767 are voids
    bool floating_ = false;
    bool not_finite_declared_ = false;
    double scale_ = 1.0;
    double offset_ = 0.0;
    std::size_t found_sentinels_ = 0;
    std::size_t found_not_finite_ = 0;
    std::size_t found_absurd_ = 0;
    std::size_t found_usual_voids_ = 0;
    std::size_t found_usual_heights_ = 0; ///< the same value where heights reach down to it
};

} // namespace reljef::io
