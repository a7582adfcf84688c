#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace reljef::bench {

/// A number of a row of a results file.
enum class Quantity {
    ms,        ///< median time of a frame; its uncertainty is the noise floor of the row
    wrong,     ///< pixels that show a wrong point, percent of those that show terrain
    hidden,    ///< pixels that show a point which the terrain hides, percent
    holes,     ///< pixels of terrain that show no point of it, percent of those that show terrain
    error_px,  ///< root mean square of the reprojection error, pixels
    flip,      ///< mean FLIP of the picture
    ssim,      ///< structural similarity of the picture; more is better
    triangles, ///< drawn
    taps,      ///< reads of maps, for each pixel
    percent,   ///< "value" of a stress
    bytes,     ///< sent to the GPU for a city
};

/// The row of a results file whose members equal all of `members`; null rows never do.
struct RowName {
    std::string file = {}; ///< in the folder of results, "tables.json"
    std::vector<std::pair<std::string, std::string>> members = {};
};

/// The numbers that confirm a conclusion; both ends belong to it.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

/// One measured number of a conclusion.
struct Figure {
    enum class Form {
        plain,    ///< the quantity
        ratio,    ///< the quantity over that of the base
        drop,     ///< loss of frame rate against the base, percent
        rate,     ///< frames per second
        constant, ///< computed from a table of the sources, percent
    };
    /// A number without a row.
    struct Constant {
        double value = 0.0;
        double uncertainty = 0.0;
    };

    std::string words = {}; ///< what it is of, before the number; may be empty
    Form form = Form::plain;
    Quantity quantity = Quantity::wrong;
    RowName row = {};
    std::optional<RowName> base = {};
    Constant constant = {};
    Range expected = {}; ///< if the conclusion is true
};

/// A conclusion of a source. It is confirmed if each figure lies in its range, and refuted if none
/// does. Otherwise it depends, or is within noise if no figure is known to lie outside.
struct Conclusion {
    std::string source; ///< letter, chapter, page
    std::string claim;  ///< in our words
    std::string rule;   ///< the ranges of the figures and their reason; empty: there is no claim
    std::vector<Figure> figures; ///< empty: nothing that reljef has measures it
    std::string note = {};       ///< after the figures; may be empty
    std::string reason = {};     ///< why it does not hold; shown below the table unless it does
};

/// Conclusions that answer one question.
struct Chapter {
    /// A sentence that holds if each figure lies in its range; it is left out otherwise.
    struct Sentence {
        std::string text; ///< with {} for each figure
        std::vector<Figure> figures;
    };

    std::string question;
    std::vector<Sentence> answer = {}; ///< those without figures always hold
    std::vector<Conclusion> conclusions = {};
};

/// All that a page says.
struct Findings {
    std::vector<Chapter::Sentence> summary = {};
    std::vector<Chapter> chapters = {};
    std::string limits = {}; ///< of validity, a list in Markdown
};

} // namespace reljef::bench
