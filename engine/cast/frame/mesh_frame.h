#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/cast/block_rays.h"
#include "engine/cast/frame/sun_tiles.h"
#include "engine/cast/mesh/mesh_surface.h"
#include "engine/cast/mesh/mesh_trees.h"
#include "engine/cast/packet/block_kernel.h"
#include "engine/cast/picture_rays.h"
#include "engine/core/hit.h"
#include "engine/core/parallel_for.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {

/// The ground that may hide the sun from meshes; without it nothing casts shadows.
struct ShadowGround {
    std::vector<SunSource> sources;
    TowardSun sun = {};
    /// The sample of a world place, of the sources' terrain.
    std::function<std::optional<glm::dvec3>(glm::dvec3 world)> sample_of;
};

/// What places of a picture show of meshes; see BlockMeshes.
struct MeshPixels {
    std::vector<float> t;
    std::array<std::vector<float>, 3> color;
    std::vector<float> nearness;

    explicit MeshPixels(std::size_t count);
    [[nodiscard]] BlockMeshes values() const;
};

/// The meshes of a list as its blocks show them: the nearest triangle along each ray, its colour,
/// and the light of sun and sky. Thread-safe.
class MeshFrame {
public:
    struct Options {
        double anchor = 0.0; ///< that of the ground's rays
        std::optional<ShadowGround> ground = {};
        BlockKernel kernel = {};
        RaySkips skips = {};
    };

    /// `pictures` are prepared for `meshes` and outlive this, as `list` does.
    MeshFrame(const view::DrawList& list, PlacedMeshes meshes, const MeshPictures& pictures,
              Options options);

    /// Whether a block (for_each_block) may show a mesh.
    [[nodiscard]] bool may_show(std::size_t block) const {
        return seen_[block].size.x > 0 && seen_[block].size.y > 0;
    }
    /// `places`: of a block on the picture, pixels.
    [[nodiscard]] MeshPixels look(std::size_t block, std::span<const glm::dvec2> places) const;

    /// Shadows of the meshes on ground; none without ShadowGround.
    [[nodiscard]] MeshShadow shadow() const;

    /// Replaces hits behind meshes. False if it was stopped early.
    bool add_hits(HitBuffer& hits, const ParallelOptions& parallel) const;

private:
    struct Lit; // a place in the light of the sun, unless something hides it

    [[nodiscard]] Ray ray_at(glm::dvec2 place) const {
        return {rays_.origin.at(place), rays_.direction.at(place)};
    }
    [[nodiscard]] bool is_hidden_by_meshes(const PlacedMesh& mesh, glm::dvec3 place,
                                           glm::vec3 face) const;
    void add_sunlight(std::span<const Lit> lit, MeshPixels& pixels) const;
    void add_sunlight_beside_ground(std::span<const Lit> lit, MeshPixels& pixels) const;
    [[nodiscard]] BlockJob job_toward_sun(std::span<const glm::dvec3> samples, glm::ivec2 base,
                                          std::vector<SunTile>& tiles) const;

    const view::DrawList& list_;
    PlacedMeshes meshes_;
    const MeshPictures& pictures_;
    Options options_;
    PictureRays rays_; // relative to the eye, metres
    glm::vec3 to_sun_{0.0F};
    std::vector<PixelBlock> seen_; // of each block; no other pixels show meshes
};

} // namespace reljef::cast
