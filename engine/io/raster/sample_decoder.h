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
    /// Fails for complex values. Adds notes on the interpretation of values. Without
    /// `options.undeclared_voids`, all usual voids are voids.
    static Result<SampleDecoder> create(GDALDataset& dataset, const std::string& name,
                                        const RasterOptions& options,
                                        std::vector<std::string>& notes);

    /// Bands to read: 1, or 3 for colours.
    [[nodiscard]] int bands() const { return kind_ == ValueKind::color ? 3 : 1; }

    /// Whether colours can be encoded heights; arguments as for decode().
    [[nodiscard]] bool fits(std::span<const double> first, std::span<const double> others) const;

    /// Decodes the first band's values in place. `others`: the second band's values, then the
    /// third's; or empty. A mask value of 0 is a void.
    void decode(std::span<double> first, std::span<const double> others,
                std::span<const unsigned char> mask);

    /// As decode() of plain values without a mask, but counts nothing. False, and then nothing is
    /// decoded, if there are usual voids whose meaning depends on the whole file
    /// (isolated_voids()).
    [[nodiscard]] bool decode_floats(std::span<float> stored) const;

    /// Whether the value type can hold undeclared voids.
    [[nodiscard]] bool can_find_voids() const { return !usual_.empty() || floating_; }

    /// The usual voids (-9999, -99999, -999999; 65535 in a georeferenced raster of UInt16) from
    /// which all other stored values are at least a tenth of the void away, and always -32768 and
    /// -32767. A height has others near it, because ground is continuous: on the slope of an ocean
    /// trench, no sample of -9999 m is 1 km from all others.
    [[nodiscard]] std::vector<double> isolated_voids(std::span<const double> stored) const;

    /// Undeclared voids found so far in the file `name`; may be empty.
    [[nodiscard]] std::string undeclared_voids_note(const std::string& name) const;
    /// Values read as heights that may be voids; may be empty.
    [[nodiscard]] std::string doubtful_heights_note(const std::string& name) const;
    /// Both as short notes without counts, for repeated reads of parts.
    [[nodiscard]] std::vector<std::string> found_notes() const;

private:
    /// A stored value that many programs write for voids.
    struct UsualVoid {
        double value = 0.0;
        bool is_void = true; ///< false: a height in this file
        std::size_t found = 0;
    };
    /// Voids of a raster of floats; places without one are NaN, which equals nothing.
    struct FloatVoids {
        std::array<float, 3> known{};   ///< the declared one and the lowest numbers
        std::array<float, 5> unknown{}; ///< whose meaning depends on the whole file
    };
    [[nodiscard]] FloatVoids float_voids() const;
    /// decode() of plain values without a mask, if all are heights. False, and then nothing is
    /// decoded, if some may be voids.
    [[nodiscard]] bool decode_heights(std::span<double> stored) const;
    [[nodiscard]] std::vector<std::string> counts_of_usual(bool voids) const;
    [[nodiscard]] double metres(double value);
    [[nodiscard]] double of_color(double red, double green, double blue);
    [[nodiscard]] double bounded(double height);

    ValueKind kind_ = ValueKind::plain;
    HeightEncoding encoding_ = HeightEncoding::none; ///< of colours; none: luminance
    std::array<double, 256> palette_{};
    std::optional<double> nodata_; ///< rounded to the band's type
    std::vector<UsualVoid> usual_;
    bool floating_ = false;
    bool not_finite_declared_ = false;
    double scale_ = 1.0;
    double offset_ = 0.0;
    std::size_t found_not_finite_ = 0;
    std::size_t found_absurd_ = 0;
};

} // namespace reljef::io
