#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "engine/scene/graph/scene.h"
#include "engine/terrain/mesh/bisection.h"
#include "engine/view/choice/technique_costs.h"
#include "engine/view/choice/triangle_counts.h"
#include "engine/view/draw_list.h"

namespace reljef::view {

/// What a terrain's tiles in a view cost, by their ring: tiles around the one below the eye have
/// ring 1, those around these ring 2.
struct RingCost {
    int ring = 0;
    double triangles = 0.0;
    double pixels = 0.0; ///< of the picture that it covers
};

/// Which part of a view is drawn as triangles.
struct ViewPlan {
    /// Tiles up to this ring are triangles, and rays draw all pixels that these leave; -1: rays
    /// alone. At least the last ring: triangles alone.
    int last_ring = -1;
    double triangles = 0.0;
    double ray_pixels = 0.0;
    double ms = 0.0; ///< estimated
};

/// What plans are made of.
struct ViewCosts {
    std::vector<RingCost> rings; ///< ascending
    double box_pixels = 0.0;     ///< that show the box around the terrain
    int samples_of_rays = 1;     ///< per pixel of a picture by rays alone
    int samples_of_both = 1;     ///< per pixel of a picture with triangles, too
    double max_triangles = std::numeric_limits<double>::infinity(); ///< that fit the memory
};
/// Estimates the plan up to a ring.
ViewPlan plan_up_to(int ring, const ViewCosts& view, const TechniqueCosts& costs);
/// The cheapest whose triangles fit, but both only if they save a quarter. Precondition: there are
/// rings.
ViewPlan cheapest_plan(const ViewCosts& view, const TechniqueCosts& costs);

struct ChoiceOptions {
    TechniqueCosts costs = {};
    /// Whether rays on the CPU draw a list: all tiles, each at the coarsest level that keeps the
    /// bound. Its tiles are only counted. Empty: they draw none.
    std::function<bool(const DrawList&)> rays_draw = {};
};

/// Chooses what draws the terrain of a list whose technique is `auto`: triangles, exact rays, or
/// triangles for the tiles around the eye and rays for all pixels that these leave. Tiles around
/// the eye hide the others, but are hidden by none of them, so what is drawn first is in front. All
/// candidates keep the error bound. Equal lists get equal choices.
/// Parts of a picture (scene::Camera::whole) must show one choice, or edges jump between them.
class TechniqueChooser {
public:
    explicit TechniqueChooser(const ChoiceOptions& options) : options_(options) {}

    /// Per pixel of later lists, see render::DriverOptions::samples.
    void set_samples(int samples) { samples_ = samples; }
    [[nodiscard]] int samples() const { return samples_; }
    void set_costs(const TechniqueCosts& costs) { options_.costs = costs; }
    /// Of a texture, texels: rays of OpenGL over larger terrains cannot be drawn.
    void set_max_map_side(int texels) { max_map_side_ = texels; }
    void choose(DrawList& list);
    /// The parts of a picture that are chosen later are drawn as is cheapest for this list of the
    /// whole: triangles alone, or rays alone, so that all have as many samples.
    void choose_for_parts(const DrawList& whole);

private:
    struct Decision {
        Choice choice;
        int last_ring = 0; ///< of triangles; rays draw the other rings
        bool has_rays = false;
        double kept_error = 0.0;      ///< if rays are drawn, pixels
        bool lacks_triangles = false; ///< rays miss the bound, and too few triangles fit
    };
    enum class Kinds { one, both };
    void know(const scene::TerrainNode& terrain);
    Decision decide(const DrawList& list, Kinds kinds);

    ChoiceOptions options_;
    int samples_ = 1;
    int max_map_side_ = 1 << 14;
    std::optional<Decision> for_parts_;
    std::weak_ptr<const scene::TerrainSurface> surface_; // the known one
    TriangleCounts counts_;
    double steepness_ = 0.0;
};

} // namespace reljef::view
