#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "bench/stress/stress_run.h"
#include "engine/core/color.h"
#include "engine/core/hit.h"
#include "engine/scene/graph/scene.h"
#include "engine/truth/geometric_error.h"
#include "engine/truth/scene_caster.h"

namespace reljef::bench {

/// A terrain over a plane under a sun, without a sky. Cameras are in the terrain's local metres.
class StressStage {
public:
    /// Fails as TerrainSurface::create. White where the terrain has no colour.
    static Result<StressStage> create(terrain::Terrain terrain, double exaggeration = 1.0);

    /// Moves terrain, sun and later cameras. Precondition: rigid.
    void place(const glm::dmat4& world_from_local);
    void look(const scene::Camera& local);
    /// False if the technique cannot draw the surface.
    [[nodiscard]] bool set_technique(const scene::Technique& technique);

    [[nodiscard]] const scene::TerrainSurface& surface() const;
    [[nodiscard]] scene::Camera camera() const { return scene_.camera(); }

    [[nodiscard]] Result<HitBuffer> hits(session::SceneRenderer& renderer) const;
    [[nodiscard]] Result<Image> picture(session::SceneRenderer& renderer) const;
    /// The exact hits; always of the surface where its samples are.
    Result<HitBuffer> true_hits(glm::ivec2 size, const ParallelOptions& parallel);

    [[nodiscard]] truth::SurfaceView surface_view() const;

private:
    StressStage() = default;

    scene::Scene scene_;
    scene::Node* terrain_ = nullptr; // owned by the scene, as the others
    scene::Node* camera_ = nullptr;
    scene::Node* light_ = nullptr;
    std::optional<truth::SceneCaster> caster_;
};

/// Pixels of terrain with a coordinate, height or depth that is no finite number.
std::size_t count_not_finite(const HitBuffer& hits);

/// How far a technique may draw a silhouette beside the true one.
struct SilhouetteTolerance {
    double pixels = 1.0;
    double metres = 0.0; ///< below it
};
/// A pixel, and the error bound. Polygons without a bound also lie below the bilinear surface, by
/// up to the largest height between a cell and its two triangles.
SilhouetteTolerance silhouette_tolerance(const StressStage& stage,
                                         const scene::Technique& technique);

/// Pixels of sky where all exact rays within the tolerance hit ground: no silhouette that moved.
std::size_t count_sky_over_ground(const StressStage& stage, const HitBuffer& shown,
                                  const HitBuffer& truth, const SilhouetteTolerance& tolerance);

/// Whether no pixel of sky over ground is allowed: polygons with all samples or an error bound,
/// displacement, cone and exact.
bool covers_ground(const scene::Technique& technique);

/// The largest share of wrong pixels of `exact`, percent.
inline constexpr double max_wrong_percent = 0.1;

} // namespace reljef::bench
