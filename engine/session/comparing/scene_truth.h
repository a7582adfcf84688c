#pragma once

#include <memory>
#include <optional>

#include <glm/vec2.hpp>

#include "engine/core/hit.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/scene/graph/scene.h"
#include "engine/truth/draw.h"
#include "engine/truth/geometric_error.h"
#include "engine/truth/streamed_truth.h"

namespace reljef::session {

/// The exact pictures of a scene as it was when this was made, and the errors of other pictures. So
/// the scene may change while another thread draws. Not for several threads at once.
class SceneTruth {
public:
    /// Copies the references to the terrains, the lights and the sky; computes nothing. Fails when
    /// a mesh is visible.
    static Result<SceneTruth> create(const scene::Scene& scene);

    /// Whether the scene still shows the same terrains in the same light.
    [[nodiscard]] bool is_of(const scene::Scene& scene) const;

    /// As truth::draw(), with the shadows of truth::sun_shadow_of(). The first call also computes
    /// the light, which no stop request ends.
    Result<truth::Picture> draw(const scene::Camera& camera, glm::ivec2 size,
                                truth::DrawOptions options = {});
    /// As truth::geometric_errors(). Precondition: draw() was called.
    Result<truth::GeometricErrors> errors(const scene::Camera& camera, const HitBuffer& shown,
                                          const HitBuffer& truth,
                                          const ParallelOptions& parallel = {});

private:
    SceneTruth() = default;
    Result<void> prepare();

    scene::Scene scene_; // terrains, light and sky
    std::optional<scene::Light> sun_;
    truth::SunShadow shadow_ = truth::SunShadow::sweep;
    bool is_streamed_ = false;
    std::unique_ptr<const truth::SceneCaster> caster_; // the shading refers to it
    std::optional<truth::Shading> shading_;
    std::optional<truth::StreamedTruth> streamed_;
};

} // namespace reljef::session
