#include "engine/view/nearer_ground.h"

#include <utility>

#include <glm/geometric.hpp>

namespace reljef::view {
namespace {

// Of the error of a level: what all finer ones move the ground by together.
constexpr double all_finer = 2.0;

// Four times as coarse as that of a whole terrain: a view is chosen for again and again, and hardly
// more is drawn.
constexpr int sectors_of_tiles = 128;
constexpr double stretch_growth_of_tiles = 1.0 + 1.0 / 8.0;

} // namespace

NearerGround::NearerGround(const scene::TileBuilder& maker,
                           const std::optional<terrain::HorizonView>& view)
    : maker_(maker), view_(view), ground_(maker) {}

void NearerGround::add_under_eye(std::shared_ptr<const scene::StreamedTile> tile) {
    if (view_) {
        const double more = all_finer * tile->error;
        DrawnGround ground(maker_);
        ground.add(std::move(tile));
        if (const auto range = range_at_eye(ground)) {
            under_eye_ = range->high + more;
        }
    }
}

bool NearerGround::hides(const Box& box, double along) {
    if (!is_looked_for_ && view_ && along > view_->near) {
        make_horizon();
    }
    return horizon_ && horizon_->hides(box);
}

std::optional<terrain::HeightRange> NearerGround::range_at_eye(const DrawnGround& ground) const {
    const glm::dvec2 eye(view_->eye);
    return ground.range(eye - view_->near, eye + view_->near);
}

void NearerGround::make_horizon() {
    is_looked_for_ = true;
    const auto drawn = range_at_eye(ground_);
    const std::optional<double> highest = drawn ? std::optional(drawn->high) : under_eye_;
    if (!highest || !(view_->eye.z - view_->near > *highest)) {
        return;
    }
    const terrain::Heightfield& overview = maker_.overview().heightfield();
    const glm::dvec2 samples(overview.heights.cols(), overview.heights.rows());
    const auto ground = [this](glm::dvec2 low, glm::dvec2 high) {
        return ground_.range(low, high);
    };
    horizon_.emplace(ground,
                     terrain::HorizonReach{maker_.spacing(0),
                                           glm::length(samples * overview.spacing),
                                           sectors_of_tiles, stretch_growth_of_tiles},
                     *view_);
}

} // namespace reljef::view
