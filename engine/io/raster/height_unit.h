#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <gdal_priv.h>

namespace reljef::io {

struct HeightUnit {
    std::string name = "metre";
    double metres = 1.0;
    bool named = false; ///< the file itself says so
    bool known = true;  ///< false: `name` is a word we do not know, metres are assumed
};

/// Metres in a unit by any of its usual names ("m", "feet", "US survey foot", …).
std::optional<HeightUnit> height_unit_by_name(std::string_view name);

/// The unit of a band's heights: its own, else that of the CRS's vertical axis, else metres.
HeightUnit height_unit_of(GDALDataset& dataset, GDALRasterBand& band);

} // namespace reljef::io
