#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// What a technique shows, what is right, and how far each pixel is off. Of one size, not empty.
struct ShownView {
    Image shown;
    std::shared_ptr<const Image> truth;
    Grid<float> reprojection; ///< pixels of error, NaN where there is none
};

/// The pictures of a row, as files: a hundredth of the memory.
struct RowView {
    using File = std::vector<std::byte>;

    glm::ivec2 size{0};                ///< of each, pixels
    File shown;                        ///< JPEG
    std::shared_ptr<const File> truth; ///< JPEG, shared by the rows of one truth
    File heat;                         ///< PNG, heat_map() of the reprojection error
};

/// Makes the pictures of rows, one after the other.
class RowViews {
public:
    /// Pictures of more columns are reduced by a whole number until they have no more; 0: never.
    /// A colour is the mean of its pixels, linear; an error the greatest of them.
    explicit RowViews(int max_cols = 0) : max_cols_(max_cols) {}

    /// Fails where a picture cannot be encoded.
    Result<std::shared_ptr<const RowView>> make(const ShownView& view);

private:
    Result<std::shared_ptr<const RowView::File>> truth_of(const ShownView& view, int factor);

    int max_cols_;
    std::shared_ptr<const Image> truth_; // the last one, and what became of it
    std::shared_ptr<const RowView::File> truth_file_;
};

} // namespace reljef::bench
