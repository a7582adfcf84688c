#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/result.h"
#include "engine/terrain/field/color_ramp.h"

namespace reljef::io {

/// A colour file of `gdaldem color-relief`: a line for each stop, with a height in metres or a
/// share of the range ("40%"), and red, green, blue from 0 to 255 or a name; "nv" is the colour of
/// voids. Blanks, commas, tabs and colons separate; "#" begins a comment; an alpha is ignored.
/// Fails at the first wrong line.
Result<terrain::ColorRamp> read_ramp_file(const std::filesystem::path& path);

/// Parses a text. `name` is the file in messages.
Result<terrain::ColorRamp> parse_ramp(std::string_view text, const std::string& name);

} // namespace reljef::io
