#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/results.h"

namespace reljef::bench {

enum class Verdict { same, better, worse };

/// One figure of a row in both runs.
struct Change {
    std::string row;    ///< "tables, relief-4, natural 1025, overview, polygons:lods=1, 1024x768"
    std::string figure; ///< "median ms", "ratio to texture", "error px", "wrong %"
    double before = 0.0;
    double after = 0.0;
    double noise = 0.0; ///< a share of `before`: changes up to it are none
    Verdict verdict = Verdict::same;
};

struct Comparison {
    std::vector<Change> changes;     ///< two or more a row that both runs have, same ones too
    std::vector<std::string> only_a; ///< rows that the other run lacks
    std::vector<std::string> only_b;
    bool same_environment = true; ///< else only ratios to texture are compared, not times
    [[nodiscard]] std::size_t regressions() const;
};

struct CompareOptions {
    double threshold = 0.10; ///< changes up to this share are none; >= 0
};

/// What changed from run `a` to run `b`, row by row. Rows are one where suite, test, scene, pose,
/// label and size are; null rows and missing ones are left out, of rows that are alike the first
/// counts. Environments are one where renderer, OpenGL, context, threads and processor are; the
/// commit may differ.
///
/// A time has changed where it differs by more than the threshold and both noise floors, and the
/// intervals of the medians do not overlap. An error has changed where it differs by more than the
/// threshold and by more than a thousandth of a pixel, or of a percent: the same picture has the
/// same error, it has no noise. An error that is not there in one run, as no pixel has a finite
/// one, is worse than any.
Comparison compare(const Results& a, const Results& b, const CompareOptions& options = {});

/// The comparison for people: what changed, what is only in one run, and how much stayed as it was.
std::string comparison_report(const Comparison& comparison);

} // namespace reljef::bench
