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

/// Numbers (or a grey ramp), palette indices, or red, green and blue.
enum class ValueKind { plain, palette, color };
ValueKind kind_of_values(GDALDataset& dataset);

struct HeightUnit {
    std::string name = "metre";
    double metres = 1.0;
    bool named = false; ///< by the file
    bool known = true;  ///< false: unknown `name`, metres are assumed
};
/// The unit of a band's heights: its own, else that of the CRS's vertical axis, else metres.
HeightUnit height_unit_of(GDALDataset& dataset, GDALRasterBand& band);

inline constexpr double void_value = std::numeric_limits<double>::quiet_NaN();

/// Converts stored values to metres and voids to void_value.
class SampleDecoder {
public:
    /// Fails for complex values. Adds notes on the interpretation of values.
    static Result<SampleDecoder> create(GDALDataset& dataset, const std::string& name,
                                        const RasterOptions& options,
                                        std::vector<std::string>& notes);

    /// Bands to read: 1, or 3 for colours.
    [[nodiscard]] int bands() const { return kind_ == ValueKind::color ? 3 : 1; }

    /// Whether colours can be encoded heights; arguments as for decode().
    [[nodiscard]] bool fits(std::span<const double> first, std::span<const double> others) const;

    /// Decodes the first band's values in place. `others`: the second band's values, then the
    /// third's; or empty. A mask value of 0 is a void. Call it with neighbouring values: -9999 m is
    /// a void if all others are far above it.
    void decode(std::span<double> first, std::span<const double> others,
                std::span<const unsigned char> mask);

    /// Whether the value type can hold undeclared voids.
    [[nodiscard]] bool can_find_voids() const { return sentinels_ || floating_; }

    /// Undeclared voids found so far; may be empty.
    [[nodiscard]] std::string undeclared_voids_note() const;
    /// Values read as heights that may be voids; may be empty.
    [[nodiscard]] std::string doubtful_heights_note() const;
    /// Both as short notes without counts, for repeated reads of parts.
    [[nodiscard]] std::vector<std::string> found_notes() const;

private:
    [[nodiscard]] double metres(double value);
    [[nodiscard]] double of_color(double red, double green, double blue);
    [[nodiscard]] double bounded(double height);
    void find_usual_voids(std::span<double> heights);

    ValueKind kind_ = ValueKind::plain;
    HeightEncoding encoding_ = HeightEncoding::none; ///< of colours; none: luminance
    std::array<double, 256> palette_{};
    std::optional<double> nodata_; ///< rounded to the band's type
    bool sentinels_ = false;       ///< −32768 and −32767 are voids
    bool floating_ = false;
    bool not_finite_declared_ = false;
    double scale_ = 1.0;
    double offset_ = 0.0;
    std::size_t found_sentinels_ = 0;
    std::size_t found_not_finite_ = 0;
    std::size_t found_absurd_ = 0;
    std::size_t found_usual_voids_ = 0;
    std::size_t found_usual_heights_ = 0; ///< same value, with heights near it
};

} // namespace reljef::io
