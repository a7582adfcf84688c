#pragma once

#include <memory>
#include <optional>

#include "engine/core/geometry.h"
#include "engine/terrain/field/horizon.h"
#include "engine/view/drawn_ground.h"

namespace reljef::view {

/// What hides farther tiles of a stream, as far as it is known: the ground that nearer ones show.
class NearerGround {
public:
    /// Nothing hides anything where the view is absent. Precondition: else as DrawnGround.
    NearerGround(const scene::TileBuilder& maker, const std::optional<terrain::HorizonView>& view);
    NearerGround(const NearerGround&) = delete;

    /// A tile that is drawn. Precondition: as DrawnGround::add.
    void add(std::shared_ptr<const scene::StreamedTile> tile) { ground_.add(std::move(tile)); }
    /// A tile that is under the eye, where it is not seen.
    void add_under_eye(std::shared_ptr<const scene::StreamedTile> tile);

    /// As terrain::Horizon::hides; `along`: metres from the eye to the box, along the ground.
    /// Precondition: all that is nearer has been added.
    [[nodiscard]] bool hides(const Box& box, double along);

private:
    [[nodiscard]] std::optional<terrain::HeightRange> range_at_eye(const DrawnGround& ground) const;
    void make_horizon();

    const scene::TileBuilder& maker_;
    std::optional<terrain::HorizonView> view_;
    DrawnGround ground_;
    std::optional<double> under_eye_; // metres; highest
    bool is_looked_for_ = false;
    std::optional<terrain::Horizon> horizon_; // absent: nothing is sure to hide anything
};

} // namespace reljef::view
