#include "engine/building/building_faces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>

namespace reljef::building {
namespace {

double whole_parts(double length, double part) {
    return std::max(1.0, std::round(length / part));
}

// An edge of the outline, from `from` to `to`, whose windows begin at its own begin.
class Facade {
public:
    Facade(glm::dvec2 begin, glm::dvec2 end, const Extent& extent)
        : begin_(begin), extent_(extent), length_(glm::distance(begin, end)),
          bays_(whole_parts(length_, window_bay)),
          storeys_(whole_parts(extent.eaves - extent.ground, window_storey)) {}

    // `from` and `to`: the upper ends, on the edge.
    [[nodiscard]] Face wall(glm::dvec3 from, glm::dvec3 to) const {
        const glm::dvec3 low_from(from.x, from.y, extent_.foot);
        const glm::dvec3 low_to(to.x, to.y, extent_.foot);
        return {{low_from, low_to, to, from},
                {window_at(low_from), window_at(low_to), window_at(to), window_at(from)}};
    }

private:
    [[nodiscard]] glm::dvec2 window_at(glm::dvec3 place) const {
        const double along = // an edge may be shorter than the square root of the least number
            length_ > 0.0 ? glm::distance(begin_, glm::dvec2(place)) / length_ : 0.0;
        const double down = (extent_.eaves - place.z) / (extent_.eaves - extent_.ground);
        return {along * bays_, down * storeys_};
    }

    glm::dvec2 begin_;
    Extent extent_;
    double length_;
    double bays_;
    double storeys_;
};

void add_walls(std::vector<Face>& faces, const Ring& ring, const Extent& extent) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 from = ring[i];
        const glm::dvec2 to = ring[(i + 1) % ring.size()];
        if (from != to) {
            faces.push_back(
                Facade(from, to, extent).wall({from, extent.eaves}, {to, extent.eaves}));
        }
    }
}

// From the eaves to the ridge of a hipped roof, metres; 0 if there is none. An outline of a few
// centimetres has no part that is large enough, and one of 1e300 metres no number.
double run_of_hips(const Footprint& footprint, RoofKind roof) {
    if (roof != RoofKind::hipped || footprint.rings.size() != 1) {
        return 0.0;
    }
    const Ring outline = without_straight_corners(footprint.rings.front());
    const double run = is_convex(outline) ? largest_run(outline, {}) : 0.0;
    return std::isfinite(run) ? run : 0.0;
}

} // namespace

std::vector<Face> flat_building(const Footprint& footprint, const Extent& extent) {
    std::vector<Face> faces;
    std::vector<glm::dvec3> corners;
    for (const Ring& ring : footprint.rings) {
        add_walls(faces, ring, extent);
        for (const glm::dvec2 corner : ring) {
            corners.emplace_back(corner, extent.eaves);
        }
    }
    for (const glm::uvec3 triangle : footprint.triangles) {
        faces.push_back({{corners[triangle.x], corners[triangle.y], corners[triangle.z]}});
    }
    return faces;
}

std::vector<Face> building_below(const std::vector<RoofPart>& roof, const Ring& outline,
                                 const Extent& extent) {
    std::vector<Face> faces;
    for (const RoofPart& part : roof) {
        Face face{part.corners};
        for (glm::dvec3& corner : face.corners) {
            corner.z += extent.eaves;
        }
        for (std::size_t i = 0; i < part.corners.size(); ++i) {
            if (const auto edge = part.outline_edges[i]) {
                const Facade facade(outline[*edge], outline[(*edge + 1) % outline.size()], extent);
                faces.push_back(
                    facade.wall(face.corners[i], face.corners[(i + 1) % face.corners.size()]));
            }
        }
        faces.push_back(std::move(face));
    }
    return faces;
}

bool has_hips(const Footprint& footprint, RoofKind roof) {
    return run_of_hips(footprint, roof) > 0.0;
}

std::vector<Face> building_of(const Footprint& footprint, RoofKind roof, double foot,
                              double height) {
    const double run = run_of_hips(footprint, roof);
    if (run == 0.0) {
        return flat_building(footprint, {foot, 0.0, height});
    }
    const Ring outline = without_straight_corners(footprint.rings.front());
    const double rise = std::min(hip_slope * run, 0.5 * height);
    SlopedRoof hips;
    hips.slope = rise / run;
    return building_below(sloped_roof(outline, hips), outline, {foot, 0.0, height - rise});
}

std::vector<Face> box_faces(const Ring& outline, double foot, double top) {
    std::vector<Face> faces;
    Face lid;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec2 a = outline[i];
        const glm::dvec2 b = outline[(i + 1) % outline.size()];
        faces.push_back({{{a, foot}, {b, foot}, {b, top}, {a, top}}});
        lid.corners.emplace_back(a, top);
    }
    faces.push_back(std::move(lid));
    return faces;
}

} // namespace reljef::building
