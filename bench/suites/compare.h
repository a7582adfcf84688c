#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/report/results.h"

namespace reljef::bench {

enum class Verdict { same, better, worse };

/// One figure of a row in both runs.
struct Change {
    std::string row; ///< "tables, relief-4, natural 1025, overview, polygons:lods=1, 1024x768"
    /// "median ms", "ratio to texture", "error px", "pixels without bound", "hit texels", "wrong
    /// %", "holes", "FLIP"
    std::string figure;
    double before = 0.0; ///< infinite: an error that is not there
    double after = 0.0;
    double noise = 0.0; ///< a share of the smaller one: changes up to it are none
    Verdict verdict = Verdict::same;
};

struct Comparison {
    std::vector<Change> changes;      ///< of the rows that both runs have, same ones too
    std::vector<std::string> only_a;  ///< rows that the other run lacks
    std::vector<std::string> only_b;  ///< likewise
    std::vector<std::string> untimed; ///< rows of both runs whose times say nothing
    std::vector<std::string> notes;   ///< why a run has not all rows
    bool same_environment = true;     ///< else only ratios to texture are compared, not times
    /// Figures that got worse, and rows that run `b` lacks.
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
/// intervals of the medians do not overlap. Of rows that have under min_frames in either run, and
/// of ratios that are absent, nothing is said: they are `untimed`.
///
/// An error has changed where it differs by more than the threshold and by more than rounding can
/// change it: the same picture has the same error, it has no noise. Rounding is
/// - of a hit 2^-10 texels: hits are float32, whose unit in the last place is that up to column
///   16383; of a reprojection error, where a texel is about a pixel wide, as many pixels;
/// - of wrong pixels and of holes a ten-thousandth of the picture, one pixel at least: such as lie
///   within that unit of the limit of one texel, hit errors spread over some ten texels;
/// - of FLIP half a step of 8 bits, 1/510;
/// - of pixels without a bound none: it puts no place behind the eye.
/// An error that is not there is worse than any; where neither run measured one, none is compared.
Comparison compare(const Results& a, const Results& b, const CompareOptions& options = {});

/// The comparison for people: what changed, what is only in one run, and how much stayed as it was.
std::string comparison_report(const Comparison& comparison);

} // namespace reljef::bench
