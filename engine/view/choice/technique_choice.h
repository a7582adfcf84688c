#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "engine/scene/graph/scene.h"
#include "engine/terrain/mesh/bisection.h"
#include "engine/view/choice/ray_rounding.h"
#include "engine/view/choice/technique_costs.h"
#include "engine/view/choice/triangle_counts.h"
#include "engine/view/choice/typical_search.h"
#include "engine/view/choice/view_plan.h"
#include "engine/view/choice/view_probes.h"
#include "engine/view/draw_list.h"

namespace reljef::view {

struct ChoiceOptions {
    TechniqueCosts costs = {};
    /// Whether rays on the CPU draw a list: all tiles, each at the coarsest level that keeps the
    /// bound. Its tiles are only counted. Empty: they draw none.
    std::function<bool(const DrawList&)> rays_draw = {};
};

/// Chooses what draws the terrain of a list whose technique is `auto`: triangles, exact rays, or
/// triangles for the tiles around the eye and rays for all pixels that these leave. Tiles around
/// the eye hide the others, but are hidden by none of them, so what is drawn first is in front. All
/// candidates keep the error bound. With `typical`, unproven searches that show nine of ten
/// probes within it may draw all of the view. Equal lists get equal choices. Parts of a picture
/// (scene::Camera::whole) must show one choice, or edges jump between them. Lists of `exact` on
/// OpenGL get the error that their rays keep (FrameStats::kept_error).
class TechniqueChooser {
public:
    explicit TechniqueChooser(const ChoiceOptions& options) : options_(options) {}

    /// Per pixel of later lists, see render::DriverOptions::samples.
    void set_samples(int samples) { samples_ = samples; }
    [[nodiscard]] int samples() const { return samples_; }
    void set_costs(const TechniqueCosts& costs) { options_.costs = costs; }
    [[nodiscard]] const TechniqueCosts& costs() const { return options_.costs; }
    /// Of a texture, texels: rays of OpenGL over larger terrains cannot be drawn.
    void set_max_map_side(int texels) { max_map_side_ = texels; }
    /// `drop_hidden` drops tiles that nearer ground hides. It is called unless rays are cheaper
    /// than even the triangles of the tiles that are certainly seen.
    void choose(
        DrawList& list, const std::function<void()>& drop_hidden = [] {});
    /// The parts of a picture that are chosen later are drawn as is cheapest for this list of the
    /// whole: triangles alone, or rays alone, so that all have as many samples.
    void choose_for_parts(const DrawList& whole);

private:
    struct Decision {
        Choice choice;
        int last_ring = 0; ///< of triangles; `search` draws the other rings
        std::optional<scene::Technique> search;
        std::optional<double> kept_error;  ///< by rays, pixels
        bool lacks_triangles = false;      ///< rays miss the bound, and too few triangles fit
        bool exceeded_by_rounding = false; ///< see FrameStats
    };
    enum class Kinds { one, both };
    static ViewPlan cheapest(const ViewCosts& view, const TechniqueCosts& costs, Kinds kinds);
    void know(const scene::TerrainNode& terrain);
    Decision decide(const DrawList& list, Kinds kinds, const std::function<void()>& drop_hidden);
    [[nodiscard]] bool may_hidden_decide(const ViewCosts& view, const Decision& decision) const;
    Decision decide_proven(const DrawList& list, const ViewCosts& view, Kinds kinds);
    void state_error_of_rays(DrawList& list);
    void state_error_of_rays(DrawList& list, const TerrainDraw& draw);
    void consider_unproven(const DrawList& list, const ViewCosts& view, Decision& decision);

    ChoiceOptions options_;
    int samples_ = 1;
    int max_map_side_ = 1 << 14;
    std::optional<Decision> for_parts_;
    std::weak_ptr<const scene::TerrainSurface> surface_; // the known one
    TriangleCounts counts_;
    ProbedSurface probed_;
    PictureRounding rounding_;
};

} // namespace reljef::view
