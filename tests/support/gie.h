#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace reljef::test {

/// A point of PROJ's own regression tests (.gie), forward: degrees in, metres out, as written; an
/// inverse test has its two sides swapped.
struct GiePoint {
    std::string operation;      ///< "+proj=utm +ellps=GRS80 +zone=30"
    std::vector<double> input;  ///< longitude, latitude[, height]
    std::vector<double> output; ///< x, y[, z]
    double tolerance = 0.0;     ///< of the output, metres
    bool inverse = false;       ///< it was written as an inverse test
    int line = 0;
};

/// The points of a file, pipelines' too; what expects a failure is none. Empty where it cannot be
/// read.
std::vector<GiePoint> read_gie(const std::filesystem::path& path);

} // namespace reljef::test
