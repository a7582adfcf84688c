#include "engine/view/drawn_ground.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <glm/common.hpp>

namespace reljef::view {
namespace {

using terrain::HeightRange;
using terrain::TileTree;

HeightRange joined(const HeightRange& a, const HeightRange& b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

template <class Value, class Add>
void for_each_within(const Grid<Value>& grid, glm::ivec2 low, glm::ivec2 high, const Add& add) {
    const glm::ivec2 last = glm::min(high, glm::ivec2(grid.cols(), grid.rows()) - 1);
    const glm::ivec2 first = glm::min(low, last);
    for (int row = first.y; row <= last.y; ++row) {
        for (int col = first.x; col <= last.x; ++col) {
            add(grid(col, row));
        }
    }
}

// Which of the four tiles below one of a level holds a sample of it.
std::size_t way_below(int level, glm::ivec2 sample) {
    const int side = terrain::tile_cells << (level - 1);
    return static_cast<std::size_t>((sample.x / side) % 2 + 2 * ((sample.y / side) % 2));
}

// Between two places on a tile's vertices, true metres: of the vertices around where these are few,
// else of blocks.
HeightRange range_of(const scene::StreamedTile& tile, glm::dvec2 first, glm::dvec2 end) {
    terrain::MinMax range{std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()};
    const glm::ivec2 low(first);
    const glm::ivec2 high(end);
    if (std::max(high.x - low.x, high.y - low.y) < scene::cells_per_block) {
        for_each_within(tile.heights, low, high + 1, [&](float height) {
            range.low = std::min(range.low, height);
            range.high = std::max(range.high, height);
        });
    } else {
        for_each_within(tile.blocks, low / scene::cells_per_block, high / scene::cells_per_block,
                        [&](const terrain::MinMax& block) {
                            range.low = std::min(range.low, block.low);
                            range.high = std::max(range.high, block.high);
                        });
    }
    return {range.low, range.high};
}

} // namespace

DrawnGround::DrawnGround(const scene::TileBuilder& maker)
    : maker_(&maker), last_(maker.tree().cols() - 1, maker.tree().rows() - 1), branches_(1) {}

void DrawnGround::add(std::shared_ptr<const scene::StreamedTile> tile) {
    const TileTree& tree = maker_->tree();
    const glm::ivec2 first = TileTree::first(tile->id);
    std::size_t at = 0;
    for (int level = tree.root().level; level > tile->id.level; --level) {
        const std::size_t way = way_below(level, first);
        if (branches_[at].below[way] < 0) {
            branches_[at].below[way] = static_cast<int>(branches_.size());
            branches_.emplace_back();
        }
        at = static_cast<std::size_t>(branches_[at].below[way]);
    }
    branches_[at].part = static_cast<int>(parts_.size());
    parts_.push_back({glm::dvec2(first), glm::dvec2(tree.sample(tile->id, tile->cells)),
                      static_cast<double>(TileTree::step(tile->id)), std::move(tile)});
}

glm::dvec2 DrawnGround::sample_of(glm::dvec2 place) const {
    const auto sample =
        maker_->overview().placement().sample_from_world(glm::dvec3(place, 0.0)).value();
    return maker_->tree_sample(maker_->from_overview(glm::dvec2(sample)));
}

std::optional<HeightRange> DrawnGround::range(glm::dvec2 low, glm::dvec2 high) const {
    const glm::dvec2 first = sample_of({low.x, high.y});
    const glm::dvec2 end = sample_of({high.x, low.y});
    if (!(first.x >= 0.0 && first.y >= 0.0 && end.x <= last_.x && end.y <= last_.y)) {
        return std::nullopt;
    }
    const auto range = range_within(first, end);
    const double exaggeration = maker_->overview().placement().exaggeration();
    return range ? std::optional(HeightRange{exaggeration * range->low, exaggeration * range->high})
                 : std::nullopt;
}

// In true metres: of the part where it begins, and of what lies east and south of that.
std::optional<HeightRange> DrawnGround::range_within(glm::dvec2 first, glm::dvec2 end) const {
    const Part* const part = part_at(first);
    if (part == nullptr) {
        return std::nullopt;
    }
    const glm::dvec2 inside = glm::min(end, part->end);
    HeightRange range = range_of(*part->tile, (first - part->first) / part->step,
                                 (inside - part->first) / part->step);
    if (end.x > part->end.x) {
        const auto east = range_within({part->end.x, first.y}, end);
        if (!east) {
            return std::nullopt;
        }
        range = joined(range, *east);
    }
    if (end.y > part->end.y) {
        const auto south = range_within({first.x, part->end.y}, {inside.x, end.y});
        if (!south) {
            return std::nullopt;
        }
        range = joined(range, *south);
    }
    return range;
}

const DrawnGround::Part* DrawnGround::part_at(glm::dvec2 sample) const {
    const glm::ivec2 at(sample);
    int level = maker_->tree().root().level;
    const Branch* branch = &branches_.front();
    while (branch->part < 0) {
        const int below = level > 0 ? branch->below[way_below(level, at)] : -1;
        if (below < 0) {
            return nullptr;
        }
        branch = &branches_[static_cast<std::size_t>(below)];
        --level;
    }
    const Part& part = parts_[static_cast<std::size_t>(branch->part)];
    // Not on the raster's far border, beyond which nothing is.
    return sample.x < part.end.x && sample.y < part.end.y ? &part : nullptr;
}

} // namespace reljef::view
