#include "tests/fuzz/made_dem.h"

#include <cmath>

#include <fmt/format.h>

namespace reljef::fuzz {

std::string made_dem(int side) {
    std::string text = fmt::format("ncols {0}\nnrows {0}\nxllcorner 6\nyllcorner 45\n"
                                   "cellsize 0.001\nNODATA_value -9999\n",
                                   side);
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            text +=
                fmt::format("{:.2f} ", 500.0 + 90.0 * std::sin(0.3 * col) * std::cos(0.2 * row));
        }
        text += '\n';
    }
    return text;
}

} // namespace reljef::fuzz
