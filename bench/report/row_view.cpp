#include "bench/report/row_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/report/page_heat_map.h"
#include "engine/core/check.h"
#include "engine/io/image/image.h"

namespace reljef::bench {
namespace {

// Of each block of factor × factor pixels what `merge` makes of it; what is over at the far sides
// is left out.
template <class Pixel, class Merge>
Grid<Pixel> reduced(const Grid<Pixel>& fine, int factor, const Merge& merge) {
    Grid<Pixel> coarse(fine.cols() / factor, fine.rows() / factor);
    std::vector<Pixel> block;
    for (int row = 0; row < coarse.rows(); ++row) {
        for (int col = 0; col < coarse.cols(); ++col) {
            block.clear();
            for (int i = 0; i < factor * factor; ++i) {
                block.push_back(fine(col * factor + i % factor, row * factor + i / factor));
            }
            coarse(col, row) = merge(block);
        }
    }
    return coarse;
}

Rgba8 mean_color(const std::vector<Rgba8>& block) {
    glm::vec3 sum(0.0F);
    for (const Rgba8 color : block) {
        sum += linear_from_rgba8(color);
    }
    return rgba8_from_linear(sum / static_cast<float>(block.size()));
}

// NaN only where all are.
float greatest_error(const std::vector<float>& block) {
    float greatest = std::numeric_limits<float>::quiet_NaN();
    for (const float error : block) {
        greatest = std::isnan(greatest) || error > greatest ? error : greatest;
    }
    return greatest;
}

Image smaller(const Image& image, int factor) {
    return factor == 1 ? image : reduced(image, factor, mean_color);
}

} // namespace

Result<std::shared_ptr<const RowView>> RowViews::make(const ShownView& view) {
    const int cols = view.shown.cols();
    check(!view.shown.empty() && view.truth->cols() == cols &&
              view.truth->rows() == view.shown.rows() && view.reprojection.cols() == cols &&
              view.reprojection.rows() == view.shown.rows(),
          "a row's pictures are empty or differ in size");
    const int desired = max_cols_ > 0 ? (cols + max_cols_ - 1) / max_cols_ : 1;
    const int factor = std::min({desired, cols, view.shown.rows()});
    auto shown = io::encode_image(".jpg", smaller(view.shown, factor));
    if (!shown) {
        return shown.error();
    }
    const Image heat_picture = heat_map(
        factor == 1 ? view.reprojection : reduced(view.reprojection, factor, greatest_error));
    auto heat = io::encode_image(".png", heat_picture);
    if (!heat) {
        return heat.error();
    }
    auto truth = truth_of(view, factor);
    if (!truth) {
        return truth.error();
    }
    return std::make_shared<const RowView>(RowView{{heat_picture.cols(), heat_picture.rows()},
                                                   std::move(*shown),
                                                   std::move(*truth),
                                                   std::move(*heat)});
}

Result<std::shared_ptr<const RowView::File>> RowViews::truth_of(const ShownView& view, int factor) {
    if (truth_ != view.truth) {
        auto file = io::encode_image(".jpg", smaller(*view.truth, factor));
        if (!file) {
            return file.error();
        }
        truth_ = view.truth;
        truth_file_ = std::make_shared<const RowView::File>(std::move(*file));
    }
    return truth_file_;
}

} // namespace reljef::bench
