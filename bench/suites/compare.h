#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/report/figure_table.h"
#include "bench/report/results.h"

namespace reljef::bench {

enum class Verdict { same, better, worse };

/// One figure of a row in both runs.
struct Change {
    std::string row; ///< "tables, relief-4, natural 1025, overview, polygons:lods=1, 1024x768"
    /// "median ms", "ratio to texture", "error px", "pixels without bound", "hit texels", "wrong
    /// %", "holes", "FLIP"; of rows with columns the heading
    std::string figure;
    double before = 0.0; ///< infinite: none
    double after = 0.0;
    double noise = 0.0; ///< a share of the smaller figure; smaller changes do not count
    Verdict verdict = Verdict::same;
};

struct Comparison {
    std::vector<Change> changes;      ///< all figures of the rows of both runs
    std::vector<std::string> only_a;  ///< rows only in run a
    std::vector<std::string> only_b;  ///< rows only in run b
    std::vector<std::string> untimed; ///< rows of both runs without comparable times
    std::vector<std::string> notes;   ///< why a run is incomplete
    bool same_environment = true; ///< if false, ratios to texture replace times, if there are any
    /// Number of worse figures and of rows only in run a.
    [[nodiscard]] std::size_t regressions() const;
};

/// Compares runs `a` and `b` row by row. Rows match by suite, test, scene, pose, label and size;
/// null rows are skipped, and the first of equal rows counts. Environments match by renderer,
/// OpenGL, context, threads and processor.
///
/// A time changed if it differs by more than `threshold` (a share, >= 0) and both noise floors, and
/// the intervals of the medians do not overlap. Rows with fewer than min_frames frames or without a
/// ratio are `untimed`.
///
/// An error changed if it differs by more than `threshold` and by more than rounding:
/// - hits: 2^-10 texels, the unit in the last place of float32 up to column 16383; the same number
///   of pixels for the reprojection error, where a texel is about a pixel wide;
/// - wrong pixels and holes: 1/10,000 of the picture, at least one pixel: pixels whose hit error is
///   within rounding of the limit of one texel;
/// - FLIP: half a step of 8 bits, 1/510;
/// - pixels without bound: 0, because rounding moves no place behind the eye.
/// A missing error is worse than any; if neither run has one, nothing is compared.
Comparison compare(const Results& a, const Results& b, double threshold = 0.10);

/// Whether times can be compared.
bool is_same_environment(const Environment& a, const Environment& b);

/// Notes on runs that ended early. `run`: "first".
void add_stop(std::vector<std::string>& notes, const std::optional<Error>& stopped,
              std::string_view run);

/// What is compared, as the options say.
struct ComparedRuns {
    std::string before; ///< files
    std::string after;
    std::string suite;
    double threshold = 0.10; ///< a share
    Environment environment; ///< of the second run
};

/// All changes, by verdict: worse, gone, better, new, no verdict, the same.
FigureTable figure_table(const Comparison& comparison, const ComparedRuns& runs);

std::string comparison_report(const Comparison& comparison);

} // namespace reljef::bench
