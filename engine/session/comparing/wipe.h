#pragma once

#include "engine/core/color.h"

namespace reljef::session {

/// The column of the line between two pictures: `share` of the width, in [0,1].
int wipe_column(double share, int cols);

/// The left picture up to the line, and the right one from there. Draws the line unless it is at an
/// edge. Precondition: equal sizes.
Image wiped(const Image& left, const Image& right, double share);

} // namespace reljef::session
