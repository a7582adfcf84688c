#include "engine/render/tile_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <set>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

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
    double excess = 0.0; // the error as it is seen, over the one that may be
    double distance = 0.0;
    double error = 0.0; // pixels, of the vertices
    std::shared_ptr<const scene::StreamedTile> tile;

    friend bool operator<(const Candidate& a, const Candidate& b) {
        return a.excess != b.excess ? a.excess < b.excess : b.tile->id < a.tile->id;
    }
};

terrain::HeightRange range_below(const scene::StreamedTile& tile) {
    const double more = more_of_range * (tile.range.high - tile.range.low) + tile.error;
    return {tile.range.low - more, tile.range.high + more};
}

class Chooser {
public:
    Chooser(const scene::TerrainNode& terrain, const scene::Camera& camera, glm::ivec2 size,
            const glm::dmat4& world_from_local)
        : stream_(*terrain.stream), camera_(camera), world_from_local_(world_from_local),
          frustum_(scene::clip_from_world(camera, size)) {
        const double error = terrain.material.technique.id == scene::TechniqueId::polygons
                                 ? scene::parameter(terrain.material.technique, "error")
                                 : 0.0;
        most_error_ = error > 0.0 ? error : default_tile_error;
        perspective_ = camera.projection == scene::ProjectionKind::perspective;
        pixels_per_metre_ = perspective_
                                ? 0.5 * size.y / std::tan(0.5 * glm::radians(camera.vertical_fov))
                                : size.y / camera.view_height;
    }

    TileChoice choose() && {
        push(stream_.tree().root());
        while (!candidates_.empty()) {
            const Candidate next = candidates_.top();
            candidates_.pop();
            if (next.excess <= 1.0 || !replace(next)) {
                choice_.drawn.push_back({next.tile, next.distance, next.error});
            }
        }
        return std::move(choice_);
    }

private:
    void push(terrain::TreeTile id) {
        auto tile = stream_.find(id);
        if (tile == nullptr) {
            choice_.wanted.push_back(id);
            return;
        }
        const Box bounds = transformed(world_from_local_, tile->bounds);
        if (id.level == 0 && !frustum_.may_see(bounds)) {
            ++choice_.outside_frustum;
            return;
        }
        const double distance =
            glm::distance(camera_.eye, glm::clamp(camera_.eye, bounds.low, bounds.high));
        const double pixels = pixels_per_metre(distance);
        const double excess = excess_of(*tile, pixels);
        const bool is_whole = id.level == 0 || stream_.maker().has_all_samples(id);
        const double error = is_whole ? 0.0 : tile->error * pixels;
        candidates_.push({excess, distance, error, std::move(tile)});
    }

    [[nodiscard]] double pixels_per_metre(double distance) const {
        return pixels_per_metre_ / (perspective_ ? std::max(distance, camera_.near) : 1.0);
    }

    [[nodiscard]] double excess_of(const scene::StreamedTile& tile, double pixels) const {
        if (tile.id.level == 0) {
            return 0.0;
        }
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

    // Whether the tiles below take a tile's place; else they are wanted, where they may be drawn.
    bool replace(const Candidate& candidate) {
        std::vector<terrain::TreeTile> below = stream_.tree().children(candidate.tile->id);
        std::erase_if(below, [&](terrain::TreeTile tile) { return !may_see(tile, candidate); });
        const std::size_t now = candidates_.size() + choice_.drawn.size() + choice_.wanted.size();
        if (now + below.size() > stream_.most_drawn()) {
            return false;
        }
        const std::size_t before = choice_.wanted.size();
        bool all_there = true;
        for (const terrain::TreeTile tile : below) {
            const bool is_there = stream_.find(tile) != nullptr;
            all_there = all_there && is_there;
            if (!is_there && before < most_wanted) {
                choice_.wanted.push_back(tile);
            }
        }
        if (!all_there) {
            return false;
        }
        for (const terrain::TreeTile tile : below) {
            push(tile);
        }
        return true;
    }

    bool may_see(terrain::TreeTile tile, const Candidate& above) {
        const Box bounds = stream_.maker().bounds(tile, range_below(*above.tile));
        const bool seen = frustum_.may_see(transformed(world_from_local_, bounds));
        choice_.outside_frustum += seen ? 0 : 1;
        return seen;
    }

    const scene::TileStream& stream_;
    const scene::Camera& camera_;
    const glm::dmat4& world_from_local_;
    Frustum frustum_;
    double most_error_ = default_tile_error;
    bool perspective_ = true;
    double pixels_per_metre_ = 1.0; // at a distance of a metre where it is a perspective
    std::priority_queue<Candidate> candidates_;
    TileChoice choice_;
};

} // namespace

TileChoice choose_tiles(const scene::TerrainNode& terrain, const scene::Camera& camera,
                        glm::ivec2 size, const glm::dmat4& world_from_local) {
    check(terrain.stream != nullptr, "a streamed terrain was expected");
    return Chooser(terrain, camera, size, world_from_local).choose();
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
