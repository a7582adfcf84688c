#include "engine/session/comparing/wipe.h"

#include <algorithm>
#include <cmath>

#include "engine/core/check.h"

namespace reljef::session {
namespace {

constexpr Rgba8 line_color{255, 255, 255, 255};
constexpr Rgba8 edge_color{20, 24, 29, 255}; // beside the line: it shows over snow, too

void draw_column(Image& picture, int col, Rgba8 color) {
    if (col >= 0 && col < picture.cols()) {
        for (int row = 0; row < picture.rows(); ++row) {
            picture(col, row) = color;
        }
    }
}

} // namespace

int wipe_column(double share, int cols) {
    return static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * cols));
}

Image wiped(const Image& left, const Image& right, double share) {
    reljef::check(left.cols() == right.cols() && left.rows() == right.rows(),
                  "two pictures of the same size were expected");
    const int column = wipe_column(share, left.cols());
    Image picture = left;
    for (int row = 0; row < left.rows(); ++row) {
        const auto from = right.row(row).subspan(static_cast<std::size_t>(column));
        std::copy(from.begin(), from.end(), picture.row(row).begin() + column);
    }
    if (column > 0 && column < left.cols()) {
        draw_column(picture, column - 2, edge_color);
        draw_column(picture, column - 1, line_color);
        draw_column(picture, column, line_color);
        draw_column(picture, column + 1, edge_color);
    }
    return picture;
}

} // namespace reljef::session
