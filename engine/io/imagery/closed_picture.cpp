#include "engine/io/imagery/closed_picture.h"

#include <algorithm>
#include <cmath>

namespace reljef::io {
namespace {

constexpr double same_row = 1e-6;

void copy_row(Image& picture, int from, int to) {
    std::copy(picture.row(from).begin(), picture.row(from).end(), picture.row(to).begin());
}

} // namespace

void close_picture(Image& picture, const geo::ClosedRows& rows, double first, double samples) {
    const double step = samples / (picture.rows() - 1);
    const int last = picture.rows() - 1;
    const auto texel_of = [&](int row) {
        const double source = rows.source_row(first + row * step);
        return (source + rows.closing().north_rows() - first) / step;
    };
    for (int row = 0; row <= last && texel_of(row) > row + same_row; ++row) {
        copy_row(picture, std::min(static_cast<int>(std::ceil(texel_of(row) - same_row)), last),
                 row);
    }
    for (int row = last; row >= 0 && texel_of(row) < row - same_row; --row) {
        copy_row(picture, std::max(static_cast<int>(std::floor(texel_of(row) + same_row)), 0), row);
    }
}

} // namespace reljef::io
