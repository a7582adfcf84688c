#include "engine/geo/georeference.h"

#include <cmath>
#include <vector>

#include <GeographicLib/Ellipsoid.hpp>
#include <GeographicLib/Geocentric.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/geo/place.h"

namespace reljef::geo {

bool is_ellipsoidal(std::string_view vertical_datum) {
    return vertical_datum.find("llipsoid") != std::string_view::npos;
}

bool is_egm96(std::string_view vertical_datum) {
    return vertical_datum.find("EGM96") != std::string_view::npos;
}

glm::dvec2 radii_of_earth() {
    const double equatorial = GeographicLib::Geocentric::WGS84().EquatorialRadius();
    return {equatorial, equatorial * (1.0 - GeographicLib::Geocentric::WGS84().Flattening())};
}

double smallest_radius_of_earth() {
    const glm::dvec2 radii = radii_of_earth();
    return radii.y * radii.y / radii.x;
}

LocalFrame::LocalFrame(Geodetic origin)
    : origin_(origin), center_(geocentric_from_geodetic(origin)) {
    std::vector<double> rotation(9); // row-major; columns: east, north, up
    glm::dvec3 ignored{0.0};
    GeographicLib::Geocentric::WGS84().Forward(origin.latitude, origin.longitude, origin.height,
                                               ignored.x, ignored.y, ignored.z, rotation);
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        axes_[axis] = {rotation[axis], rotation[3 + axis], rotation[6 + axis]};
    }
}

glm::dvec3 LocalFrame::local_from_geodetic(Geodetic position) const {
    return local_direction(geocentric_from_geodetic(position) - center_);
}

glm::dvec3 LocalFrame::local_direction(glm::dvec3 geocentric) const {
    return {glm::dot(axes_[0], geocentric), glm::dot(axes_[1], geocentric),
            glm::dot(axes_[2], geocentric)};
}

glm::dvec3 LocalFrame::geocentric_from_local(glm::dvec3 local) const {
    return center_ + local.x * axes_[0] + local.y * axes_[1] + local.z * axes_[2];
}

Geodetic LocalFrame::geodetic_from_local(glm::dvec3 local) const {
    return geodetic_from_geocentric(geocentric_from_local(local));
}

glm::dvec3 normal_from_geodetic(double latitude, double longitude) {
    const double phi = glm::radians(latitude);
    const double lambda = glm::radians(longitude);
    return {std::cos(phi) * std::cos(lambda), std::cos(phi) * std::sin(lambda), std::sin(phi)};
}

glm::dvec3 north_from_geodetic(double latitude, double longitude) {
    const double phi = glm::radians(latitude);
    const double lambda = glm::radians(longitude);
    return {-std::sin(phi) * std::cos(lambda), -std::sin(phi) * std::sin(lambda), std::cos(phi)};
}

glm::dvec2 metres_per_degree(double latitude) {
    const GeographicLib::Ellipsoid& ellipsoid = GeographicLib::Ellipsoid::WGS84();
    return {glm::radians(ellipsoid.CircleRadius(latitude)),
            glm::radians(ellipsoid.MeridionalCurvatureRadius(latitude))};
}

double geodesic_distance(Geodetic from, Geodetic to) {
    return geodesic_between(from, to).distance;
}

} // namespace reljef::geo
