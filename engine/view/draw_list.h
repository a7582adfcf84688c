#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/core/geometry.h"
#include "engine/core/result.h"
#include "engine/scene/graph/scene.h"
#include "engine/scene/streaming/terrain_light.h"
#include "engine/terrain/mesh/bisection_mesh.h"
#include "engine/view/frame_stats.h"
#include "engine/view/rays/ray_course.h"

namespace reljef::view {

/// How much of the detail tile over a terrain is visible.
enum class DetailLevel {
    none,  ///< too far: the terrain alone
    light, ///< its colour and its light
    relief ///< its heights, if the technique searches for them
};

/// How coarse a terrain's tiles may be: by error, or by the levels of patches
/// (terrain/mesh/patch_mesh.h).
using Coarseness = std::variant<terrain::ErrorView, Grid<std::uint8_t>>;

// Distances are metres from the eye to the nearest point of the bounds.

/// One terrain tile to draw.
struct TileDraw {
    const scene::TerrainNode* terrain = nullptr;
    std::shared_ptr<const scene::TerrainTile> tile;
    double distance = 0.0;
    std::size_t node = 0;                   ///< index into DrawList::terrains
    DetailLevel detail = DetailLevel::none; ///< of the detail tile over the terrain
    bool flat = false;                      ///< the reference surface instead of its heights
    bool coarse = false;                    ///< with fewer triangles than its samples have
    bool is_hidden = false;                 ///< behind nearer ground
    /// How far the tile is from all samples at most if it is proven, otherwise an estimate; pixels.
    double error = 0.0;
    double error_with_hidden = 0.0; ///< see TileSelection::Drawn
    double triangle_error = 0.0;    ///< left for its triangles, pixels; 0 without an error bound

    /// Whether `error` is proven, of every pixel.
    [[nodiscard]] bool is_proven() const { return tile->is_proven; }
};

/// Maximum of SurfaceSearch::tiles.
inline constexpr std::size_t max_relief_tiles = 2048;

/// Rays that search for a terrain's surface in each pixel.
struct SurfaceSearch {
    scene::Technique technique; ///< the terrain's own, or one chosen for the view
    double distance = 0.0;      ///< of the whole terrain
    /// Loaded tiles of a stream, the coarsest first: the root, those that the view needs, and those
    /// above them. Where they overlap, the finest is the surface, so that rays find ground beside
    /// the picture, too. Empty: the samples of the terrain's surface.
    std::vector<std::shared_ptr<const scene::TerrainTile>> tiles = {};
    /// How far the surfaces of the proven ones of `tiles` are off where exact rays show them, at
    /// most, pixels; empty: no proven one is shown, or the technique is no exact search.
    std::optional<double> tile_error = {};
    std::optional<RayCourse> course = {}; ///< of rays on the ellipsoid
};

/// A terrain: the triangles of its tiles in DrawList::tiles, a search, or both.
struct TerrainDraw {
    const scene::TerrainNode* terrain = nullptr;
    glm::dmat4 world_from_local{1.0};
    std::optional<Coarseness> coarseness = {}; ///< of its tiles; empty: a vertex at every sample
    std::optional<SurfaceSearch> search = {};
};

struct MeshDraw {
    const scene::MeshNode* mesh = nullptr;
    glm::dmat4 world_from_local{1.0};
    bool from_behind = false; ///< its inner side
    Box local_bounds = {};    ///< metres; empty for a base
    std::size_t level = 0;    ///< 0: all triangles; else one more than its index in the levels
    /// How far places of the level are off at most, rounding included, pixels; 0 for all triangles.
    double error = 0.0;
};

/// The mesh, or its level.
const std::shared_ptr<const scene::Mesh>& drawn_mesh(const MeshDraw& draw);

struct DrawList;
/// The draw with the coarsest level that keeps a quarter of an error bound (pixels; 0: no bound) in
/// the list's picture, whose normals look like those of the mesh, and whose picture shows its mean
/// only. It has all triangles if no level does.
MeshDraw with_level(MeshDraw draw, const DrawList& list, double max_error);

/// What to draw in a frame: pure data. Valid as long as the scene is unchanged.
struct DrawList {
    scene::Camera camera;
    glm::ivec2 size{0};                                ///< of the picture, pixels
    std::optional<scene::Light> sun;                   ///< the first light in the tree
    std::vector<scene::PlacedPointLight> point_lights; ///< see seen_point_lights()
    std::optional<scene::Sky> sky;
    std::optional<scene::SeenSky> sky_picture; ///< empty: the sky is no picture
    double eye_dome = 0.0; ///< scene::Scene::eye_dome(); 0 if a terrain hides its overlay
    std::vector<TerrainDraw> terrains;
    std::vector<TileDraw> tiles; ///< of `terrains`, as triangles, front to back
    std::vector<MeshDraw> meshes;
    std::vector<MeshDraw> meshes_beside; ///< outside the frustum: they may cast shadows into it
    std::vector<MeshDraw> bases; ///< walls below terrains (TerrainNode::base), in pictures only
    FrameStats stats;            ///< of the selection

    [[nodiscard]] const glm::dmat4& world_from_local(const TileDraw& draw) const {
        return terrains[draw.node].world_from_local;
    }
};

/// The terrains with a search, front to back. Valid as long as the list.
std::vector<const TerrainDraw*> searched_terrains(const DrawList& list);

/// Fails as scene::check_technique of each terrain and mesh.
Result<void> check_techniques(const DrawList& list);

/// The list's sun over a terrain; empty without a sun.
std::optional<scene::TerrainLight> light_on(const DrawList& list,
                                            const glm::dmat4& world_from_local);

/// The lights whose range meets the frustum (of all of the picture, so that its parts agree), the
/// brightest at the eye first, equal ones in their order. Beyond scene::max_shown_point_lights they
/// are left out (`skipped`).
std::vector<scene::PlacedPointLight> seen_point_lights(std::vector<scene::PlacedPointLight> lights,
                                                       const scene::Camera& camera,
                                                       const Frustum& frustum,
                                                       FrameStats::Skipped& skipped);

/// Whether a point light of the list may reach a box, world metres.
bool is_reached(const DrawList& list, const Box& box);
/// Whether a tile, or all of a terrain, is drawn with the albedo and the normals of the ground:
/// point lights reach it, or its material has its own shader.
bool needs_ground(const DrawList& list, const TileDraw& draw);
bool needs_ground(const DrawList& list, const TerrainDraw& draw);
/// Whether a material of the list has its own shader.
bool has_surface_shader(const DrawList& list);

/// Widths of a detail tile on the picture between which it fades in, pixels.
inline constexpr glm::vec2 seen_tile_pixels{8.0F, 32.0F};

/// Heights of a detail tile on the picture between which its relief fades in, pixels: the error
/// bound of the polygons, or one pixel, and twice that.
glm::vec2 seen_height_pixels(const scene::TerrainNode& terrain);

/// How many times as wide as in a picture of 768 rows the contours and their labels are, at least
/// 1: in high pictures they look as in those.
double contour_scale(const scene::Camera& camera, glm::ivec2 size);

/// Where the pattern of dithers begins: of a part of a picture, so that parts continue it; pixels.
glm::vec2 dither_origin(const scene::Camera& camera, glm::ivec2 size);

/// Whether a terrain's detail texture is drawn: `polygons` alone show it.
bool has_detail(const scene::TerrainNode& terrain);

/// The level at a distance of at least `distance` metres.
DetailLevel seen_detail(const scene::TerrainNode& terrain, const scene::Camera& camera,
                        glm::ivec2 size, double distance);

} // namespace reljef::view
