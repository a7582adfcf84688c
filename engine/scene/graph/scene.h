#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/core/event.h"
#include "engine/core/geometry.h"
#include "engine/material/sky_picture.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/graph/facing.h"
#include "engine/scene/graph/mesh.h"
#include "engine/scene/graph/mesh_pick.h"
#include "engine/scene/graph/point_light.h"
#include "engine/scene/graph/terrain_node.h"
#include "engine/scene/streaming/light.h"

namespace reljef::scene {

/// The background, and the air in front of it. At a sine h of the height above the horizon the sky
/// is a share h · (1 + curve) / (h + curve) of the way from the horizon's to the zenith's colour,
/// plus the glow times the 8th power of the cosine of the angle to the sun. All colours are linear.
/// A picture replaces these, and the sun's disc; the horizon's colour stays that of the haze.
struct Sky {
    glm::vec3 zenith{0.13F, 0.30F, 0.62F};
    glm::vec3 horizon{0.62F, 0.74F, 0.87F};
    glm::vec3 glow{0.30F, 0.28F, 0.25F};
    float curve = 0.2F;      ///< > 0
    double visibility = 0.0; ///< metres to 2 % contrast at `base` (Koschmieder); 0: no haze
    glm::vec3 fading{1.0F};  ///< extinction of the three colours, relative to the mean one
    double air_height = 0.0; ///< metres to 1/e of the air's density; 0: the same everywhere
    double base = 0.0;       ///< z of the full density and of the plane, world metres
    /// Metres: plane and air bend down from `base` at the origin like the Earth; 0: they are level.
    double radius = 0.0;
    /// Reflected light of an endless plane at `base`; absent: the horizon's haze.
    std::optional<glm::vec3> plane = {};
    /// The plane goes on with the terrain's own sea, in the same air. Else it lies in mist.
    bool is_plane_sea = false;
    std::shared_ptr<const material::SkyPicture> picture = {};

    friend bool operator==(const Sky&, const Sky&) = default;
};

/// Extinction coefficient of the air at its base, 1/metre; 0 without fog.
double extinction(const Sky& sky);

/// A place over the base of the air.
struct AirPlace {
    double above = 0.0;           ///< metres above the base
    glm::dvec3 up{0.0, 0.0, 1.0}; ///< away from the base, unit vector of the world
};
AirPlace air_place(const Sky& sky, glm::dvec3 place);

/// The air as seen from an eye, for shaders and kernels.
struct AirSeen {
    glm::vec3 extinction{0.0F};     ///< 1/metre
    float eye_above = 0.0F;         ///< metres above the base, >= 0
    float eye_density = 1.0F;       ///< relative to that at the base
    float per_height = 0.0F;        ///< 1/metre; 0: the same density everywhere
    float plane_air = 0.0F;         ///< plane_air(); 0: there is no plane below the eye
    glm::vec3 up{0.0F, 0.0F, 1.0F}; ///< of the eye, as AirPlace
    /// 1/metre: heights along a straight ray grow by `bend` times its squared length more than it
    /// rises at the eye.
    float bend = 0.0F;
};
AirSeen air_seen(const Sky& sky, const Camera& camera);

/// Air between an eye and the plane straight below, in metres of air as dense as at the base; along
/// a ray it is divided by steepness_to_plane(). `above`: metres of the eye above the base, > 0.
double plane_air(const Sky& sky, double above);

/// The height over the length of a ray that falls to the plane. On a level plane it is the sine of
/// the fall at the eye, `fall`, > 0. Where the Earth bends away below the ray, it shrinks from half
/// the sine to 0 at level rays: no line shows at the horizon. `above`: as plane_air().
double steepness_to_plane(const Sky& sky, double above, double fall);

/// The picture of a sky as a camera sees it.
struct SeenSky {
    std::shared_ptr<const material::SkyPicture> picture;
    glm::dmat3 picture_from_world{1.0}; ///< a rotation
    std::size_t level = 0;              ///< whose texels are about as wide as pixels

    /// Linear. `direction`: in the world, of any length above 0.
    [[nodiscard]] glm::vec3 color(glm::dvec3 direction) const;
};

/// The directions east, true north and up at an eye, unit vectors of the world. `world_from_local`:
/// of the terrain with the placement.
glm::dmat3 ground_axes(const terrain::Placement& placement, const glm::dmat4& world_from_local,
                       glm::dvec3 eye);

/// Empty if the sky is no picture. `axes`: of ground_axes().
std::optional<SeenSky> seen_sky(const Sky& sky, const Camera& camera, glm::ivec2 size,
                                const glm::dmat3& axes);

struct MeshNode {
    std::shared_ptr<const Mesh> mesh;
    Material material;
    /// Towards the scene's camera: drawn turned by faced(). Children of the node do not turn with
    /// it.
    Facing facing = Facing::node;
    /// Meshes that may be drawn instead, where the view keeps an error bound; null: none. Never by
    /// the truth.
    std::shared_ptr<const MeshLevels> levels = nullptr;

    friend bool operator==(const MeshNode&, const MeshNode&) = default;
};

/// Fails if the technique cannot draw the mesh, with the reason and a technique that can. A mesh of
/// one colour works with all.
Result<void> check_technique(const Technique& technique, const MeshNode& mesh);

class Node;

/// Changes a node over time; `time`: seconds since the scene began.
using Animator = std::function<void(Node& node, double time)>;

/// Returns whether it handled the event; if not, the next receiver gets it.
using EventReceiver = std::function<bool(const Event& event)>;

using NodeVisitor = std::function<void(const Node& node, const glm::dmat4& world_from_local)>;

/// A node of the scene graph: a transform, optional content, and children. Owned by its parent.
class Node {
public:
    using Content = std::variant<std::monostate, TerrainNode, MeshNode, Light, PointLight, Camera>;

    explicit Node(std::string name, Content content = {});
    Node(const Node&) = delete;
    Node& operator=(const Node&) = delete;

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] Node* parent() const { return parent_; }
    [[nodiscard]] const std::vector<std::unique_ptr<Node>>& children() const { return children_; }

    /// Precondition: `child` is not null.
    Node& add(std::unique_ptr<Node> child);
    Node& add(std::string name, Content content = {});
    /// Removes a child from the tree; null if it is not a child of this node.
    std::unique_ptr<Node> remove(const Node& child);

    template <class T> [[nodiscard]] T* get() { return std::get_if<T>(&content_); }
    template <class T> [[nodiscard]] const T* get() const { return std::get_if<T>(&content_); }
    [[nodiscard]] const Content& content() const { return content_; }

    [[nodiscard]] bool visible() const { return visible_; }
    /// An invisible node hides its children too.
    void set_visible(bool visible) { visible_ = visible; }

    [[nodiscard]] const glm::dmat4& parent_from_local() const { return parent_from_local_; }
    /// Precondition: affine.
    void set_parent_from_local(const glm::dmat4& transform) { parent_from_local_ = transform; }
    void set_position(glm::dvec3 position) { parent_from_local_[3] = glm::dvec4(position, 1.0); }
    [[nodiscard]] glm::dmat4 world_from_local() const;

    /// Of the content, local metres; empty if there is nothing to draw.
    [[nodiscard]] Box local_bounds() const;
    /// Of the content and all visible descendants, world metres.
    [[nodiscard]] Box world_bounds() const;

    void add_animator(Animator animator) { animators_.push_back(std::move(animator)); }
    /// animate() of the parent removes this node from this time on; absent: never.
    void set_end(std::optional<double> time) { end_ = time; }
    [[nodiscard]] std::optional<double> end() const { return end_; }
    /// Calls the animators of the node and of all below it, parents first.
    void animate(double time);

private:
    std::string name_;
    Content content_;
    Node* parent_ = nullptr;
    std::vector<std::unique_ptr<Node>> children_;
    std::vector<Animator> animators_;
    glm::dmat4 parent_from_local_{1.0};
    std::optional<double> end_;
    bool visible_ = true;
};

/// The tree of nodes, its sky, and its event receivers.
class Scene {
public:
    [[nodiscard]] Node& root() { return *root_; }
    [[nodiscard]] const Node& root() const { return *root_; }

    Result<Node*> add_terrain(terrain::Terrain terrain, const TerrainOptions& options = {});
    Node& add_mesh(Mesh mesh, const Material& material = {});
    /// The first visible one is the sun. Others shine without shadows; their Light::ambient has no
    /// effect.
    Node& add_light(const Light& light = {});
    /// At `place`, world metres. The node may move.
    Node& add_point_light(const PointLight& light = {}, glm::dvec3 place = glm::dvec3(0.0));
    /// The first camera becomes the active one.
    Node& add_camera(const Camera& camera = {});

    void set_sky(const Sky& sky) { sky_ = sky; }
    void remove_sky() { sky_.reset(); }
    [[nodiscard]] const std::optional<Sky>& sky() const { return sky_; }

    /// Share of their colour that pixels far behind their surroundings lose, [0, 1]; 0: none. See
    /// view::shade_eye_dome(). It changes pictures only.
    void set_eye_dome(double strength) { eye_dome_ = strength; }
    [[nodiscard]] double eye_dome() const { return eye_dome_; }

    /// Precondition: `node` holds a Camera and is in the tree as long as it is active.
    void set_active_camera(Node& node);
    /// The active camera in world metres; a default one if there is none.
    [[nodiscard]] Camera camera() const;

    /// The first visible light, in the world.
    [[nodiscard]] std::optional<Light> sun() const;
    /// All visible ones, in the order of the tree; among them lights that are not the sun, see
    /// as_point_light().
    [[nodiscard]] std::vector<PlacedPointLight> point_lights() const;

    /// z of the highest visible terrain at world (x, y).
    [[nodiscard]] std::optional<double> height_at(double x, double y) const;
    struct Pick {
        const Node* node = nullptr; ///< a terrain or a mesh
        double t = 0.0;             ///< along the ray
        glm::dvec3 world{0.0};
        std::optional<terrain::SurfaceHit> ground = {}; ///< of a terrain
        glm::dvec3 normal{0.0};                         ///< of a mesh's face: outwards, unit
    };
    /// The first visible terrain or mesh that a world ray hits, exactly; of a streamed terrain the
    /// overview (pick_ground() has its tiles).
    [[nodiscard]] std::optional<Pick> pick(const Ray& ray) const;
    /// The first visible triangle with t in `range` that a world ray meets from outside. Billboards
    /// face the scene's camera. Detail textures are not searched: the hit lies on the triangle.
    [[nodiscard]] std::optional<Pick>
    pick_mesh(const Ray& ray,
              reljef::Interval range = {0.0, std::numeric_limits<double>::infinity()}) const;

    void add_event_receiver(EventReceiver receiver) { receivers_.push_back(std::move(receiver)); }
    /// Offers the event to the receivers, the latest first, until one handles it.
    bool dispatch(const Event& event) const;

private:
    std::unique_ptr<Node> root_ = std::make_unique<Node>("root");
    std::unique_ptr<MeshTrees> trees_ = std::make_unique<MeshTrees>();
    std::optional<Sky> sky_;
    double eye_dome_ = 0.0;
    Node* active_camera_ = nullptr;
    std::vector<EventReceiver> receivers_;
};

/// The name of the object that a node is a part of: that of the topmost node above it below the
/// root.
const std::string& object_name(const Node& node);

/// Visits every visible node of the tree, parents first.
void visit_visible(const Node& root, const NodeVisitor& visit);

} // namespace reljef::scene
