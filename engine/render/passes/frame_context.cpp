#include "engine/render/passes/frame_context.h"

#include "engine/render/shaders/view_values.h"

namespace reljef::render {

ShaderFeatures scene_features(const view::DrawList& list, bool hits, int samples, bool skips) {
    ShaderFeatures features = hits ? feature_hit : 0U;
    features |= list.sun || !skips ? feature_lit : 0U;
    // A map has no viewing distance, hence no air.
    const bool air = is_perspective(list.camera) && list.sky && list.sky->visibility > 0.0;
    features |= air || !skips ? feature_fog : 0U;
    features |= samples > 1 ? feature_multisampled : 0U;
    return features;
}

namespace {

ShaderFeatures features_if(const FrameContext& frame, bool needs_ground) {
    return needs_ground && !frame.hits && !frame.counts() ? feature_point_lights : 0U;
}

} // namespace

ShaderFeatures point_light_features(const FrameContext& frame, const view::TileDraw& draw) {
    const bool is_warped = draw.terrain->material.technique.id() == scene::TechniqueId::prewarp;
    return features_if(frame, !is_warped && view::needs_ground(frame.list, draw));
}

ShaderFeatures point_light_features(const FrameContext& frame, const view::TerrainDraw& draw) {
    return features_if(frame, view::needs_ground(frame.list, draw));
}

} // namespace reljef::render
