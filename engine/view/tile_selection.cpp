#include "engine/view/tile_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <queue>
#include <set>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "engine/view/error_view.h"
#include "engine/view/nearer_ground.h"

namespace reljef::view {
namespace {

// Of unproven tiles: estimated margin of the finer tiles' heights beyond a tile's own (averages are
// lower than peaks): a share of its range, plus a number of its errors. The margin for hiding is
// larger: a tower where four averages meet is 16 times as high in the next level.
constexpr double margin_of_range = 0.25;
constexpr double errors_seen = 1.0;
constexpr double errors_hidden = 16.0;

constexpr double default_error = 1.0; // pixels, if the technique has no bound

// The tiles' share of the error bound; the rest is for fewer triangles.
constexpr double share_of_tiles = 0.5;

// Error bounds by which an occluder may appear lower, and a hidden tile higher, than the heights of
// its tile: fewer triangles take up to a whole bound of each. The heights of unproven tiles that
// were not read are estimates.
constexpr double errors_of_horizon = 2.0;
constexpr double errors_of_unproven_horizon = 3.0;

// Metres: the smallest radius of curvature of WGS 84, b²/a. Two verticals that are a chord apart
// turn by at most pi/2 times chord over radius.
constexpr double min_radius_of_earth = 6'335'439.0;

constexpr double max_texel = 1.0; // pixels between texels, if there are finer images

// More would take gigabytes.
constexpr std::size_t max_tiles_counted = 100'000;

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

// Heights of the finer tiles below a tile: of all samples, or expected.
terrain::HeightRange range_below(const scene::TileSummary& tile, double errors) {
    if (tile.is_proven) {
        return tile.range;
    }
    const double margin =
        margin_of_range * (tile.range.high - tile.range.low) + errors * tile.error;
    return {tile.range.low - margin, tile.range.high + margin};
}

struct KnownTile {
    scene::TileSummary summary;
    std::shared_ptr<const scene::TerrainTile> tile; // null: evicted
};

class StreamView {
public:
    StreamView(const scene::TerrainNode& terrain, const scene::Camera& camera, glm::ivec2 size,
               const glm::dmat4& world_from_local)
        : stream_(*terrain.stream), camera_(camera), world_from_local_(world_from_local),
          frustum_(scene::clip_from_world(camera, size)),
          picture_error_(camera, size, world_from_local) {
        const bool is_solid = terrain.material.technique.id() == scene::TechniqueId::polygons;
        const double error = scene::error_bound(terrain.material.technique);
        max_error_ = error > 0.0 ? std::max(error, min_error) - rasterizer_error : default_error;
        is_perspective_ = camera.projection == scene::ProjectionKind::perspective;
        pixels_per_metre_ = is_perspective_
                                ? 0.5 * size.y / std::tan(0.5 * glm::radians(camera.vertical_fov))
                                : size.y / camera.view_height;
        eye_ = glm::dvec3(glm::inverse(world_from_local) * glm::dvec4(camera.eye, 1.0));
        if (is_solid && !terrain.material.wireframe &&
            builder().overview().placement().kind() == terrain::PlacementKind::plane) {
            const bool is_proven = stream_.recall(stream_.tree().root()).value().is_proven;
            const double errors = is_proven ? errors_of_horizon : errors_of_unproven_horizon;
            horizon_ = horizon_view(camera, size, world_from_local, errors * max_error_);
        }
    }

    [[nodiscard]] const scene::TileStream& stream() const { return stream_; }
    [[nodiscard]] const scene::TileBuilder& builder() const { return stream_.maker(); }
    /// Empty if nothing can be hidden.
    [[nodiscard]] const std::optional<terrain::HorizonView>& horizon() const { return horizon_; }

    [[nodiscard]] std::optional<KnownTile> known(terrain::TreeTile id) const {
        if (auto tile = stream_.find(id)) {
            return KnownTile{*tile, std::move(tile)};
        }
        const auto summary = stream_.recall(id);
        return summary ? std::optional(KnownTile{*summary, nullptr}) : std::nullopt;
    }

    [[nodiscard]] bool may_see(const Box& local) const {
        return frustum_.may_see(transformed(world_from_local_, local));
    }

    [[nodiscard]] bool may_see_child(const scene::TileSummary& parent,
                                     terrain::TreeTile child) const {
        return may_see(child_bounds(parent, child, errors_seen));
    }

    /// Of a child's samples: proven, or expected with a margin of so many of the parent's errors.
    [[nodiscard]] Box child_bounds(const scene::TileSummary& parent, terrain::TreeTile child,
                                   double errors) const {
        const auto summary = parent.is_proven ? stream_.recall(child) : std::nullopt;
        return summary && summary->is_proven ? summary->bounds
                                             : builder().bounds(child, range_below(parent, errors));
    }

    /// Distance to the nearest point of a box along the local ground, metres.
    [[nodiscard]] double along(const Box& local) const {
        const glm::dvec2 eye(eye_);
        return glm::distance(eye, glm::clamp(eye, glm::dvec2(local.low), glm::dvec2(local.high)));
    }

    [[nodiscard]] TileSelection::Drawn drawn(std::shared_ptr<const scene::TerrainTile> tile) const {
        const double distance = distance_to(*tile);
        const double error = error_of(*tile);
        return {std::move(tile), distance, error};
    }

    /// Lowers the errors of proven tiles over the bound: from the blocks that `nearer` does not
    /// hide and the heights that are drawn.
    void tighten(std::vector<TileSelection::Drawn>& drawn, NearerGround& nearer) const {
        for (auto& [tile, distance, error] : drawn) {
            if (tile->is_proven && error > share_of_tiles * max_error_) {
                const double tighter = error_of_blocks(
                    *tile, scene::cells_per_block,
                    [&, &blocks = tile->blocks](int col, int row) {
                        const terrain::MinMax block = blocks(col, row);
                        return terrain::HeightRange{block.low, block.high};
                    },
                    [&](const Box& box) { return may_see(box) && !nearer.hides(box, along(box)); });
                error = std::min(error, tighter);
            }
        }
    }

    /// The error on the picture, or the size of its texels, relative to its bound.
    [[nodiscard]] double relative_error_of(const scene::TileSummary& tile) const {
        if (tile.id.level == 0) {
            return 0.0;
        }
        const double pixels = pixels_per_metre(distance_to(tile));
        const double texels = tile.coarse_texel * pixels / max_texel;
        if (builder().has_all_samples(tile.id)) {
            return texels;
        }
        const double error = error_of(tile) / share_of_tiles;
        const double apart =
            tile.is_proven ? 0.0
                           : builder().spacing(tile.id.level) * pixels / samples_apart_in_errors;
        return std::max({error / max_error_, apart / max_error_, texels});
    }

private:
    /// Of its vertices on the picture, pixels: a bound if it is proven, otherwise an estimate.
    [[nodiscard]] double error_of(const scene::TileSummary& tile) const {
        if (tile.is_proven) {
            const double error = error_in(tile.bounds, tile.error);
            return error <= share_of_tiles * max_error_ ? error : error_of_blocks(tile);
        }
        return builder().has_all_samples(tile.id)
                   ? 0.0
                   : tile.error * pixels_per_metre(distance_to(tile));
    }

    [[nodiscard]] double error_in(const Box& box, double error) const {
        const terrain::Placement& placement = builder().overview().placement();
        const bool is_plane = placement.kind() == terrain::PlacementKind::plane;
        const double turn =
            is_plane ? 0.0
                     : 0.5 * std::numbers::pi * 0.5 * glm::length(box.size()) / min_radius_of_earth;
        return picture_error_.of({box, error, placement.up(box.center()), turn});
    }

    /// The largest of the visible blocks of a proven tile.
    [[nodiscard]] double error_of_blocks(const scene::TileSummary& tile) const {
        const double true_error = tile.error / builder().overview().placement().exaggeration();
        const terrain::HeightRange drawn{tile.range.low - true_error, tile.range.high + true_error};
        return error_of_blocks(
            tile, terrain::cells_per_error_block, [&](int /*col*/, int /*row*/) { return drawn; },
            [&](const Box& box) { return may_see(box); });
    }

    // `range_of(col, row)`: of the drawn heights of a block of that many cells.
    template <class RangeOf, class IsSeen>
    double error_of_blocks(const scene::TileSummary& tile, int cells_per_block,
                           const RangeOf& range_of, const IsSeen& is_seen) const {
        const glm::ivec2 cells = stream_.tree().cells(tile.id);
        double largest = 0.0;
        for (int row = 0; row * cells_per_block < cells.y; ++row) {
            for (int col = 0; col * cells_per_block < cells.x; ++col) {
                const glm::ivec2 first = glm::ivec2(col, row) * cells_per_block;
                const glm::ivec2 last = glm::min(first + cells_per_block, cells);
                const Box box = builder().bounds(tile.id, first, last, range_of(col, row));
                if (is_seen(box)) {
                    const glm::ivec2 block = first / terrain::cells_per_error_block;
                    const double share = tile.error_shares[static_cast<std::size_t>(
                                             block.y * terrain::error_blocks + block.x)] /
                                         255.0;
                    largest = std::max(largest, error_in(box, share * tile.error));
                }
            }
        }
        return largest;
    }

    [[nodiscard]] double distance_to(const scene::TileSummary& tile) const {
        const Box bounds = transformed(world_from_local_, tile.bounds);
        return glm::distance(camera_.eye, glm::clamp(camera_.eye, bounds.low, bounds.high));
    }

    [[nodiscard]] double pixels_per_metre(double distance) const {
        return pixels_per_metre_ / (is_perspective_ ? std::max(distance, camera_.near) : 1.0);
    }

    const scene::TileStream& stream_;
    const scene::Camera& camera_;
    const glm::dmat4& world_from_local_;
    Frustum frustum_;
    PictureError picture_error_;
    glm::dvec3 eye_{0.0}; // local metres
    double max_error_ = default_error;
    bool is_perspective_ = true;
    double pixels_per_metre_ = 1.0; // in perspective: at a distance of one metre
    std::optional<terrain::HorizonView> horizon_;
};

struct WalkLimits {
    double max_relative_error = 1.0;    // tiles with larger errors are refined
    std::set<terrain::TreeTile> leaves; // not refined: children are missing
    // Whether nearer ground hides tiles. Only without other limits: tiles that stand in for finer
    // ones show ground that is not there.
    bool hides = true;
};

// One walk through the tree, from the eye outwards.
class TreeWalk {
public:
    TreeWalk(const StreamView& view, const WalkLimits& limits, const TileSelectionOptions& options)
        : view_(view), limits_(limits), options_(options),
          nearer_(view.builder(), limits.hides ? view.horizon() : std::nullopt) {}
    TreeWalk(const TreeWalk&) = delete;

    /// Stops and returns false if the drawn tiles do not fit in memory.
    [[nodiscard]] bool walk(const scene::TerrainTile& root) {
        open_.push({view_.along(root.bounds), root.id, root.bounds,
                    std::numeric_limits<double>::infinity(), root.id});
        while (!open_.empty() && leaves_ <= view_.stream().max_drawn()) {
            const Candidate next = open_.top();
            open_.pop();
            visit(next);
        }
        return leaves_ <= view_.stream().max_drawn();
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
            selection_.hidden.push_back(view_.drawn(std::move(tile)));
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
        const double relative_error = view_.relative_error_of(summary);
        const bool is_refined =
            relative_error > limits_.max_relative_error && !limits_.leaves.contains(summary.id);
        const Box box =
            is_refined && !summary.is_proven
                ? view_.builder().bounds(summary.id, range_below(summary, errors_hidden))
                : summary.bounds;
        const bool is_hidden = is_above_hidden || nearer_.hides(box, candidate.along);
        if (is_hidden && !options_.keeps_hidden) {
            leave_out(std::move(known.tile));
            return;
        }
        use_or_request(candidate, known.tile);
        if (is_refined) {
            push_children(candidate, known, std::min(candidate.urgency, relative_error), is_hidden);
        } else {
            add_leaf(candidate, std::move(known.tile), is_hidden);
        }
    }

    void push_children(const Candidate& candidate, const KnownTile& known, double urgency,
                       bool is_hidden) {
        const bool is_foreseen = candidate.is_foreseen || known.tile == nullptr;
        for (const terrain::TreeTile child : view_.stream().tree().children(candidate.id)) {
            const Box expected = view_.child_bounds(known.summary, child, errors_hidden);
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
            selection_.hidden.push_back(view_.drawn(std::move(tile)));
            return;
        }
        ++leaves_;
        if (tile != nullptr && !candidate.is_foreseen) {
            nearer_.add(tile);
            selection_.drawn.push_back(view_.drawn(std::move(tile)));
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

// Refines the largest errors first, as long as all tiles fit that `nearer` does not hide. Depends
// on known tiles only, loaded or not.
Refinement refine_within(std::size_t max_tiles, const StreamView& view,
                         const scene::TerrainTile& root, NearerGround& nearer) {
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
    open.push({view.relative_error_of(root), root});
    while (!open.empty() && open.top().relative_error > 1.0) {
        const Open next = open.top();
        open.pop();
        std::size_t seen = 0;
        for (const terrain::TreeTile child : view.stream().tree().children(next.tile.id)) {
            const Box expected = view.child_bounds(next.tile, child, errors_hidden);
            if (!view.may_see_child(next.tile, child) ||
                nearer.hides(expected, view.along(expected))) {
                continue;
            }
            ++seen;
            if (const auto known = view.known(child)) {
                const double relative_error = view.relative_error_of(known->summary);
                open.push({std::min(next.relative_error, relative_error), known->summary});
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

// If tiles are hidden, others can be finer than `coarse`, which fits with all of them. Requests
// them and draws `coarse` meanwhile.
TileSelection refined_behind(NearerGround& nearer, TileSelection coarse, double coarse_error,
                             const StreamView& view, const scene::TerrainTile& root,
                             const TileSelectionOptions& options) {
    WalkLimits limits;
    limits.max_relative_error =
        refine_within(view.stream().max_drawn(), view, root, nearer).relative_error;
    if (limits.max_relative_error >= coarse_error) {
        return coarse;
    }
    TreeWalk walk(view, limits, options);
    if (!walk.walk(root)) {
        return coarse;
    }
    std::set<terrain::TreeTile> used(coarse.used.begin(), coarse.used.end());
    used.insert(walk.used().begin(), walk.used().end());
    TileSelection finer = std::move(coarse);
    if (walk.missing().empty()) {
        finer = walk.take();
        view.tighten(finer.drawn, walk.nearer());
    }
    finer.requested = by_urgency(walk.missing());
    finer.used.assign(used.begin(), used.end());
    return finer;
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
                refine_within(view.stream().max_drawn(), view, root, nothing).relative_error;
            limits.hides = limits.hides && root.is_proven;
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
            TileSelection selection = walk.take();
            view.tighten(selection.drawn, walk.nearer());
            selection.requested = std::move(*requested);
            selection.used.assign(used.begin(), used.end());
            const double error = limits.max_relative_error;
            return limits.hides && error > 1.0 && selection.requested.empty()
                       ? refined_behind(walk.nearer(), std::move(selection), error, view, root,
                                        options)
                       : selection;
        }
        for (const Candidate& candidate : walk.missing()) {
            limits.leaves.insert(candidate.parent);
        }
        limits.hides = false;
    }
}

} // namespace

TileSelection select_tiles(const scene::TerrainNode& terrain, const scene::Camera& camera,
                           glm::ivec2 size, const glm::dmat4& world_from_local,
                           const TileSelectionOptions& options) {
    check(terrain.stream != nullptr, "a streamed terrain was expected");
    const scene::TileStream& stream = *terrain.stream;
    const auto root = stream.find(stream.tree().root());
    if (root == nullptr) {
        TileSelection selection;
        selection.has_root = false;
        selection.requested.push_back(stream.tree().root());
        return selection;
    }
    const StreamView view(terrain, camera, size, world_from_local);
    return walk_until_complete(view, *root, options);
}

std::size_t tiles_for_bound(const scene::TerrainNode& terrain, const scene::Camera& camera,
                            glm::ivec2 size, const glm::dmat4& world_from_local) {
    check(terrain.stream != nullptr, "a streamed terrain was expected");
    const auto root = terrain.stream->find(terrain.stream->tree().root());
    if (root == nullptr) {
        return 1;
    }
    const StreamView view(terrain, camera, size, world_from_local);
    NearerGround nothing(view.builder(), std::nullopt);
    return refine_within(max_tiles_counted, view, *root, nothing).tiles;
}

} // namespace reljef::view
