#include "app/viewer/panels/toolkit/pixel_area.h"

#include <cstddef>
#include <utility>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

namespace reljef::app {
namespace {

bool overlap(const PixelArea& a, const PixelArea& b) {
    return glm::all(glm::lessThan(glm::max(a.low, b.low), glm::min(a.high(), b.high())));
}

PixelArea joined(const PixelArea& a, const PixelArea& b) {
    const glm::ivec2 low = glm::min(a.low, b.low);
    return {low, glm::max(a.high(), b.high()) - low};
}

} // namespace

std::vector<PixelArea> disjoint(std::vector<PixelArea> areas) {
    for (std::size_t i = 0; i < areas.size(); ++i) {
        for (std::size_t k = i + 1; k < areas.size(); ++k) {
            if (overlap(areas[i], areas[k])) {
                areas[i] = joined(areas[i], areas[k]);
                areas.erase(areas.begin() + static_cast<std::ptrdiff_t>(k));
                return disjoint(std::move(areas)); // the larger one may overlap others
            }
        }
    }
    return areas;
}

} // namespace reljef::app
