#include "engine/cast/frame/base_walls.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/matrix.hpp>

#include "engine/cast/block_rays.h"
#include "engine/cast/picture_rays.h"

namespace reljef::cast {
namespace {

using Triangle = std::array<glm::dvec3, 3>;

// A convex polygon: a triangle that the near plane cut.
struct Polygon {
    std::array<glm::dvec3, 4> corners;
    std::size_t count = 0;

    void add(glm::dvec3 corner) { corners[count++] = corner; }
};

// From world metres to (depth, col · depth, row · depth) in perspective, else (depth, col, row).
class Projection {
public:
    Projection(const view::DrawList& list, const glm::dmat4& world_from_local)
        : perspective_(list.camera.projection == scene::ProjectionKind::perspective),
          near_(list.camera.near) {
        const PictureRays rays = local_rays(list.camera, list.size, world_from_local, {});
        origin_ = rays.origin.first;
        const PictureRays::Vectors& fan = perspective_ ? rays.direction : rays.origin;
        from_local_ = glm::inverse(glm::dmat3(rays.direction.first, fan.right, fan.down));
    }

    [[nodiscard]] glm::dvec3 homogeneous(glm::dvec3 local) const {
        return from_local_ * (local - origin_);
    }

    // The part beyond the near plane.
    [[nodiscard]] Polygon visible(const Triangle& triangle) const {
        Polygon polygon;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3& a = triangle[i];
            const glm::dvec3& b = triangle[(i + 1) % 3];
            if (!perspective_ || a.x >= near_) {
                polygon.add(a);
            }
            if (perspective_ && (a.x >= near_) != (b.x >= near_)) {
                polygon.add(glm::mix(a, b, (near_ - a.x) / (b.x - a.x)));
            }
        }
        return polygon;
    }

    // Col, row, and what is linear on the picture: the inverse depth, on a map the depth.
    [[nodiscard]] glm::dvec3 on_picture(glm::dvec3 homogeneous) const {
        return perspective_ ? glm::dvec3(homogeneous.y / homogeneous.x,
                                         homogeneous.z / homogeneous.x, 1.0 / homogeneous.x)
                            : glm::dvec3(homogeneous.y, homogeneous.z, homogeneous.x);
    }

private:
    bool perspective_;
    double near_;
    glm::dvec3 origin_;
    glm::dmat3 from_local_;
};

// Twice the area; negative if it faces the eye, because rows count down.
double area_of(const Triangle& t) {
    return (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
}

// A function that is linear on the picture, from its values at the corners: per col, per row, at 0.
glm::dvec3 plane_of(const Triangle& t, glm::dvec3 values) {
    const glm::dmat3 from_values = glm::inverse(
        glm::dmat3({t[0].x, t[1].x, t[2].x}, {t[0].y, t[1].y, t[2].y}, glm::dvec3(1.0)));
    return from_values * values;
}

glm::vec3 from_middle(glm::dvec3 plane, glm::dvec2 middle) {
    return {plane.x, plane.y, plane.x * middle.x + plane.y * middle.y + plane.z};
}

struct LinearTriangle {
    std::array<glm::dvec3, 3> sides;
    glm::dvec3 depth;
    glm::dvec2 low;
    glm::dvec2 high;
};

LinearTriangle linear_triangle(const Triangle& t) {
    LinearTriangle made;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec2 a(t[(i + 1) % 3]);
        const glm::dvec2 along = glm::dvec2(t[i]) - a; // against the order, as it faces the eye
        const glm::dvec2 inward =
            glm::dvec2(-along.y, along.x) / std::max(glm::length(along), 1e-9);
        made.sides[i] = {inward, -glm::dot(inward, a)};
    }
    made.depth = plane_of(t, {t[0].z, t[1].z, t[2].z});
    made.low = glm::min(glm::dvec2(t[0]), glm::min(glm::dvec2(t[1]), glm::dvec2(t[2])));
    made.high = glm::max(glm::dvec2(t[0]), glm::max(glm::dvec2(t[1]), glm::dvec2(t[2])));
    return made;
}

class Walls {
public:
    explicit Walls(glm::ivec2 size)
        : blocks_((size + block_side - 1) / block_side), size_(size),
          walls_(static_cast<std::size_t>(block_count(size))) {}

    void add(const Triangle& triangle, glm::vec3 color) {
        constexpr double min_area = 1.0 / 256.0; // pixels: smaller ones hold no sample
        if (!(area_of(triangle) < -min_area)) {
            return;
        }
        const LinearTriangle linear = linear_triangle(triangle);
        const glm::dvec2 last(size_ - 1);
        if (linear.high.x < -1.0 || linear.high.y < -1.0 || linear.low.x > last.x + 1.0 ||
            linear.low.y > last.y + 1.0) {
            return;
        }
        const glm::ivec2 begin(glm::clamp(glm::floor(linear.low), glm::dvec2(0.0), last));
        const glm::ivec2 end(glm::clamp(glm::ceil(linear.high), glm::dvec2(0.0), last));
        for (int row = begin.y / block_side; row <= end.y / block_side; ++row) {
            for (int col = begin.x / block_side; col <= end.x / block_side; ++col) {
                add_to_block({col, row}, linear, color);
            }
        }
    }

    [[nodiscard]] std::vector<std::vector<WallTriangle>> take() { return std::move(walls_); }

private:
    void add_to_block(glm::ivec2 block, const LinearTriangle& linear, glm::vec3 color) {
        const glm::dvec2 middle =
            static_cast<double>(block_side) * glm::dvec2(block) + 0.5 * block_side;
        WallTriangle wall;
        std::transform(linear.sides.begin(), linear.sides.end(), wall.sides.begin(),
                       [&](glm::dvec3 side) { return from_middle(side, middle); });
        wall.depth = from_middle(linear.depth, middle);
        wall.color = color;
        wall.low = glm::vec2(linear.low - middle);
        wall.high = glm::vec2(linear.high - middle);
        walls_[static_cast<std::size_t>(block.y) * static_cast<std::size_t>(blocks_.x) +
               static_cast<std::size_t>(block.x)]
            .push_back(wall);
    }

    glm::ivec2 blocks_;
    glm::ivec2 size_;
    std::vector<std::vector<WallTriangle>> walls_;
};

// As surface_light.glsl.
glm::vec3 lit(glm::vec3 albedo, glm::vec3 normal, const std::optional<scene::Light>& sun) {
    if (!sun) {
        return albedo;
    }
    const float facing = std::max(glm::dot(normal, glm::vec3(scene::to_light(*sun))), 0.0F);
    return albedo * (sun->color * facing + sun->ambient * (0.5F + 0.5F * normal.z));
}

void add_base(const view::DrawList& list, const view::MeshDraw& draw, Walls& walls) {
    const scene::Mesh& mesh = *draw.mesh->mesh;
    const Projection projection(list, draw.world_from_local);
    const glm::mat3 world_from_normal(glm::inverseTranspose(glm::dmat3(draw.world_from_local)));
    std::vector<glm::dvec3> corners(mesh.positions.size());
    std::transform(mesh.positions.begin(), mesh.positions.end(), corners.begin(),
                   [&](glm::vec3 place) { return projection.homogeneous(glm::dvec3(place)); });
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto index = [&](std::size_t corner) { return mesh.indices[i + corner]; };
        const Polygon polygon =
            projection.visible({corners[index(0)], corners[index(1)], corners[index(2)]});
        const glm::vec3 color =
            lit(draw.mesh->material.color,
                glm::normalize(world_from_normal * mesh.normals[index(0)]), list.sun);
        for (std::size_t corner = 2; corner < polygon.count; ++corner) {
            walls.add({projection.on_picture(polygon.corners[0]),
                       projection.on_picture(polygon.corners[corner - 1]),
                       projection.on_picture(polygon.corners[corner])},
                      color);
        }
    }
}

} // namespace

std::vector<std::vector<WallTriangle>> base_walls(const view::DrawList& list) {
    if (list.bases.empty()) {
        return {};
    }
    Walls walls(list.size);
    for (const view::MeshDraw& base : list.bases) {
        add_base(list, base, walls);
    }
    return walls.take();
}

} // namespace reljef::cast
