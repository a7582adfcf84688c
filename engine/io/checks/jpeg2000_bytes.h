#pragma once

#include <string>

#include "engine/core/result.h"

namespace reljef::io {

/// To call before a JPEG 2000 file is opened: OpenJPEG ends the program where it reads beyond what
/// a box holds. Fails if a box, a segment or a part of a tile claims to end behind what holds it.
/// Other files are no errors. A name is as GDAL takes it.
Result<void> check_jpeg2000(const std::string& name);

} // namespace reljef::io
