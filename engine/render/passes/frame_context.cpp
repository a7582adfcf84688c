#include "engine/render/passes/frame_context.h"

#include "engine/render/shaders/view_values.h"

namespace reljef::render {

std::uint32_t scene_features(const view::DrawList& list, bool hits, int samples, bool skips) {
    std::uint32_t features = hits ? feature_hit : 0U;
    features |= list.sun || !skips ? feature_lit : 0U;
    // A map has no viewing distance, hence no air.
    const bool air = is_perspective(list.camera) && list.sky && list.sky->visibility > 0.0;
    features |= air || !skips ? feature_fog : 0U;
    features |= samples > 1 ? feature_multisampled : 0U;
    return features;
}

} // namespace reljef::render
