#pragma once

#include <filesystem>
#include <string>

#include "engine/core/color.h"
#include "engine/core/result.h"

namespace reljef::test {

/// How far a picture may be from its golden one.
struct GoldenLimits {
    int largest_difference = 4;      ///< of a channel, of 255, at a pixel that passes
    double failing_fraction = 0.002; ///< of all pixels may fail: silhouettes on another processor
};

/// How far it is.
struct GoldenDifference {
    double failing_fraction = 0.0;
    int largest_difference = 0; ///< of a channel, anywhere
    Image picture;              ///< the difference, eight times as strong
};

/// Fails where the sizes differ.
Result<GoldenDifference> golden_difference(const Image& actual, const Image& golden,
                                           const GoldenLimits& limits = {});

struct GoldenFolders {
    std::filesystem::path pictures; ///< NAME.png
    std::filesystem::path failures; ///< NAME.actual.png and NAME.difference.png of what failed
};

/// Whether the picture is the golden one of that name, within the limits. Where it is not, it and
/// the difference are saved, and the error says where. A golden picture that is missing is an
/// error, too.
Result<void> check_golden(const std::string& name, const Image& actual,
                          const GoldenFolders& folders, const GoldenLimits& limits = {});

} // namespace reljef::test
