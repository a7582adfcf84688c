#pragma once

#include <string>

#include "engine/core/result.h"

namespace reljef::io {

/// To call before an OpenEXR file is opened: OpenEXR allocates what a header claims. Fails if an
/// attribute is longer than the file, for pictures of over 65,536 pixels a side, for blocks of
/// lines or tiles of over 256 MB, and for more tiles than the file can hold. Other files are no
/// errors.
Result<void> check_exr(const std::string& name);

} // namespace reljef::io
