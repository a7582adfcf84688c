#include "engine/view/tile_selection.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <queue>
#include <set>
#include <utility>

#include "engine/view/nearer_ground.h"
#include "engine/view/stream_view.h"

namespace reljef::view {
namespace {

// Requests of one view. These tiles may make less urgent ones unnecessary.
constexpr std::size_t max_requests = 16;

struct Candidate {
    double along = 0.0; // metres from the eye, along the ground
    terrain::TreeTile id;
    Box expected;         // local metres
    double urgency = 0.0; // the smallest relative error of its ancestors
    terrain::TreeTile parent;
    bool is_hidden = false;   // the parent is hidden
    bool is_foreseen = false; // an ancestor is not loaded: neither requested nor drawn

    friend bool operator<(const Candidate& a, const Candidate& b) {
        return a.along != b.along ? a.along > b.along : b.id < a.id;
    }
};

// The horizon by which the largest errors are tightened. It takes long, so only they are.
constexpr int resolution_for_largest = 8;

// Lowers the largest errors of proven tiles, until the bound is kept or the largest error is seen.
void tighten_largest(std::vector<TileSelection::Drawn>& drawn, const StreamView& view,
                     const NearerGround& nearer) {
    const auto less = [](const TileSelection::Drawn& a, const TileSelection::Drawn& b) {
        return a.error < b.error;
    };
    NearerGround finer = nearer.finer(resolution_for_largest);
    const auto is_hidden = [&](const Box& box) { return finer.hides(box, view.along(box)); };
    while (!drawn.empty()) {
        const auto largest = std::max_element(drawn.begin(), drawn.end(), less);
        if (largest->error <= view.max_kept_error() || !largest->tile->is_proven) {
            return;
        }
        double next = view.max_kept_error();
        for (const TileSelection::Drawn& other : drawn) {
            next = other.error < largest->error ? std::max(next, other.error) : next;
        }
        const double tight = view.tight_error_of(*largest->tile, is_hidden, next);
        if (tight >= largest->error) {
            return;
        }
        largest->error = tight;
    }
}

// Lowers the errors of proven tiles over the bound: by the heights that are drawn, and by what
// `nearer` hides.
void tighten(std::vector<TileSelection::Drawn>& drawn, const StreamView& view,
             NearerGround& nearer) {
    const auto is_hidden = [&](const Box& box) { return nearer.hides(box, view.along(box)); };
    for (auto& [tile, distance, error, error_with_hidden] : drawn) {
        if (tile->is_proven && view.is_over_share(error)) {
            error = std::min(error, view.tight_error_of(*tile, is_hidden));
        }
    }
    tighten_largest(drawn, view, nearer);
}

TileSelection::Drawn drawn_of(const StreamView& view,
                              std::shared_ptr<const scene::TerrainTile> tile) {
    const double distance = view.distance_to(tile->bounds);
    const double error = view.error_of(*tile);
    return {std::move(tile), distance, error, error};
}

struct WalkLimits {
    double max_relative_error = 1.0;    // tiles with larger errors are refined
    std::set<terrain::TreeTile> leaves; // not refined: children are missing
    // Whether nearer ground hides tiles. Not with leaves: tiles that stand in for finer ones show
    // ground that is not there.
    bool hides = true;
};

// One walk through the tree, from the eye outwards.
class TreeWalk {
public:
    TreeWalk(const StreamView& view, const WalkLimits& limits, const TileSelectionOptions& options)
        : view_(view), limits_(limits), options_(options),
          nearer_(view.builder(), limits.hides ? view.horizon() : std::nullopt,
                  limits.hides ? view.earth_horizon() : std::nullopt) {}
    TreeWalk(const TreeWalk&) = delete;

    /// Stops and returns false if the drawn tiles do not fit in memory.
    [[nodiscard]] bool walk(const scene::TerrainTile& root) {
        open_.push({view_.along(root.bounds), root.id, root.bounds,
                    std::numeric_limits<double>::infinity(), root.id});
        while (!open_.empty() && leaves_ <= view_.max_drawn()) {
            const Candidate next = open_.top();
            open_.pop();
            visit(next);
        }
        return leaves_ <= view_.max_drawn();
    }

    [[nodiscard]] const std::vector<Candidate>& missing() const { return missing_; }
    /// The loaded tiles that would be drawn, and their ancestors.
    [[nodiscard]] const std::vector<terrain::TreeTile>& used() const { return used_; }
    TileSelection take() { return std::move(selection_); }
    /// The drawn tiles.
    NearerGround& nearer() { return nearer_; }

private:
    void visit(const Candidate& candidate) {
        // Independent of what is loaded, so that the selection is, too.
        const bool is_hidden =
            candidate.is_hidden || nearer_.hides(candidate.expected, candidate.along);
        auto known = view_.known(candidate.id);
        if (is_hidden && !options_.keeps_hidden) {
            leave_out(known ? std::move(known->tile) : nullptr);
        } else if (!known) {
            use_or_request(candidate, nullptr);
            ++leaves_;
        } else if (candidate.id.level > 0 || view_.may_see(known->summary.bounds)) {
            add(candidate, std::move(*known), is_hidden);
        } else {
            ++selection_.outside_frustum;
            if (candidate.along == 0.0) { // occlusion needs the tile under the eye
                use_or_request(candidate, known->tile);
                nearer_.add_under_eye(std::move(known->tile));
            }
        }
    }

    void leave_out(std::shared_ptr<const scene::TerrainTile> tile) {
        if (tile == nullptr) {
            ++selection_.hidden_unread;
        } else {
            selection_.hidden.push_back(drawn_of(view_, std::move(tile)));
        }
    }

    void use_or_request(const Candidate& candidate,
                        const std::shared_ptr<const scene::TerrainTile>& tile) {
        if (tile != nullptr) {
            used_.push_back(candidate.id);
        } else if (!candidate.is_foreseen) {
            missing_.push_back(candidate);
        }
    }

    void add(const Candidate& candidate, KnownTile known, bool is_above_hidden) {
        const scene::TileSummary& summary = known.summary;
        const double relative_error = view_.relative_error_of(summary, candidate.urgency);
        const bool is_refined =
            relative_error > limits_.max_relative_error && !limits_.leaves.contains(summary.id);
        const Box box = is_refined ? view_.hiding_bounds(summary) : summary.bounds;
        const bool is_hidden = is_above_hidden || nearer_.hides(box, candidate.along);
        if (is_hidden && !options_.keeps_hidden) {
            leave_out(std::move(known.tile));
            return;
        }
        use_or_request(candidate, known.tile);
        if (is_refined) {
            push_children(candidate, known, relative_error, is_hidden);
        } else {
            add_leaf(candidate, std::move(known.tile), is_hidden);
        }
    }

    void push_children(const Candidate& candidate, const KnownTile& known, double urgency,
                       bool is_hidden) {
        const bool is_foreseen = candidate.is_foreseen || known.tile == nullptr;
        for (const terrain::TreeTile child : view_.stream().tree().children(candidate.id)) {
            const Box expected = view_.hiding_bounds(known.summary, child);
            const double along = view_.along(expected);
            if (view_.may_see_child(known.summary, child)) {
                open_.push({along, child, expected, urgency, candidate.id, is_hidden, is_foreseen});
                continue;
            }
            ++selection_.outside_frustum;
            if (along == 0.0 && !is_foreseen) {
                nearer_.add_under_eye(known.tile);
            }
        }
    }

    void add_leaf(const Candidate& candidate, std::shared_ptr<const scene::TerrainTile> tile,
                  bool is_hidden) {
        if (is_hidden && tile != nullptr) {
            selection_.hidden.push_back(drawn_of(view_, std::move(tile)));
            return;
        }
        ++leaves_;
        if (tile != nullptr && !candidate.is_foreseen) {
            nearer_.add(tile);
            selection_.drawn.push_back(drawn_of(view_, std::move(tile)));
        }
    }

    const StreamView& view_;
    const WalkLimits& limits_;
    const TileSelectionOptions& options_;
    NearerGround nearer_;
    std::priority_queue<Candidate> open_;
    std::vector<Candidate> missing_;
    std::size_t leaves_ = 0; // tiles to draw once all are loaded
    std::vector<terrain::TreeTile> used_;
    TileSelection selection_;
};

struct Refinement {
    double relative_error = 1.0; // above which tiles may be refined
    std::size_t tiles = 1;       // seen
};

// Refines the largest relative errors over `allowed` first, as long as all tiles fit that `nearer`
// does not hide. Depends on known tiles only, loaded or not.
Refinement refine_within(std::size_t max_tiles, const StreamView& view,
                         const scene::TerrainTile& root, NearerGround& nearer,
                         double allowed = 1.0) {
    struct Open {
        double relative_error;
        scene::TileSummary tile;

        bool operator<(const Open& other) const {
            return relative_error != other.relative_error ? relative_error < other.relative_error
                                                          : other.tile.id < tile.id;
        }
    };
    Refinement made;
    std::priority_queue<Open> open;
    open.push({view.relative_error_of(root, std::numeric_limits<double>::infinity()), root});
    while (!open.empty() && open.top().relative_error > allowed) {
        const Open next = open.top();
        open.pop();
        std::size_t seen = 0;
        for (const terrain::TreeTile child : view.stream().tree().children(next.tile.id)) {
            const Box expected = view.hiding_bounds(next.tile, child);
            if (!view.may_see_child(next.tile, child) ||
                nearer.hides(expected, view.along(expected))) {
                continue;
            }
            ++seen;
            if (const auto known = view.known(child)) {
                const double relative_error =
                    view.relative_error_of(known->summary, next.relative_error);
                open.push({relative_error, known->summary});
            }
        }
        made.tiles += std::max<std::size_t>(seen, 1) - 1; // never decreases: the limit is safe
        if (made.tiles > max_tiles) {
            made.relative_error = next.relative_error;
            return made;
        }
    }
    return made;
}

std::vector<terrain::TreeTile> by_urgency(std::vector<Candidate> missing) {
    std::sort(missing.begin(), missing.end(), [](const Candidate& a, const Candidate& b) {
        return a.urgency != b.urgency ? a.urgency > b.urgency : a.id < b.id;
    });
    missing.resize(std::min(missing.size(), max_requests));
    std::vector<terrain::TreeTile> requested;
    requested.reserve(missing.size());
    for (const Candidate& candidate : missing) {
        requested.push_back(candidate.id);
    }
    return requested;
}

bool are_given_up(const scene::TileStream& stream, const std::vector<Candidate>& missing) {
    return !missing.empty() &&
           std::all_of(missing.begin(), missing.end(), [&](const Candidate& candidate) {
               return stream.has_given_up(candidate.id);
           });
}

// Draws and requests the tiles of a walk that found room for finer ones than `coarse`.
TileSelection finer_or(TileSelection coarse, TreeWalk& walk, const StreamView& view) {
    std::set<terrain::TreeTile> used(coarse.used.begin(), coarse.used.end());
    used.insert(walk.used().begin(), walk.used().end());
    TileSelection finer = std::move(coarse);
    if (walk.missing().empty()) {
        finer = walk.take();
        tighten(finer.drawn, view, walk.nearer());
    }
    finer.requested = by_urgency(walk.missing());
    finer.used.assign(used.begin(), used.end());
    return finer;
}

// If tiles are hidden, others can be finer than `coarse`, which fits with all of them. Requests
// them and draws `coarse` meanwhile. Finer ground hides a little more or less than that of
// `coarse`: if too much is seen, less is refined.
TileSelection refined_behind(NearerGround& nearer, TileSelection coarse, double coarse_error,
                             const StreamView& view, const scene::TerrainTile& root,
                             const TileSelectionOptions& options) {
    for (std::size_t eighths = 8; eighths >= 4; --eighths) {
        WalkLimits limits;
        limits.max_relative_error =
            refine_within(view.max_drawn() * eighths / 8, view, root, nearer).relative_error;
        if (limits.max_relative_error >= coarse_error) {
            return coarse;
        }
        TreeWalk walk(view, limits, options);
        if (walk.walk(root)) {
            return finer_or(std::move(coarse), walk, view);
        }
    }
    return coarse;
}

// What a walk without missing tiles draws.
TileSelection drawn_by(TreeWalk& walk, const WalkLimits& limits,
                       std::vector<terrain::TreeTile> requested,
                       const std::set<terrain::TreeTile>& used, const StreamView& view,
                       const scene::TerrainTile& root, const TileSelectionOptions& options) {
    TileSelection selection = walk.take();
    tighten(selection.drawn, view, walk.nearer());
    selection.requested = std::move(requested);
    selection.used.assign(used.begin(), used.end());
    const double error = limits.max_relative_error;
    return limits.hides && error > 1.0 && selection.requested.empty()
               ? refined_behind(walk.nearer(), std::move(selection), error, view, root, options)
               : selection;
}

// Whether tiles may be hidden though not all fit in memory: only if refine_within() knows as much
// of unread, hidden tiles as of read ones. Otherwise the selection would depend on earlier views.
bool can_hide_beyond_memory(const StreamView& view, const scene::TerrainTile& root) {
    return root.is_proven && !view.builder().has_images();
}

// Walks until no tile is missing. This ends: each walk but the last raises the error so that all
// fits in memory, adds a leaf, or is the last that hides.
TileSelection walk_until_complete(const StreamView& view, const scene::TerrainTile& root,
                                  const TileSelectionOptions& options) {
    WalkLimits limits;
    std::optional<std::vector<terrain::TreeTile>> requested;
    std::set<terrain::TreeTile> used; // by any walk, because the next view is similar
    while (true) {
        TreeWalk walk(view, limits, options);
        if (!walk.walk(root)) {
            NearerGround nothing(view.builder(), std::nullopt);
            limits.max_relative_error =
                refine_within(view.max_drawn(), view, root, nothing).relative_error;
            limits.hides = limits.hides && can_hide_beyond_memory(view, root);
            continue;
        }
        used.insert(walk.used().begin(), walk.used().end());
        if (limits.hides && are_given_up(view.stream(), walk.missing())) {
            limits.hides = false; // for long: tiles that stand in are requested, too
            continue;
        }
        if (!requested) {
            requested = by_urgency(walk.missing());
        }
        if (walk.missing().empty()) {
            return drawn_by(walk, limits, std::move(*requested), used, view, root, options);
        }
        for (const Candidate& candidate : walk.missing()) {
            limits.leaves.insert(candidate.parent);
        }
        limits.hides = false;
    }
}

std::shared_ptr<const scene::TerrainTile> finest_under_eye(const TileSelection& selection,
                                                           const StreamView& view) {
    std::shared_ptr<const scene::TerrainTile> finest;
    for (const terrain::TreeTile id : selection.used) {
        auto tile = view.stream().find(id);
        if (tile != nullptr && view.along(tile->bounds) == 0.0 &&
            (finest == nullptr || id.level < finest->id.level)) {
            finest = std::move(tile);
        }
    }
    return finest;
}

} // namespace

bool needs_cones(const scene::TerrainNode& terrain) {
    return terrain.material.technique.id() == scene::TechniqueId::cone;
}

bool is_ready(const scene::TerrainNode& terrain, const scene::TerrainTile& tile) {
    return tile.cones != nullptr || !needs_cones(terrain);
}

TileSelection select_tiles(const scene::TerrainNode& terrain, const scene::Camera& camera,
                           glm::ivec2 size, const glm::dmat4& world_from_local,
                           const TileSelectionOptions& options) {
    check(terrain.stream != nullptr, "a streamed terrain was expected");
    const scene::TileStream& stream = *terrain.stream;
    const auto root = stream.find(stream.tree().root());
    if (root == nullptr || !is_ready(terrain, *root)) {
        TileSelection selection;
        selection.has_root = false;
        selection.requested.push_back(stream.tree().root());
        return selection;
    }
    const StreamView view(terrain, camera, size, world_from_local);
    return walk_until_complete(view, *root, options);
}

RayTilesError error_of_ray_tiles(const scene::TerrainNode& terrain, const scene::Camera& camera,
                                 glm::ivec2 size, const glm::dmat4& world_from_local,
                                 std::span<const TileSelection::Drawn> drawn,
                                 std::span<const std::shared_ptr<const scene::TerrainTile>> tiles) {
    RayTilesError found;
    const auto add = [&](const scene::TerrainTile& tile, double error) {
        if (tile.is_proven) {
            found.proven = std::max(found.proven.value_or(0.0), error);
        } else {
            ++found.unproven;
        }
    };
    std::set<terrain::TreeTile> finest;
    for (const TileSelection::Drawn& one : drawn) {
        add(*one.tile, one.error);
        finest.insert(one.tile->id);
    }
    std::set<terrain::TreeTile> known;
    for (const auto& tile : tiles) {
        known.insert(tile->id);
    }
    const StreamView view(terrain, camera, size, world_from_local);
    for (const auto& tile : tiles) {
        const auto error =
            finest.contains(tile->id) ? std::nullopt : view.error_beside(*tile, known);
        if (error) {
            add(*tile, *error);
        }
    }
    return found;
}

std::size_t tiles_for_bound(const scene::TerrainNode& terrain, const scene::Camera& camera,
                            glm::ivec2 size, const glm::dmat4& world_from_local) {
    check(terrain.stream != nullptr, "a streamed terrain was expected");
    const auto root = terrain.stream->find(terrain.stream->tree().root());
    if (root == nullptr) {
        return 1;
    }
    const StreamView view(terrain, camera, size, world_from_local);
    NearerGround nearer(view.builder(), view.horizon(), view.earth_horizon());
    const TileSelection selection = walk_until_complete(view, *root, {});
    for (const TileSelection::Drawn& drawn : selection.drawn) {
        nearer.add(drawn.tile);
    }
    nearer.add_under_eye(finest_under_eye(selection, view));
    const std::size_t tiles =
        refine_within(max_tiles_counted, view, *root, nearer, max_kept_relative_error).tiles;
    return std::min(max_tiles_counted, tiles + tiles / 8);
}

} // namespace reljef::view
