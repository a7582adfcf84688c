#pragma once

#include <filesystem>

#include "engine/core/result.h"
#include "engine/material/sky_picture.h"

namespace reljef::io {

/// Reads a sky; `turn` degrees clockwise from north is its middle, or its front. A file is a
/// picture of all directions, twice as wide as high (equirectangular); of the sky alone, four times
/// as wide; or a cross of six faces, 4 by 3: in the middle row left, front, right and back, above
/// and below the front up and down, and nothing beside these. A folder has these six as files whose
/// names end in front, right, back, left, up and down, or in _ft, _rt, _bk, _lf, _up and _dn.
/// Ratios may be off by 1 %. Colours of high range are cut to those of 8 bits.
Result<material::SkyPicture> read_sky(const std::filesystem::path& path, double turn);

} // namespace reljef::io
