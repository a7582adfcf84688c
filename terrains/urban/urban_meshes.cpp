#include "terrains/urban/urban_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/building/roof.h"

namespace reljef::terrains::urban {
namespace {

constexpr double wall_foot = -1.0;   // metres above the street
constexpr double longest_wall = 6.0; // metres between corners: streets curve, walls do not

building::Ring ring_of(const Convex& shape) {
    building::Ring ring;
    for (const glm::vec2 corner : shape.corners) {
        ring.emplace_back(corner);
    }
    return ring;
}

bool holds(const Frame& frame, glm::vec2 place) {
    const glm::vec2 from = place - frame.center;
    return std::abs(dot(frame.axis, from)) <= frame.half.x &&
           std::abs(dot(turned(frame.axis), from)) <= frame.half.y;
}

// Of the edges that begin at the ring's corners.
std::vector<bool> sloped_edges(const Building& building, const building::Ring& ring) {
    std::vector<bool> sloped;
    for (const glm::dvec2 corner : ring) {
        const auto& all = building.outline.corners;
        const auto found = std::find(all.begin(), all.end(), glm::vec2(corner));
        const auto index = static_cast<std::size_t>(found - all.begin());
        sloped.push_back((building.sloped >> std::min<std::size_t>(index, 31U) & 1U) != 0U);
    }
    return sloped;
}

std::vector<building::RoofPart> roof_of(const Building& building, const building::Ring& ring,
                                        float spacing) {
    if (building.sloped == 0U) {
        const double wall = std::max(0.35F, 0.75F * spacing); // as painted
        return building::roof_with_parapet(ring, wall, building.parapet);
    }
    return building::sloped_roof(
        ring, {building.slope, building.rise_limit, sloped_edges(building, ring)});
}

// Walls that look into a well, and its floor.
void add_well(const Prism& well, double eaves, std::vector<building::Face>& faces) {
    const building::Ring ring = ring_of(rectangle(well.frame));
    building::Face floor;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 a = ring[i];
        const glm::dvec2 b = ring[(i + 1) % ring.size()];
        faces.push_back({{{b, well.top}, {a, well.top}, {a, eaves}, {b, eaves}}});
        floor.corners.emplace_back(a, well.top);
    }
    faces.push_back(std::move(floor));
}

// In the city, without what the warp and the copy add. Empty for slivers.
std::vector<building::Face> faces_in_city(const Building& building, const Prism* well,
                                          float spacing) {
    const building::Ring ring = building::without_straight_corners(ring_of(building.outline));
    if (!building::is_convex(ring)) {
        return {};
    }
    std::vector<building::RoofPart> roof = roof_of(building, ring, spacing);
    if (well != nullptr) {
        roof = building::without(roof, ring_of(rectangle(well->frame)));
    }
    std::vector<building::Face> faces = building::building_below(
        building::divided(roof, longest_wall), ring, {wall_foot, 0.0, building.eaves});
    if (well != nullptr) {
        add_well(*well, building.eaves, faces);
    }
    return faces;
}

glm::vec3 linear(const Color& color) {
    const Color kept = glm::clamp(color, 0.0F, 1.0F);
    return {linear_from_srgb(kept.x), linear_from_srgb(kept.y), linear_from_srgb(kept.z)};
}

// Places of the city on the terrain; rows of the raster grow south, against y.
class TerrainPlaces {
public:
    TerrainPlaces(const CityPlan& city, const Raster& raster)
        : warp_(city.plan.warp), raster_(raster),
          half_(0.5 * raster.spacing_in_metres * (raster.size - 1)) {}

    [[nodiscard]] double half() const { return half_; } ///< of the terrain's side, metres

    [[nodiscard]] glm::dvec2 at(glm::dvec2 city) const {
        const glm::vec2 ground = warp_.ground_from_city(glm::vec2(city)) - raster_.origin;
        const glm::dvec2 metres =
            glm::dvec2(ground) * (raster_.spacing_in_metres / static_cast<double>(raster_.spacing));
        return {metres.x - half_, half_ - metres.y};
    }

private:
    const Warp& warp_;
    const Raster& raster_;
    double half_;
};

// Sutherland & Hodgman 1974, with the façade's coordinates: keeps dot(normal, p) <= limit.
building::Face cut_face(const building::Face& face, glm::dvec2 normal, double limit) {
    building::Face kept;
    const std::size_t n = face.corners.size();
    const auto add = [&](std::size_t i, std::size_t j, double share) {
        kept.corners.push_back(glm::mix(face.corners[i], face.corners[j], share));
        if (!face.facade.empty()) {
            kept.facade.push_back(glm::mix(face.facade[i], face.facade[j], share));
        }
    };
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = (i + 1) % n;
        const double from = limit - glm::dot(normal, glm::dvec2(face.corners[i]));
        const double to = limit - glm::dot(normal, glm::dvec2(face.corners[j]));
        if (from >= 0.0) {
            add(i, i, 0.0);
        }
        if ((from >= 0.0) != (to >= 0.0)) {
            add(i, j, from / (from - to));
        }
    }
    return kept;
}

building::PaintedFaces on_terrain(std::vector<building::Face> faces, const Color& color,
                                  glm::vec2 shift, const TerrainPlaces& places) {
    building::PaintedFaces made;
    made.color = linear(color);
    for (building::Face& face : faces) {
        for (glm::dvec3& corner : face.corners) {
            corner = {places.at(glm::dvec2(corner) + glm::dvec2(shift)), corner.z};
        }
        std::reverse(face.corners.begin(), face.corners.end()); // y turned over
        std::reverse(face.facade.begin(), face.facade.end());
        for (const glm::dvec2 normal : {glm::dvec2(1.0, 0.0), glm::dvec2(-1.0, 0.0),
                                        glm::dvec2(0.0, 1.0), glm::dvec2(0.0, -1.0)}) {
            face = cut_face(face, normal, places.half());
        }
        if (face.corners.size() >= 3) {
            made.faces.push_back(std::move(face));
        }
    }
    if (made.faces.empty()) {
        return made;
    }
    made.origin = {glm::dvec2(made.faces.front().corners.front()), 0.0};
    for (building::Face& face : made.faces) {
        for (glm::dvec3& corner : face.corners) {
            corner -= made.origin;
        }
    }
    return made;
}

const Prism* well_in(const Block& block, const Building& building) {
    const auto found =
        std::find_if(block.prisms.begin(), block.prisms.end(), [&](const Prism& prism) {
            return prism.kind == PrismKind::well && prism.top < building.eaves &&
                   building.sloped == 0U && building.shape.distance(prism.frame.center) > 0.0F;
        });
    return found != block.prisms.end() ? &*found : nullptr;
}

bool is_over_well(const Block& block, const Prism& prism) {
    return std::any_of(block.prisms.begin(), block.prisms.end(), [&](const Prism& other) {
        return other.kind == PrismKind::well && holds(other.frame, prism.frame.center);
    });
}

} // namespace

std::vector<building::PaintedFaces> mesh_buildings(const CityPlan& city, const Raster& raster) {
    const TerrainPlaces places(city, raster);
    std::vector<building::PaintedFaces> made;
    const auto add = [&](std::vector<building::Face> faces, const Color& color, glm::vec2 shift) {
        building::PaintedFaces painted = on_terrain(std::move(faces), color, shift, places);
        if (!painted.faces.empty()) {
            made.push_back(std::move(painted));
        }
    };
    for (const BlockCopy& copy : copies_in(city, city_bounds(raster, city.plan.warp))) {
        for (const Building& building : copy.block->buildings) {
            add(faces_in_city(building, well_in(*copy.block, building), raster.spacing),
                building.color, copy.shift);
        }
        for (const Prism& prism : copy.block->prisms) {
            if (!stands_on_ground(prism.kind) && prism.kind != PrismKind::well &&
                !is_over_well(*copy.block, prism)) {
                add(building::box_faces(ring_of(rectangle(prism.frame)), wall_foot, prism.top),
                    prism.color, copy.shift);
            }
        }
    }
    return made;
}

} // namespace reljef::terrains::urban
