#include "engine/terrain/field/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace reljef::terrain {

Result<Placement> Placement::create(const Heightfield& heightfield, PlacementKind kind,
                                    double exaggeration) {
    const Grid<float>& heights = heightfield.heights;
    check(!heights.empty(), "placement of an empty heightfield");
    if (!(exaggeration > 0.0 && exaggeration <= max_exaggeration)) {
        return Error{fmt::format("exaggeration {}: a number above 0 and at most {} was expected",
                                 exaggeration, max_exaggeration)};
    }
    if (kind == PlacementKind::ellipsoid && !heightfield.georeference) {
        return Error{
            "placement ellipsoid: the terrain names no place on Earth, a georeferenced one "
            "or placement plane was expected"};
    }
    const double spacing = std::min(heightfield.spacing.x, heightfield.spacing.y);
    if (kind == PlacementKind::ellipsoid && spacing < min_spacing_on_ellipsoid) {
        return Error{fmt::format("placement ellipsoid: samples {} m apart found, at least {} m or "
                                 "placement plane was expected",
                                 spacing, min_spacing_on_ellipsoid)};
    }
    Placement placement;
    placement.last_ = glm::dvec2(heights.cols() - 1, heights.rows() - 1);
    placement.middle_ = 0.5 * placement.last_ + heightfield.to_middle;
    placement.spacing_ = heightfield.spacing;
    placement.exaggeration_ = exaggeration;
    if (heightfield.georeference) {
        placement.geodetic_ =
            std::make_shared<const geo::GeodeticMap>(heightfield.georeference->geodetic);
    }
    if (kind == PlacementKind::ellipsoid) {
        const glm::dvec2 origin = placement.geodetic_->latitude_longitude(placement.middle_);
        placement.geoid_ = heightfield.georeference->geoid;
        placement.frame_ =
            geo::LocalFrame({origin.x, origin.y, placement.zero_at({origin.x, origin.y})});
        placement.zero_range_ = placement.find_zero_range();
    }
    return placement;
}

Placement Placement::of_tile(const Reduction& reduction, const TileLattice& tile) const {
    check(!tile_, "the placement of an overview was expected");
    Placement placement = *this;
    placement.tile_ = TilePlace{reduction, tile};
    return placement;
}

double Placement::zero_at(glm::dvec2 latitude_longitude) const {
    if (!geoid_) {
        return 0.0;
    }
    const double latitude = std::clamp(latitude_longitude.x, -90.0, 90.0);
    const double above = geoid_->undulation(latitude, latitude_longitude.y);
    return std::isnan(above) ? 0.0 : above;
}

Placement Placement::without_geoid() const {
    Placement placement = *this;
    placement.geoid_.reset();
    placement.zero_range_ = {};
    return placement;
}

double Placement::zero_at_sample(glm::dvec2 sample) const {
    return zero_at(geodetic_->latitude_longitude(placed(sample)));
}

// Of a lattice over the terrain. Between its places the geoid differs by no more than they do.
HeightRange Placement::find_zero_range() const {
    if (!geoid_) {
        return {};
    }
    constexpr int parts = 32;
    Grid<double> zeros(parts + 1, parts + 1);
    HeightRange range{std::numeric_limits<double>::infinity(),
                      -std::numeric_limits<double>::infinity()};
    double step = 0.0;
    for (int row = 0; row <= parts; ++row) {
        for (int col = 0; col <= parts; ++col) {
            const glm::dvec2 part = glm::dvec2(col, row) / static_cast<double>(parts);
            const double zero = zero_at(geodetic_->latitude_longitude(last_ * part));
            zeros(col, row) = zero;
            range = {std::min(range.low, zero), std::max(range.high, zero)};
            step = std::max({step, std::abs(zero - zeros.clamped(col - 1, row)),
                             std::abs(zero - zeros.clamped(col, row - 1))});
        }
    }
    return {range.low - step, range.high + step};
}

std::optional<geo::DegreeGrid> Placement::degree_grid() const {
    return frame_ && !geoid_ && !tile_ ? geodetic_->degree_grid() : std::nullopt;
}

std::optional<glm::dvec2> Placement::latitudes_all_around() const {
    if (!geodetic_ || !geodetic_->rows().wrap().around) {
        return std::nullopt;
    }
    return glm::dvec2(geodetic_->latitude_longitude(last_).x,
                      geodetic_->latitude_longitude({0.0, 0.0}).x);
}

std::optional<double> Placement::columns_all_around() const {
    if (!geodetic_ || !geodetic_->rows().wrap().around) {
        return std::nullopt;
    }
    return from_placed({last_.x, 0.0}).x - from_placed({0.0, 0.0}).x;
}

glm::dvec3 Placement::world_from_sample(glm::dvec3 sample) const {
    const glm::dvec2 place = placed(glm::dvec2(sample));
    if (!frame_) {
        return {(place.x - middle_.x) * spacing_.x, (middle_.y - place.y) * spacing_.y,
                sample.z * exaggeration_};
    }
    const glm::dvec2 position = geodetic_->latitude_longitude(place);
    return frame_->local_from_geodetic(
        {position.x, position.y, zero_at(position) + sample.z * exaggeration_});
}

std::optional<glm::dvec3> Placement::sample_from_world(glm::dvec3 world) const {
    if (!frame_) {
        const glm::dvec2 place(middle_.x + world.x / spacing_.x, middle_.y - world.y / spacing_.y);
        return glm::dvec3(from_placed(place), world.z / exaggeration_);
    }
    const geo::Geodetic position = frame_->geodetic_from_local(world);
    const Result<glm::dvec2> sample = geodetic_->sample(position.latitude, position.longitude);
    if (!sample) {
        return std::nullopt;
    }
    const double zero = zero_at({position.latitude, position.longitude});
    return glm::dvec3(from_placed(*sample), (position.height - zero) / exaggeration_);
}

glm::dvec3 Placement::up(glm::dvec3 world) const {
    if (!frame_) {
        return {0.0, 0.0, 1.0};
    }
    const geo::Geodetic position = frame_->geodetic_from_local(world);
    return frame_->local_direction(
        geo::normal_from_geodetic(position.latitude, position.longitude));
}

glm::dvec3 Placement::north(glm::dvec3 world) const {
    const auto position = geodetic_from_world(world);
    if (!position) {
        return {0.0, 1.0, 0.0};
    }
    if (frame_) {
        return frame_->local_direction(
            geo::north_from_geodetic(position->latitude, position->longitude));
    }
    constexpr double step = 1e-5; // degrees, away from the nearer pole
    const double toward = position->latitude > 0.0 ? -step : step;
    const auto beside =
        world_from_geodetic({position->latitude + toward, position->longitude, position->height});
    const glm::dvec3 way = beside ? (*beside - world) / toward : glm::dvec3(0.0);
    const double length = std::hypot(way.x, way.y);
    return length > 0.0 ? glm::dvec3(way.x / length, way.y / length, 0.0)
                        : glm::dvec3(0.0, 1.0, 0.0);
}

std::optional<geo::Geodetic> Placement::geodetic_from_world(glm::dvec3 world) const {
    if (!geodetic_) {
        return std::nullopt;
    }
    if (frame_) {
        geo::Geodetic position = frame_->geodetic_from_local(world);
        const double zero = zero_at({position.latitude, position.longitude});
        position.height = (position.height - zero) / exaggeration_;
        return position;
    }
    const std::optional<glm::dvec3> sample = sample_from_world(world);
    const glm::dvec2 place = placed(glm::dvec2(*sample));
    const glm::dvec2 position = geodetic_->latitude_longitude(place);
    if (geodetic_->is_past_pole(place) || std::isnan(position.x) || !std::isfinite(position.y)) {
        return std::nullopt;
    }
    return geo::Geodetic{position.x, position.y, sample->z};
}

std::optional<glm::dvec3> Placement::world_from_geodetic(geo::Geodetic position) const {
    if (!geodetic_) {
        return std::nullopt;
    }
    if (frame_) {
        position.height =
            zero_at({position.latitude, position.longitude}) + position.height * exaggeration_;
        return frame_->local_from_geodetic(position);
    }
    const Result<glm::dvec2> sample = geodetic_->sample(position.latitude, position.longitude);
    if (!sample) {
        return std::nullopt;
    }
    return world_from_sample(glm::dvec3(from_placed(*sample), position.height));
}

} // namespace reljef::terrain
