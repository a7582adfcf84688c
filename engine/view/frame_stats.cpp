#include "engine/view/frame_stats.h"

namespace reljef::view {

WorkTotals totals_of(const PictureWork& work) {
    WorkTotals totals{.taps = work.beam_taps};
    for (const PixelWork& pixel : work.pixels.samples()) {
        totals.taps += pixel.taps;
        totals.steps += pixel.steps;
        totals.rays += pixel.rays;
    }
    return totals;
}

} // namespace reljef::view
