#include "engine/io/footprints/polygon_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include <cpl_string.h>
#include <geos_c.h>

namespace reljef::io {
namespace {

using Geometry = std::unique_ptr<OGRGeometry>;

class GeosContext {
public:
    GeosContext() : handle_(OGRGeometry::createGEOSContext()) {}
    ~GeosContext() { OGRGeometry::freeGEOSContext(handle_); }
    GeosContext(const GeosContext&) = delete;
    GeosContext& operator=(const GeosContext&) = delete;
    [[nodiscard]] GEOSContextHandle_t handle() const { return handle_; }

private:
    GEOSContextHandle_t handle_;
};

class GeosShape {
public:
    GeosShape(const GeosContext& context, GEOSGeometry* shape)
        : context_(context.handle()), shape_(shape) {}
    ~GeosShape() {
        if (shape_ != nullptr) {
            GEOSGeom_destroy_r(context_, shape_);
        }
    }
    GeosShape(const GeosShape&) = delete;
    GeosShape& operator=(const GeosShape&) = delete;
    [[nodiscard]] const GEOSGeometry* get() const { return shape_; }

private:
    GEOSContextHandle_t context_;
    GEOSGeometry* shape_;
};

// Polygons of a geometry and of the collections in it.
std::vector<const OGRPolygon*> polygons_in(const OGRGeometry& geometry) {
    std::vector<const OGRPolygon*> polygons;
    std::vector<const OGRGeometry*> open{&geometry};
    while (!open.empty()) {
        const OGRGeometry* const next = open.back();
        open.pop_back();
        const OGRwkbGeometryType type = wkbFlatten(next->getGeometryType());
        if (type == wkbPolygon) {
            polygons.push_back(next->toPolygon());
        } else if (type == wkbMultiPolygon || type == wkbGeometryCollection) {
            for (const OGRGeometry* part : *next->toGeometryCollection()) {
                open.push_back(part);
            }
        }
    }
    return polygons;
}

// Without the last point, which is the first.
building::Ring corners_of(const OGRLinearRing& line, bool is_hole) {
    building::Ring ring;
    for (int i = 0; i + 1 < line.getNumPoints(); ++i) {
        ring.emplace_back(line.getX(i), line.getY(i));
    }
    if (ring.size() >= 3 && (building::signed_area(ring) < 0.0) != is_hole) {
        std::reverse(ring.begin(), ring.end());
    }
    return ring;
}

std::vector<building::Ring> rings_of(const OGRPolygon& polygon) {
    std::vector<building::Ring> rings;
    if (polygon.getExteriorRing() != nullptr) {
        rings.push_back(corners_of(*polygon.getExteriorRing(), false));
    }
    for (int i = 0; i < polygon.getNumInteriorRings(); ++i) {
        rings.push_back(corners_of(*polygon.getInteriorRing(i), true));
    }
    return rings;
}

std::size_t corners_in(const OGRPolygon& polygon) {
    std::size_t corners = 0;
    for (const OGRLinearRing* ring : polygon) {
        corners += static_cast<std::size_t>(ring->getNumPoints());
    }
    return corners;
}

bool has_numbers(const OGRPolygon& polygon) {
    return std::all_of(polygon.begin(), polygon.end(), [](const OGRLinearRing* ring) {
        bool all = true;
        for (int i = 0; i < ring->getNumPoints(); ++i) {
            all = all && std::isfinite(ring->getX(i)) && std::isfinite(ring->getY(i));
        }
        return all;
    });
}

using CornerIndexes = std::map<std::pair<double, double>, std::uint32_t>;

CornerIndexes indexes_of(const std::vector<building::Ring>& rings) {
    CornerIndexes indexes;
    std::uint32_t next = 0;
    for (const building::Ring& ring : rings) {
        for (const glm::dvec2 corner : ring) {
            indexes.emplace(std::pair(corner.x, corner.y), next++);
        }
    }
    return indexes;
}

// Counter-clockwise; absent if it is none between these corners.
std::optional<glm::uvec3> triangle_of(const GeosContext& context, const GEOSGeometry* triangle,
                                      const CornerIndexes& indexes) {
    const GEOSGeometry* const border = GEOSGetExteriorRing_r(context.handle(), triangle);
    const GEOSCoordSequence* const points =
        border != nullptr ? GEOSGeom_getCoordSeq_r(context.handle(), border) : nullptr;
    unsigned count = 0;
    if (points == nullptr || GEOSCoordSeq_getSize_r(context.handle(), points, &count) == 0 ||
        count != 4) {
        return std::nullopt;
    }
    building::Ring corners(3);
    glm::uvec3 found(0U);
    for (unsigned i = 0; i < 3; ++i) {
        glm::dvec2& corner = corners[i];
        GEOSCoordSeq_getXY_r(context.handle(), points, i, &corner.x, &corner.y);
        const auto index = indexes.find({corner.x, corner.y});
        if (index == indexes.end()) {
            return std::nullopt;
        }
        found[static_cast<int>(i)] = index->second;
    }
    return building::signed_area(corners) < 0.0 ? glm::uvec3(found.x, found.z, found.y) : found;
}

// Empty if GEOS fails.
std::vector<glm::uvec3> triangles_of(const OGRPolygon& polygon,
                                     const std::vector<building::Ring>& rings) {
    const GeosContext context;
    const GeosShape shape(context, polygon.exportToGEOS(context.handle()));
    if (shape.get() == nullptr) {
        return {};
    }
    const GeosShape divided(context,
                            GEOSConstrainedDelaunayTriangulation_r(context.handle(), shape.get()));
    if (divided.get() == nullptr) {
        return {};
    }
    const CornerIndexes indexes = indexes_of(rings);
    std::vector<glm::uvec3> triangles;
    const int count = GEOSGetNumGeometries_r(context.handle(), divided.get());
    for (int i = 0; i < count; ++i) {
        const auto triangle =
            triangle_of(context, GEOSGetGeometryN_r(context.handle(), divided.get(), i), indexes);
        if (!triangle) {
            return {};
        }
        triangles.push_back(*triangle);
    }
    return triangles;
}

Geometry repaired_by_structure(const OGRPolygon& polygon) {
    CPLStringList method;
    method.SetNameValue("METHOD", "STRUCTURE");
    return Geometry(polygon.MakeValid(method.List()));
}

// What lies within the outer ring: GEOS makes a polygon of a hole beside it. Null if GEOS fails.
Geometry repaired_polygon(const OGRPolygon& polygon) {
    Geometry repaired = repaired_by_structure(polygon);
    if (polygon.getNumInteriorRings() == 0 || repaired == nullptr) {
        return repaired;
    }
    OGRPolygon outer;
    outer.addRingDirectly(polygon.getExteriorRing()->clone()); // takes it over
    const Geometry within = repaired_by_structure(outer);
    return within != nullptr ? Geometry(repaired->Intersection(within.get())) : nullptr;
}

// GEOS ends the program at a hole without points.
OGRPolygon without_empty_holes(const OGRPolygon& polygon) {
    OGRPolygon made;
    made.addRingDirectly(polygon.getExteriorRing()->clone()); // takes it over
    for (int i = 0; i < polygon.getNumInteriorRings(); ++i) {
        if (polygon.getInteriorRing(i)->getNumPoints() > 0) {
            made.addRingDirectly(polygon.getInteriorRing(i)->clone());
        }
    }
    return made;
}

// Appends the footprint of a valid polygon.
void add_part(const OGRPolygon& polygon, PolygonParts& found) {
    if (polygon.getExteriorRing() == nullptr) {
        ++found.broken;
        return;
    }
    const OGRPolygon shown = without_empty_holes(polygon);
    std::vector<building::Ring> rings = rings_of(shown);
    std::vector<glm::uvec3> triangles = triangles_of(shown, rings);
    if (triangles.empty()) {
        ++found.broken;
    } else {
        found.parts.push_back({std::move(rings), std::move(triangles)});
    }
}

} // namespace

bool has_polygon(const OGRGeometry& geometry) {
    return !polygons_in(geometry).empty();
}

PolygonParts polygon_parts(const OGRGeometry& geometry) {
    PolygonParts found;
    const Geometry flat(geometry.clone());
    flat->flattenTo2D();
    for (const OGRPolygon* polygon : polygons_in(*flat)) {
        if (corners_in(*polygon) > max_polygon_corners) {
            ++found.too_large;
        } else if (!has_numbers(*polygon)) {
            ++found.broken;
        } else if (polygon->IsValid() != 0) {
            add_part(*polygon, found);
        } else {
            const Geometry repaired = repaired_polygon(*polygon);
            const auto pieces =
                repaired != nullptr ? polygons_in(*repaired) : std::vector<const OGRPolygon*>();
            found.is_repaired = found.is_repaired || !pieces.empty();
            found.broken += static_cast<std::size_t>(pieces.empty());
            for (const OGRPolygon* piece : pieces) {
                add_part(*piece, found);
            }
        }
    }
    return found;
}

} // namespace reljef::io
