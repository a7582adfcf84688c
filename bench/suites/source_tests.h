#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "bench/runner/suite.h"

namespace reljef::bench {

/// A frame rate that the sources measured at 1024×768: a thesis (Janković 2010, ch. 2.7), whose
/// tests these are, and the papers before it (GPU surface-detail survey 2008).
struct SourceMeasurement {
    std::string_view test;
    std::string_view scene;     ///< the source's name
    int configuration = 0;      ///< machine: 1 the older, 2 the newer
    std::string_view technique; ///< the source's name
    double fps = 0.0;
};
std::span<const SourceMeasurement> source_measurements();

/// The seven tests of the sources on built-in terrains, with their figures of configuration 2, the
/// only one with all seven. The data were never published. Differences:
/// - parallax-1, relief-1: the tile of 512 samples is not repeated.
/// - parallax-2: an urban terrain of 4096 samples, not a fragment of its picture; `quick`: 2048.
/// - parallax-3, relief-4: natural with 1025 samples, not 1024, for the levels of detail.
/// - relief-4: polygons:error=1 and exact are added, without a source figure.
/// Sorted by terrain, so that each is opened once.
std::vector<Group> source_groups(bool quick = false);

} // namespace reljef::bench
