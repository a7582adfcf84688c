#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/core/color.h"

namespace reljef::test {

/// The share of pixels with a channel that is off by more than `levels`.
inline double share_of_others(const Image& a, const Image& b, int levels) {
    int others = 0;
    for (int row = 0; row < a.rows(); ++row) {
        for (int col = 0; col < a.cols(); ++col) {
            const Rgba8 p = a(col, row);
            const Rgba8 q = b(col, row);
            const int off =
                std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)});
            others += off > levels ? 1 : 0;
        }
    }
    return static_cast<double>(others) / (a.cols() * a.rows());
}

} // namespace reljef::test
