#pragma once

#include "engine/io/raster/georeferencing.h"
#include "engine/io/raster/sample_reader.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::io {

/// Samples as they were read, turned as their place asks for, with voids filled, and closed where
/// they go all around the Earth. Takes the place's georeference.
terrain::Heightfield heightfield_of(Samples samples, Place& place);

} // namespace reljef::io
