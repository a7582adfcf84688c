#pragma once

#include "engine/core/color.h"
#include "engine/core/result.h"

namespace reljef::truth {

/// Fails where two pictures are empty or differ in size.
Result<void> check_same_size(const Image& shown, const Image& truth);

} // namespace reljef::truth
