#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/scene/graph/scene.h"
#include "engine/scene/streaming/terrain_light.h"
#include "engine/truth/draw.h"
#include "engine/truth/eye.h"
#include "engine/truth/geometric_error.h"
#include "engine/truth/mesh_caster.h"
#include "engine/truth/shading.h"
#include "engine/truth/streamed_surface.h"

namespace reljef::truth {

/// The exact picture of a streamed terrain: of all samples, whatever the terrain's size. Tiles are
/// read when rays need them. A tile that cannot be read is an error.
///
/// Hits are those of the terrain in memory. Colours and normals are those of the full-resolution
/// tiles, with their imagery. With SunShadow::sweep the shadows are the overview's, as those of
/// drawn tiles are; with SunShadow::ray, rays through all samples decide.
class StreamedTruth {
public:
    /// `memory_budget`: bytes for rays and tiles; absent: that of the stream. Fails unless the
    /// scene has exactly one terrain, a streamed one, and as MeshCaster::create().
    static Result<StreamedTruth> create(const scene::Scene& scene,
                                        std::optional<std::size_t> memory_budget = {});

    /// As truth::draw(). Also fails if a tile cannot be read.
    Result<Picture> draw(const scene::Camera& camera, glm::ivec2 size,
                         const DrawOptions& options = {});
    Result<HitBuffer> draw_hits(const scene::Camera& camera, glm::ivec2 size,
                                const ParallelOptions& parallel = {});

    /// As reprojection_error(), of all pixels that show terrain; NaN elsewhere.
    Result<Grid<double>> reprojection_errors(const scene::Camera& camera, const HitBuffer& hits,
                                             const ParallelOptions& parallel = {});
    /// See geometric_errors().
    Result<GeometricErrors> errors(const scene::Camera& camera, const HitBuffer& shown,
                                   const HitBuffer& truth, const ParallelOptions& parallel = {});

    [[nodiscard]] const StreamedSurfaceStats& stats() const { return surface_.stats(); }
    /// Notes of files since the last call.
    std::vector<std::string> take_notes() { return surface_.take_notes(); }

private:
    struct Memory {
        std::size_t tiles = 0; // bytes
        std::size_t rays = 0;  // number in one batch
    };
    StreamedTruth(const scene::Scene& scene, const scene::TerrainNode& terrain,
                  const glm::dmat4& world_from_local, const Memory& memory);

    struct Batch; // rays that are traced together
    [[nodiscard]] Eye eye_of(const scene::Camera& camera, glm::ivec2 size) const;
    static Hit shown_hit(const Batch& batch, std::size_t ray);
    void trace_meshes(const Eye& eye, Batch& batch) const;
    Result<void> trace(const Eye& eye, Batch& batch, const ParallelOptions& parallel);
    [[nodiscard]] std::optional<Ray> sun_ray(const Eye& eye, const Batch& batch,
                                             std::size_t ray) const;
    Result<std::vector<bool>> are_below(std::span<const Ray> local_rays,
                                        const ParallelOptions& parallel);
    Result<void> find_sun(const Eye& eye, Batch& batch, const ParallelOptions& parallel);
    Result<void> shade(const Eye& eye, Batch& batch, const ParallelOptions& parallel) const;
    Result<void> color(const Eye& eye, Batch& batch, const DrawOptions& options);
    struct TileHits;
    struct TerrainHit; // with its sun
    static std::vector<TileHits>
    hits_by_tile(const scene::TileBuilder& builder,
                 std::span<const std::optional<terrain::SurfaceHit>> hits);
    Result<void> shade_tile(const Eye& eye, const TileHits& hits, Batch& batch,
                            const std::stop_token& stop) const;
    [[nodiscard]] glm::vec3 color_in_tile(const scene::FilledHeights& filled,
                                          const scene::TerrainTile* whole, terrain::TreeTile tile,
                                          const TerrainHit& hit) const;
    [[nodiscard]] glm::vec3 irradiance_at(const scene::TerrainTile& part, glm::dvec2 place,
                                          const TerrainHit& hit) const;
    template <class Use>
    Result<void> for_each_batch(const Eye& eye, glm::ivec2 size, const DrawOptions& options,
                                bool has_colors, const Use& use);

    StreamedSurface surface_;
    MeshCaster meshes_;
    glm::dmat4 world_from_local_;
    glm::dmat4 local_from_world_;
    std::size_t rays_per_batch_;
    Backdrop backdrop_;
    std::optional<scene::TerrainIrradiance> irradiance_;
};

} // namespace reljef::truth
