#include "engine/view/tile_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <set>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "engine/view/horizon_view.h"
#include "engine/view/nearer_ground.h"

namespace reljef::view {
namespace {

// How far beyond a tile's own heights those of the finer ones below it are looked for, an estimate
// (averages are lower than peaks): of its range, and errors of its own. What is left out as hidden
// is looked for farther: a tower where four averages meet stands 16 times as high in the next
// level.
constexpr double more_of_range = 0.25;
constexpr double errors_seen = 1.0;
constexpr double errors_hidden = 16.0;

// Of the error: what is left is for fewer triangles.
constexpr double share_of_tiles = 0.5;

// Errors that what hides may be seen lower, and what is hidden higher, than its tile's heights.
// Where every tile is as fine as it should be a border goes to the vertices of a coarser tile that
// is, too: both of their errors, on either side. Fewer triangles may take all of the error.
constexpr double errors_of_horizon = 2.0 * (share_of_tiles + share_of_tiles) + 1.0;

// Of images where finer ones are to be had, pixels from texel to texel.
constexpr double max_texel = 1.0;

// At a time: what is less urgent may turn out not to be needed once these are there.
constexpr std::size_t max_wanted = 16;

struct Candidate {
    double along = 0.0; // metres from the eye, along the ground
    terrain::TreeTile id;
    Box expected;         // local metres
    double urgency = 0.0; // the least excess of the tiles above
    terrain::TreeTile above;
    bool is_hidden = false;   // the tile above is
    bool is_foreseen = false; // a tile above is not there: only what is known of this one counts

    friend bool operator<(const Candidate& a, const Candidate& b) {
        return a.along != b.along ? a.along > b.along : b.id < a.id;
    }
};

// Where the finer tiles below one are looked for.
terrain::HeightRange range_below(const scene::TileSummary& tile, double errors) {
    const double more = more_of_range * (tile.range.high - tile.range.low) + errors * tile.error;
    return {tile.range.low - more, tile.range.high + more};
}

// A tile that is there, or that was.
struct KnownTile {
    scene::TileSummary summary;
    std::shared_ptr<const scene::StreamedTile> tile; // null: it went
};

// What a view shows of a stream, and how large.
class StreamView {
public:
    StreamView(const scene::TerrainNode& terrain, const scene::Camera& camera, glm::ivec2 size,
               const glm::dmat4& world_from_local)
        : stream_(*terrain.stream), camera_(camera), world_from_local_(world_from_local),
          frustum_(scene::clip_from_world(camera, size)) {
        const bool is_solid = terrain.material.technique.id() == scene::TechniqueId::polygons;
        const double error = scene::error_bound(terrain.material.technique);
        max_error_ = error > 0.0 ? error : default_tile_error;
        is_perspective_ = camera.projection == scene::ProjectionKind::perspective;
        pixels_per_metre_ = is_perspective_
                                ? 0.5 * size.y / std::tan(0.5 * glm::radians(camera.vertical_fov))
                                : size.y / camera.view_height;
        eye_ = glm::dvec3(glm::inverse(world_from_local) * glm::dvec4(camera.eye, 1.0));
        if (is_solid && !terrain.material.wireframe &&
            stream_.maker().overview().placement().kind() == terrain::PlacementKind::plane) {
            horizon_ = horizon_view(camera, size, world_from_local, errors_of_horizon * max_error_);
        }
    }

    [[nodiscard]] const scene::TileStream& stream() const { return stream_; }
    /// Absent where nothing hides anything.
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

    /// Whether those below a tile of this summary may show something of `below`.
    [[nodiscard]] bool may_see_below(const scene::TileSummary& tile,
                                     terrain::TreeTile below) const {
        return may_see(stream_.maker().bounds(below, range_below(tile, errors_seen)));
    }

    /// Metres, to the nearest point of a box along the local ground.
    [[nodiscard]] double along(const Box& local) const {
        const glm::dvec2 eye(eye_);
        return glm::distance(eye, glm::clamp(eye, glm::dvec2(local.low), glm::dvec2(local.high)));
    }

    [[nodiscard]] TileSelection::Drawn
    drawn(std::shared_ptr<const scene::StreamedTile> tile) const {
        const double distance = distance_to(*tile);
        const bool is_whole = tile->id.level == 0 || stream_.maker().has_all_samples(tile->id);
        const double error = is_whole ? 0.0 : tile->error * pixels_per_metre(distance);
        return {std::move(tile), distance, error};
    }

    /// Its error as it is seen, or what its picture lacks, over what may be.
    [[nodiscard]] double screen_space_error_of(const scene::TileSummary& tile) const {
        if (tile.id.level == 0) {
            return 0.0;
        }
        const double pixels = pixels_per_metre(distance_to(tile));
        const double texels = tile.coarse_texel * pixels / max_texel;
        if (stream_.maker().has_all_samples(tile.id)) {
            return texels;
        }
        const double spacing = stream_.maker().spacing(tile.id.level);
        const double errors =
            std::max(tile.error / share_of_tiles, spacing / samples_apart_in_errors) * pixels /
            max_error_;
        return std::max(errors, texels);
    }

private:
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
    glm::dvec3 eye_{0.0}; // local metres
    double max_error_ = default_tile_error;
    bool is_perspective_ = true;
    double pixels_per_metre_ = 1.0; // at a distance of a metre where it is a perspective
    std::optional<terrain::HorizonView> horizon_;
};

// What keeps a walk from the tiles that the view should have.
struct WalkLimits {
    double max_screen_space_error = 1.0; // tiles of no more do not give way
    std::set<terrain::TreeTile> whole;   // nor do these: what is below them is not there
    // Nearer ground hides what is behind it. Only where nothing else keeps tiles from giving way:
    // a border goes to the vertices of the coarsest tile beside it, however far that is off.
    bool hides = true;

    void raise(double screen_space_error) {
        max_screen_space_error = screen_space_error;
        hides = false;
    }
    void keep_whole(terrain::TreeTile tile) {
        whole.insert(tile);
        hides = false;
    }
};

// One walk through the tree, from the eye outwards.
class TreeWalk {
public:
    TreeWalk(const StreamView& view, const WalkLimits& limits, const TileSelectionOptions& options)
        : view_(view), limits_(limits), options_(options),
          nearer_(view.stream().maker(), limits.hides ? view.horizon() : std::nullopt) {}
    TreeWalk(const TreeWalk&) = delete;

    /// False, and not to its end, where memory does not hold what would be drawn.
    [[nodiscard]] bool walk(const scene::StreamedTile& root) {
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
    /// What would be drawn, and what is above it.
    [[nodiscard]] const std::vector<terrain::TreeTile>& used() const { return seen_; }
    TileSelection take() { return std::move(choice_); }

private:
    void visit(const Candidate& candidate) {
        // Whether it is there makes no difference: the choice is the same whatever came before.
        const bool is_hidden =
            candidate.is_hidden || nearer_.hides(candidate.expected, candidate.along);
        auto known = view_.known(candidate.id);
        if (is_hidden && !options_.keeps_hidden) {
            leave_out(known ? std::move(known->tile) : nullptr);
        } else if (!known) {
            miss(candidate);
            ++leaves_;
        } else if (candidate.id.level == 0 && !view_.may_see(known->summary.bounds)) {
            pass_by(candidate, std::move(known->tile));
        } else {
            add(candidate, std::move(*known), is_hidden);
        }
    }

    void leave_out(std::shared_ptr<const scene::StreamedTile> tile) {
        if (tile == nullptr) {
            ++choice_.hidden_unread;
        } else {
            choice_.hidden.push_back(view_.drawn(std::move(tile)));
        }
    }

    void miss(const Candidate& candidate) {
        if (!candidate.is_foreseen) {
            missing_.push_back(candidate);
        }
    }

    // A tile of the finest level that the view does not show. The one under the eye is needed to
    // know what nearer ground hides.
    void pass_by(const Candidate& candidate, std::shared_ptr<const scene::StreamedTile> tile) {
        ++choice_.outside_frustum;
        if (candidate.along > 0.0) {
            return;
        }
        if (tile == nullptr) {
            miss(candidate);
        } else {
            seen_.push_back(tile->id);
            nearer_.add_under_eye(std::move(tile));
        }
    }

    void add(const Candidate& candidate, KnownTile known, bool is_above_hidden) {
        const scene::TileSummary& summary = known.summary;
        const double screen_space_error = view_.screen_space_error_of(summary);
        const bool gives_way = screen_space_error > limits_.max_screen_space_error &&
                               !limits_.whole.contains(summary.id);
        const Box box =
            gives_way
                ? view_.stream().maker().bounds(summary.id, range_below(summary, errors_hidden))
                : summary.bounds;
        const bool is_hidden = is_above_hidden || nearer_.hides(box, candidate.along);
        if (is_hidden && !options_.keeps_hidden) {
            leave_out(std::move(known.tile));
            return;
        }
        if (known.tile == nullptr) {
            miss(candidate);
        } else {
            seen_.push_back(summary.id);
        }
        if (gives_way) {
            push_below(candidate, known, std::min(candidate.urgency, screen_space_error),
                       is_hidden);
        } else {
            add_leaf(candidate, std::move(known.tile), is_hidden);
        }
    }

    void push_below(const Candidate& candidate, const KnownTile& known, double urgency,
                    bool is_hidden) {
        const scene::TileBuilder& maker = view_.stream().maker();
        const bool is_foreseen = candidate.is_foreseen || known.tile == nullptr;
        for (const terrain::TreeTile below : view_.stream().tree().children(candidate.id)) {
            const Box expected = maker.bounds(below, range_below(known.summary, errors_hidden));
            const double along = view_.along(expected);
            if (view_.may_see_below(known.summary, below)) {
                open_.push({along, below, expected, urgency, candidate.id, is_hidden, is_foreseen});
                continue;
            }
            ++choice_.outside_frustum;
            if (along == 0.0 && !is_foreseen) {
                nearer_.add_under_eye(known.tile);
            }
        }
    }

    void add_leaf(const Candidate& candidate, std::shared_ptr<const scene::StreamedTile> tile,
                  bool is_hidden) {
        if (is_hidden && tile != nullptr) {
            choice_.hidden.push_back(view_.drawn(std::move(tile)));
            return;
        }
        ++leaves_;
        if (tile != nullptr && !candidate.is_foreseen) {
            nearer_.add(tile);
            choice_.drawn.push_back(view_.drawn(std::move(tile)));
        }
    }

    const StreamView& view_;
    const WalkLimits& limits_;
    const TileSelectionOptions& options_;
    NearerGround nearer_;
    std::priority_queue<Candidate> open_;
    std::vector<Candidate> missing_;
    std::size_t leaves_ = 0; // that would be drawn if all of them were there
    std::vector<terrain::TreeTile> seen_;
    TileSelection choice_;
};

// The excess above which tiles may give way so that no more are drawn than memory holds: the
// largest excesses first, as far as tiles are known. The same whatever else is known.
double excess_within_memory(const StreamView& view, const scene::StreamedTile& root) {
    struct Open {
        double screen_space_error;
        scene::TileSummary tile;

        bool operator<(const Open& other) const {
            return screen_space_error != other.screen_space_error
                       ? screen_space_error < other.screen_space_error
                       : other.tile.id < tile.id;
        }
    };
    const std::size_t most = view.stream().max_drawn();
    std::size_t leaves = 1;
    std::priority_queue<Open> open;
    open.push({view.screen_space_error_of(root), root});
    while (!open.empty() && open.top().screen_space_error > 1.0) {
        const Open next = open.top();
        open.pop();
        std::size_t seen = 0;
        for (const terrain::TreeTile below : view.stream().tree().children(next.tile.id)) {
            if (!view.may_see_below(next.tile, below)) {
                continue;
            }
            ++seen;
            if (const auto known = view.known(below)) {
                const double screen_space_error = view.screen_space_error_of(known->summary);
                open.push({std::min(next.screen_space_error, screen_space_error), known->summary});
            }
        }
        leaves += std::max<std::size_t>(seen, 1) - 1; // never fewer: the limit is safe
        if (leaves > most) {
            return next.screen_space_error;
        }
    }
    return 1.0;
}

std::vector<terrain::TreeTile> max_urgent(std::vector<Candidate> missing) {
    std::sort(missing.begin(), missing.end(), [](const Candidate& a, const Candidate& b) {
        return a.urgency != b.urgency ? a.urgency > b.urgency : a.id < b.id;
    });
    missing.resize(std::min(missing.size(), max_wanted));
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

// Walks until one finds all that it needs. An end there is: each walk but the last raises the limit
// so far that memory holds all, or keeps a tile whole that gave way, or is the last that hides.
TileSelection chosen(const StreamView& view, const scene::StreamedTile& root,
                     const TileSelectionOptions& options) {
    const scene::TileStream& stream = view.stream();
    WalkLimits limits;
    std::optional<std::vector<terrain::TreeTile>> requested;
    std::set<terrain::TreeTile> used; // by any walk: the next view may be like the first one's
    while (true) {
        TreeWalk walk(view, limits, options);
        if (!walk.walk(root)) {
            limits.raise(excess_within_memory(view, root));
            continue;
        }
        used.insert(walk.used().begin(), walk.used().end());
        if (limits.hides && are_given_up(stream, walk.missing())) {
            limits.hides = false; // for long: what is drawn meanwhile is wanted, too
            continue;
        }
        if (!requested) {
            requested = max_urgent(walk.missing());
        }
        if (walk.missing().empty()) {
            TileSelection choice = walk.take();
            choice.requested = std::move(*requested);
            choice.used.assign(used.begin(), used.end());
            return choice;
        }
        for (const Candidate& candidate : walk.missing()) {
            limits.keep_whole(candidate.above);
        }
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
        TileSelection choice;
        choice.has_root = false;
        choice.requested.push_back(stream.tree().root());
        return choice;
    }
    return chosen(StreamView(terrain, camera, size, world_from_local), *root, options);
}

} // namespace reljef::view
