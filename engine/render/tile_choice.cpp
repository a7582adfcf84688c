#include "engine/render/tile_choice.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <set>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "engine/render/drawn_ground.h"
#include "engine/render/horizon_view.h"

namespace reljef::render {
namespace {

// How far beyond a tile's own heights those of the finer ones below it are looked for: averages
// are lower than peaks.
constexpr double more_of_range = 0.25;

// Of the error: what is left is for fewer triangles.
constexpr double share_of_tiles = 0.5;

// Of images where finer ones are to be had, pixels from texel to texel.
constexpr double most_texel = 1.0;

// At a time: what is less urgent may turn out not to be needed once these are there.
constexpr std::size_t most_wanted = 16;

struct Candidate {
    double along = 0.0; // metres from the eye, along the ground
    terrain::TreeTile id;
    Box expected;         // local metres
    double urgency = 0.0; // excess of the tile above
    terrain::TreeTile above;

    friend bool operator<(const Candidate& a, const Candidate& b) {
        return a.along != b.along ? a.along > b.along : b.id < a.id;
    }
};

terrain::HeightRange range_below(const scene::StreamedTile& tile) {
    const double more = more_of_range * (tile.range.high - tile.range.low) + tile.error;
    return {tile.range.low - more, tile.range.high + more};
}

// What a view shows of a stream, and how large.
class StreamView {
public:
    StreamView(const scene::TerrainNode& terrain, const scene::Camera& camera, glm::ivec2 size,
               const glm::dmat4& world_from_local)
        : stream_(*terrain.stream), camera_(camera), world_from_local_(world_from_local),
          frustum_(scene::clip_from_world(camera, size)) {
        const bool is_solid = terrain.material.technique.id == scene::TechniqueId::polygons;
        const double error = is_solid ? scene::parameter(terrain.material.technique, "error") : 0.0;
        most_error_ = error > 0.0 ? error : default_tile_error;
        is_perspective_ = camera.projection == scene::ProjectionKind::perspective;
        pixels_per_metre_ = is_perspective_
                                ? 0.5 * size.y / std::tan(0.5 * glm::radians(camera.vertical_fov))
                                : size.y / camera.view_height;
        eye_ = glm::dvec3(glm::inverse(world_from_local) * glm::dvec4(camera.eye, 1.0));
        if (is_solid && !terrain.material.wireframe &&
            stream_.maker().overview().placement().kind() == terrain::PlacementKind::plane) {
            horizon_ =
                horizon_view(camera, size, world_from_local, (1.0 + share_of_tiles) * most_error_);
        }
    }

    [[nodiscard]] const scene::TileStream& stream() const { return stream_; }
    /// Absent where nothing hides anything.
    [[nodiscard]] const std::optional<terrain::HorizonView>& horizon() const { return horizon_; }

    [[nodiscard]] bool may_see(const Box& local) const {
        return frustum_.may_see(transformed(world_from_local_, local));
    }

    /// Metres, to the nearest point of a box along the local ground.
    [[nodiscard]] double along(const Box& local) const {
        const glm::dvec2 eye(eye_);
        return glm::distance(eye, glm::clamp(eye, glm::dvec2(local.low), glm::dvec2(local.high)));
    }

    [[nodiscard]] TileChoice::Drawn drawn(std::shared_ptr<const scene::StreamedTile> tile) const {
        const double distance = distance_to(*tile);
        const bool is_whole = tile->id.level == 0 || stream_.maker().has_all_samples(tile->id);
        const double error = is_whole ? 0.0 : tile->error * pixels_per_metre(distance);
        return {std::move(tile), distance, error};
    }

    /// Its error as it is seen, or what its picture lacks, over what may be.
    [[nodiscard]] double excess_of(const scene::StreamedTile& tile) const {
        if (tile.id.level == 0) {
            return 0.0;
        }
        const double pixels = pixels_per_metre(distance_to(tile));
        const double texels = tile.coarse_texel * pixels / most_texel;
        if (stream_.maker().has_all_samples(tile.id)) {
            return texels;
        }
        const double spacing = stream_.maker().spacing(tile.id.level);
        const double errors =
            std::max(tile.error / share_of_tiles, spacing / samples_apart_in_errors) * pixels /
            most_error_;
        return std::max(errors, texels);
    }

    /// Whether a tile's vertices are as near to the ground as they should be.
    [[nodiscard]] bool is_true(const TileChoice::Drawn& drawn) const {
        return drawn.error <= share_of_tiles * most_error_;
    }

private:
    [[nodiscard]] double distance_to(const scene::StreamedTile& tile) const {
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
    double most_error_ = default_tile_error;
    bool is_perspective_ = true;
    double pixels_per_metre_ = 1.0; // at a distance of a metre where it is a perspective
    std::optional<terrain::HorizonView> horizon_;
};

// What hides farther tiles of a stream, as far as it is known.
class NearerGround {
public:
    explicit NearerGround(const StreamView& view) : view_(view), ground_(view.stream().maker()) {}

    void add(std::shared_ptr<const scene::StreamedTile> tile) { ground_.add(std::move(tile)); }

    /// A tile that is under the eye, where it is not seen.
    void add_under_eye(std::shared_ptr<const scene::StreamedTile> tile) {
        if (view_.horizon()) {
            const double more = all_finer * tile->error;
            DrawnGround ground(view_.stream().maker());
            ground.add(std::move(tile));
            if (const auto range = range_at_eye(ground)) {
                under_eye_ = range->high + more;
            }
        }
    }

    /// Precondition: all that is nearer than `along` has been added.
    bool hides(const Box& box, double along) {
        if (!is_looked_for_ && view_.horizon() && along > view_.horizon()->near) {
            make_horizon();
        }
        return horizon_ && horizon_->hides(box);
    }

private:
    // Of the error of a level: what all finer ones move the ground by together.
    static constexpr double all_finer = 2.0;
    // Four times as coarse as that of a whole terrain: a view is chosen for again and again, and
    // hardly more is drawn.
    static constexpr int sectors = 128;
    static constexpr double stretch_growth = 1.0 + 1.0 / 8.0;

    [[nodiscard]] std::optional<terrain::HeightRange>
    range_at_eye(const DrawnGround& ground) const {
        const glm::dvec2 eye(view_.horizon()->eye);
        return ground.range(eye - view_.horizon()->near, eye + view_.horizon()->near);
    }

    void make_horizon() {
        is_looked_for_ = true;
        const auto drawn = range_at_eye(ground_);
        const std::optional<double> highest = drawn ? std::optional(drawn->high) : under_eye_;
        if (!highest || !(view_.horizon()->eye.z - view_.horizon()->near > *highest)) {
            return;
        }
        const terrain::Heightfield& overview = view_.stream().maker().overview().heightfield();
        const glm::dvec2 samples(overview.heights.cols(), overview.heights.rows());
        const auto ground = [this](glm::dvec2 low, glm::dvec2 high) {
            return ground_.range(low, high);
        };
        horizon_.emplace(ground,
                         terrain::HorizonReach{view_.stream().maker().spacing(0),
                                               glm::length(samples * overview.spacing), sectors,
                                               stretch_growth},
                         *view_.horizon());
    }

    const StreamView& view_;
    DrawnGround ground_;
    std::optional<double> under_eye_; // metres; highest
    bool is_looked_for_ = false;
    std::optional<terrain::Horizon> horizon_; // absent: nothing is sure to hide anything
};

// One walk through the tree, from the eye outwards.
class TreeWalk {
public:
    /// Tiles of no more than `most_excess`, and those in `whole`, do not give way.
    TreeWalk(const StreamView& view, double most_excess, const std::set<terrain::TreeTile>& whole)
        : view_(view), most_excess_(most_excess), whole_(whole), nearer_(view) {}
    TreeWalk(const TreeWalk&) = delete;

    void walk(const scene::StreamedTile& root) {
        open_.push({view_.along(root.bounds), root.id, root.bounds, 0.0, root.id});
        while (!open_.empty()) {
            const Candidate next = open_.top();
            open_.pop();
            visit(next);
        }
    }

    [[nodiscard]] const std::vector<Candidate>& missing() const { return missing_; }
    [[nodiscard]] std::size_t count() const { return choice_.drawn.size() + missing_.size(); }
    /// Of the tiles that gave way.
    [[nodiscard]] std::vector<double>& excesses() { return excesses_; }
    /// What is drawn and what is over it.
    [[nodiscard]] const std::vector<terrain::TreeTile>& seen() const { return seen_; }
    TileChoice take() { return std::move(choice_); }

private:
    void visit(const Candidate& candidate) {
        // Whether it is there makes no difference: the choice is the same whatever came before.
        const bool is_expected_hidden = nearer_.hides(candidate.expected, candidate.along);
        auto tile = view_.stream().peek(candidate.id);
        if (is_expected_hidden && tile == nullptr) {
            ++choice_.hidden_unread;
        } else if (is_expected_hidden) {
            choice_.hidden.push_back(view_.drawn(std::move(tile)));
        } else if (tile == nullptr) {
            missing_.push_back(candidate);
        } else if (tile->id.level == 0 && !view_.may_see(tile->bounds)) {
            note_outside(tile, candidate.along);
        } else {
            add(std::move(tile), candidate.along);
        }
    }

    void add(std::shared_ptr<const scene::StreamedTile> tile, double along) {
        const double excess = view_.excess_of(*tile);
        const bool gives_way = excess > most_excess_ && !whole_.contains(tile->id);
        const Box box =
            gives_way ? view_.stream().maker().bounds(tile->id, range_below(*tile)) : tile->bounds;
        if (nearer_.hides(box, along)) {
            choice_.hidden.push_back(view_.drawn(std::move(tile)));
        } else if (gives_way) {
            excesses_.push_back(excess);
            seen_.push_back(tile->id);
            push_below(tile, excess);
        } else {
            seen_.push_back(tile->id);
            choice_.drawn.push_back(view_.drawn(std::move(tile)));
            if (view_.is_true(choice_.drawn.back())) {
                nearer_.add(choice_.drawn.back().tile);
            }
        }
    }

    void push_below(const std::shared_ptr<const scene::StreamedTile>& tile, double excess) {
        const scene::TileStream& stream = view_.stream();
        for (const terrain::TreeTile below : stream.tree().children(tile->id)) {
            const Box expected = stream.maker().bounds(below, range_below(*tile));
            const double along = view_.along(expected);
            if (view_.may_see(expected)) {
                open_.push({along, below, expected, excess, tile->id});
            } else {
                note_outside(tile, along);
            }
        }
    }

    // What is not seen, of the tile or of one below it.
    void note_outside(const std::shared_ptr<const scene::StreamedTile>& tile, double along) {
        ++choice_.outside_frustum;
        if (along == 0.0) {
            nearer_.add_under_eye(tile);
        }
    }

    const StreamView& view_;
    double most_excess_;
    const std::set<terrain::TreeTile>& whole_;
    NearerGround nearer_;
    std::priority_queue<Candidate> open_;
    std::vector<Candidate> missing_;
    std::vector<double> excesses_;
    std::vector<terrain::TreeTile> seen_;
    TileChoice choice_;
};

// The limit that so many fewer tiles are drawn with, or somewhat more: of one that stays whole
// there are at most three fewer.
double raised_limit(std::vector<double>& excesses, std::size_t fewer) {
    const std::size_t stay = std::min((fewer + 2) / 3, excesses.size());
    const auto last = excesses.begin() + static_cast<std::ptrdiff_t>(stay) - 1;
    std::nth_element(excesses.begin(), last, excesses.end());
    return *last;
}

std::vector<terrain::TreeTile> most_urgent(std::vector<Candidate> missing) {
    std::sort(missing.begin(), missing.end(), [](const Candidate& a, const Candidate& b) {
        return a.urgency != b.urgency ? a.urgency > b.urgency : a.id < b.id;
    });
    missing.resize(std::min(missing.size(), most_wanted));
    std::vector<terrain::TreeTile> wanted;
    wanted.reserve(missing.size());
    for (const Candidate& candidate : missing) {
        wanted.push_back(candidate.id);
    }
    return wanted;
}

} // namespace

TileChoice choose_tiles(const scene::TerrainNode& terrain, const scene::Camera& camera,
                        glm::ivec2 size, const glm::dmat4& world_from_local) {
    check(terrain.stream != nullptr, "a streamed terrain was expected");
    const scene::TileStream& stream = *terrain.stream;
    const auto root = stream.find(stream.tree().root());
    if (root == nullptr) {
        TileChoice choice;
        choice.wanted.push_back(stream.tree().root());
        return choice;
    }
    const StreamView view(terrain, camera, size, world_from_local);
    double most_excess = 1.0;
    std::set<terrain::TreeTile> whole; // as what is below them is not there
    std::optional<std::vector<terrain::TreeTile>> wanted;
    while (true) {
        TreeWalk walk(view, most_excess, whole);
        walk.walk(*root);
        if (walk.count() > stream.most_drawn()) {
            most_excess = raised_limit(walk.excesses(), walk.count() - stream.most_drawn());
            continue;
        }
        if (!wanted) {
            wanted = most_urgent(walk.missing());
        }
        if (walk.missing().empty()) {
            for (const terrain::TreeTile tile : walk.seen()) {
                static_cast<void>(stream.find(tile));
            }
            TileChoice choice = walk.take();
            choice.wanted = std::move(*wanted);
            return choice;
        }
        for (const Candidate& candidate : walk.missing()) {
            whole.insert(candidate.above);
        }
    }
}

std::vector<terrain::TreeTile> wanted_tiles(const scene::Scene& scene,
                                            const scene::TileStream& stream,
                                            std::span<const scene::Camera> cameras,
                                            glm::ivec2 size) {
    std::vector<terrain::TreeTile> wanted;
    std::set<terrain::TreeTile> known;
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4& transform) {
        const auto* terrain = node.get<scene::TerrainNode>();
        if (terrain == nullptr || terrain->stream.get() != &stream) {
            return;
        }
        for (const scene::Camera& camera : cameras) {
            const TileChoice choice = choose_tiles(*terrain, camera, size, transform);
            for (const terrain::TreeTile tile : choice.wanted) {
                if (known.insert(tile).second) {
                    wanted.push_back(tile);
                }
            }
        }
    });
    return wanted;
}

} // namespace reljef::render
