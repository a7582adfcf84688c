#include "engine/view/sample_count.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace reljef::view {

Result<void> check_samples(int samples) {
    constexpr std::array possible{automatic_samples, 1, 2, 4, 8, 16};
    if (std::find(possible.begin(), possible.end(), samples) != possible.end()) {
        return {};
    }
    return Error{
        fmt::format("picture with {} samples a pixel: expected 1, 2, 4, 8 or 16", samples)};
}

} // namespace reljef::view
