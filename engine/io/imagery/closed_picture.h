#pragma once

#include "engine/core/color.h"
#include "engine/geo/georeference.h"

namespace reljef::io {

/// A picture whose texels lie edge to edge over `samples` of closed rows, row `first` of them on
/// its first: texels beyond a pole give way to those that lie at the place of the row.
void close_picture(Image& picture, const geo::ClosedRows& rows, double first, double samples);

} // namespace reljef::io
