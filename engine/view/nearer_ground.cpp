#include "engine/view/nearer_ground.h"

#include <algorithm>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::view {
namespace {

using terrain::HeightRange;
using terrain::TileTree;

HeightRange joined(const HeightRange& a, const HeightRange& b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

HeightRange as_range(float height) {
    return {height, height};
}

HeightRange as_range(const terrain::MinMax& block) {
    return {block.low, block.high};
}

template <class Value>
HeightRange range_in(const Grid<Value>& grid, glm::ivec2 low, glm::ivec2 high) {
    const glm::ivec2 last = glm::min(high, glm::ivec2(grid.cols(), grid.rows()) - 1);
    const glm::ivec2 first = glm::min(low, last);
    HeightRange range = as_range(grid(first.x, first.y));
    for (int row = first.y; row <= last.y; ++row) {
        for (int col = first.x; col <= last.x; ++col) {
            range = joined(range, as_range(grid(col, row)));
        }
    }
    return range;
}

// Which of the four children of a tile of a level holds a sample of the tile.
std::size_t child_of(int level, glm::ivec2 sample) {
    const int side = terrain::tree_tile_cells << (level - 1);
    return static_cast<std::size_t>((sample.x / side) % 2 + 2 * ((sample.y / side) % 2));
}

// True metres between two places on a tile's vertices: of the surface or the vertices if these are
// few, otherwise of the blocks.
HeightRange range_of(const scene::TerrainTile& tile, glm::dvec2 first, glm::dvec2 end) {
    const glm::ivec2 low(first);
    const glm::ivec2 high(end);
    if (std::max(high.x - low.x, high.y - low.y) <= 1) {
        return terrain::surface_range(tile.heightfield.heights.view(), first, end);
    }
    constexpr int side = scene::cells_per_block;
    return std::max(high.x - low.x, high.y - low.y) < side
               ? range_in(tile.heightfield.heights, low, high + 1)
               : range_in(tile.blocks, low / side, high / side);
}

// All finer levels together move the ground by this many errors of a level.
constexpr double all_finer = 2.0;

// Coarser than for a whole terrain: selection runs often, and hardly more is drawn.
constexpr int sectors_of_tiles = 128;
constexpr double stretch_growth_of_tiles = 1.0 + 1.0 / 8.0;

} // namespace

DrawnGround::DrawnGround(const scene::TileBuilder& builder)
    : builder_(&builder), last_(builder.tree().cols() - 1, builder.tree().rows() - 1),
      branches_(1) {}

void DrawnGround::add(std::shared_ptr<const scene::TerrainTile> tile) {
    const TileTree& tree = builder_->tree();
    const glm::ivec2 first = TileTree::first(tile->id);
    std::size_t at = 0;
    for (int level = tree.root().level; level > tile->id.level; --level) {
        const std::size_t child = child_of(level, first);
        if (branches_[at].children[child] < 0) {
            branches_[at].children[child] = static_cast<int>(branches_.size());
            branches_.emplace_back();
        }
        at = static_cast<std::size_t>(branches_[at].children[child]);
    }
    branches_[at].part = static_cast<int>(parts_.size());
    parts_.push_back({glm::dvec2(first), glm::dvec2(tree.sample(tile->id, tile->cells)),
                      static_cast<double>(TileTree::step(tile->id)), std::move(tile)});
}

std::optional<HeightRange> DrawnGround::range(const terrain::SampleRectangle& samples) const {
    const auto tree_sample = [&](glm::dvec2 sample) {
        return builder_->tree_sample(builder_->from_overview(sample));
    };
    const glm::dvec2 first = tree_sample(samples.first);
    const glm::dvec2 end = tree_sample(samples.last);
    if (!(first.x >= 0.0 && first.y >= 0.0 && end.x <= last_.x && end.y <= last_.y)) {
        return std::nullopt;
    }
    const auto range = range_within(first, end);
    const double exaggeration = builder_->overview().placement().exaggeration();
    return range ? std::optional(HeightRange{exaggeration * range->low, exaggeration * range->high})
                 : std::nullopt;
}

// True metres: the part at `first`, and recursively what lies east and south of it.
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
    int level = builder_->tree().root().level;
    const Branch* branch = &branches_.front();
    while (branch->part < 0) {
        const int child = level > 0 ? branch->children[child_of(level, at)] : -1;
        if (child < 0) {
            return nullptr;
        }
        branch = &branches_[static_cast<std::size_t>(child)];
        --level;
    }
    const Part& part = parts_[static_cast<std::size_t>(branch->part)];
    // Nothing lies beyond the raster's far border.
    return sample.x < part.end.x && sample.y < part.end.y ? &part : nullptr;
}

NearerGround::NearerGround(const scene::TileBuilder& builder,
                           const std::optional<terrain::HorizonView>& view,
                           const std::optional<terrain::EarthHorizon>& earth)
    : builder_(builder), view_(view), earth_(earth), ground_(builder) {}

NearerGround::NearerGround(const NearerGround& coarser, int resolution)
    : builder_(coarser.builder_), view_(coarser.view_), earth_(coarser.earth_),
      resolution_(resolution * coarser.resolution_), ground_(coarser.ground_),
      under_eye_(coarser.under_eye_) {}

void NearerGround::add_under_eye(std::shared_ptr<const scene::TerrainTile> tile) {
    if (view_ && tile != nullptr) {
        const double more = all_finer * tile->error;
        DrawnGround ground(builder_);
        ground.add(std::move(tile));
        if (const auto range = range_at_eye(ground)) {
            under_eye_ = range->high + more;
        }
    }
}

bool NearerGround::hides(const Box& box, double along) {
    if (earth_ && earth_->hides(box)) {
        return true;
    }
    if (!was_made_ && view_ && along > view_->near) {
        make_horizon();
    }
    return horizon_ && horizon_->hides(box);
}

std::optional<terrain::HeightRange> NearerGround::range_at_eye(const DrawnGround& ground) const {
    const auto frame = terrain::EyeFrame::create(builder_.overview().placement(), view_->eye);
    const auto samples = frame ? frame->samples_around(view_->near) : std::nullopt;
    return samples ? ground.range(*samples) : std::nullopt;
}

void NearerGround::make_horizon() {
    was_made_ = true;
    const auto drawn = range_at_eye(ground_);
    const std::optional<double> highest = drawn ? std::optional(drawn->high) : under_eye_;
    if (!highest) {
        return;
    }
    const terrain::Placement& placement = builder_.overview().placement();
    const terrain::Heightfield& overview = builder_.overview().heightfield();
    const terrain::MinMax range = builder_.overview().pyramid().total();
    const glm::dvec2 samples(overview.heights.cols(), overview.heights.rows());
    const double exaggeration = placement.exaggeration();
    horizon_ = terrain::Horizon::create(
        placement,
        [this](const terrain::SampleRectangle& rectangle) { return ground_.range(rectangle); },
        {*highest, *highest},
        {.first = builder_.spacing(0),
         .last = glm::length(samples * overview.spacing),
         .sectors = resolution_ * sectors_of_tiles,
         .growth = 1.0 + (stretch_growth_of_tiles - 1.0) / resolution_,
         // The overview has averages: peaks are higher.
         .heights = {exaggeration * (2.0 * range.low - range.high),
                     exaggeration * (2.0 * range.high - range.low)},
         .last_sample = samples - 1.0},
        *view_);
}

} // namespace reljef::view
