#include "engine/io/footprints/geometry_on_earth.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace reljef::io {
namespace {

// No polygon is over half of the Earth wide.
void unwrap(double first, std::vector<glm::dvec2>& corners) {
    for (double before = first; glm::dvec2 & corner : corners) {
        corner.x -= 360.0 * std::round((corner.x - before) / 360.0);
        before = corner.x;
    }
}

bool is_on_earth(const std::vector<glm::dvec2>& corners) {
    return std::all_of(corners.begin(), corners.end(), [](glm::dvec2 corner) {
        return std::abs(corner.x) <= 720.0 && std::abs(corner.y) <= 90.0; // false for NaN
    });
}

std::vector<glm::dvec2> corners_of(const OGRLinearRing& ring) {
    std::vector<glm::dvec2> corners;
    corners.reserve(static_cast<std::size_t>(ring.getNumPoints()));
    for (int i = 0; i < ring.getNumPoints(); ++i) {
        corners.emplace_back(ring.getX(i), ring.getY(i));
    }
    return corners;
}

class EarthVisitor : public OGRDefaultGeometryVisitor {
public:
    explicit EarthVisitor(const CrsTransform& transform) : transform_(transform) {}
    [[nodiscard]] bool is_good() const { return is_good_; }

    using OGRDefaultGeometryVisitor::visit;
    void visit(OGRPolygon* polygon) override {
        std::optional<double> first; // longitude of the polygon
        for (OGRLinearRing* ring : polygon) {
            std::vector<glm::dvec2> corners = corners_of(*ring);
            transform_.apply(corners);
            is_good_ = is_good_ && is_on_earth(corners);
            if (!is_good_ || corners.empty()) {
                continue;
            }
            first = first.value_or(corners.front().x);
            unwrap(*first, corners);
            for (int i = 0; i < ring->getNumPoints(); ++i) {
                const glm::dvec2 corner = corners[static_cast<std::size_t>(i)];
                ring->setPoint(i, corner.x, corner.y);
            }
        }
    }

private:
    const CrsTransform& transform_;
    bool is_good_ = true;
};

} // namespace

bool place_on_earth(OGRGeometry& geometry, const CrsTransform& transform) {
    EarthVisitor visitor(transform);
    geometry.accept(&visitor);
    return visitor.is_good();
}

} // namespace reljef::io
