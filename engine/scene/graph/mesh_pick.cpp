#include "engine/scene/graph/mesh_pick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <glm/common.hpp>

namespace reljef::scene {
namespace {

constexpr std::size_t leaf_triangles = 4;

// Part of the largest coordinate by which boxes are larger than their triangles: what rounds where
// a ray meets a side.
constexpr double box_margin = 1e-12;

glm::dvec3 corner_of(const Mesh& mesh, std::size_t index) {
    return glm::dvec3(mesh.positions[mesh.indices[index]]);
}

double margin_of(const Box& bounds) {
    const glm::dvec3 largest = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    return bounds.empty() ? 0.0 : box_margin * std::max({largest.x, largest.y, largest.z});
}

std::vector<Box> boxes_of(const Mesh& mesh) {
    const double margin = margin_of(bounds_of(mesh));
    std::vector<Box> boxes(mesh.indices.size() / 3);
    for (std::size_t triangle = 0; triangle < boxes.size(); ++triangle) {
        Box& box = boxes[triangle];
        for (std::size_t corner = 0; corner < 3; ++corner) {
            box.add(corner_of(mesh, 3 * triangle + corner));
        }
        box = {box.low - margin, box.high + margin};
    }
    return boxes;
}

int widest_axis(glm::dvec3 size) {
    const int widest = size.x >= size.y ? 0 : 1;
    return size[widest] >= size.z ? widest : 2;
}

// A ray sheared so that it is the z axis. Edges then have the same bits in both of their triangles.
class ShearedRay {
public:
    explicit ShearedRay(const Ray& ray) : origin_(ray.origin) {
        z_ = widest_axis(glm::abs(ray.direction));
        x_ = (z_ + 1) % 3;
        y_ = (x_ + 1) % 3;
        if (ray.direction[z_] < 0.0) {
            std::swap(x_, y_); // keeps triangles counter-clockwise
        }
        shear_ = glm::dvec3(ray.direction[x_], ray.direction[y_], 1.0) / ray.direction[z_];
    }

    // The t of a triangle that is seen from outside.
    [[nodiscard]] std::optional<double> hit(const Mesh& mesh, std::size_t first) const {
        const glm::dvec3 a = sheared(corner_of(mesh, first));
        const glm::dvec3 b = sheared(corner_of(mesh, first + 1));
        const glm::dvec3 c = sheared(corner_of(mesh, first + 2));
        const double beside_a = c.x * b.y - c.y * b.x;
        const double beside_b = a.x * c.y - a.y * c.x;
        const double beside_c = b.x * a.y - b.y * a.x;
        const double area = beside_a + beside_b + beside_c;
        if (beside_a < 0.0 || beside_b < 0.0 || beside_c < 0.0 || !(area > 0.0)) {
            return std::nullopt;
        }
        return (beside_a * a.z + beside_b * b.z + beside_c * c.z) / area;
    }

private:
    [[nodiscard]] glm::dvec3 sheared(glm::dvec3 point) const {
        const glm::dvec3 way = point - origin_;
        return {way[x_] - shear_.x * way[z_], way[y_] - shear_.y * way[z_], shear_.z * way[z_]};
    }

    glm::dvec3 origin_;
    glm::dvec3 shear_{0.0};
    int x_ = 0;
    int y_ = 0;
    int z_ = 0;
};

} // namespace

MeshTree::MeshTree(const Mesh& mesh) : mesh_(mesh), order_(mesh.indices.size() / 3) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (!order_.empty()) {
        grow(boxes_of(mesh_), 0, order_.size());
    }
}

// Halves of the triangles by their middles along the widest axis: the depth is a logarithm.
void MeshTree::grow(const std::vector<Box>& boxes, std::size_t begin, std::size_t end) {
    const std::size_t index = branches_.size();
    Branch& branch = branches_.emplace_back();
    Box middles;
    for (std::size_t i = begin; i < end; ++i) {
        branch.bounds.add(boxes[order_[i]]);
        middles.add(boxes[order_[i]].center());
    }
    if (end - begin <= leaf_triangles) {
        branch.first = static_cast<std::uint32_t>(begin);
        branch.count = static_cast<std::uint32_t>(end - begin);
        return;
    }
    const int axis = widest_axis(middles.size());
    const std::size_t middle = (begin + end) / 2;
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
        return boxes[a].center()[axis] < boxes[b].center()[axis];
    });
    grow(boxes, begin, middle);
    branches_[index].second = static_cast<std::uint32_t>(branches_.size());
    grow(boxes, middle, end);
}

std::optional<MeshHit> MeshTree::first_hit(const Ray& ray, reljef::Interval range) const {
    if (!is_finite(ray) || ray.direction == glm::dvec3(0.0)) {
        return std::nullopt;
    }
    const ShearedRay sheared(ray);
    std::optional<MeshHit> nearest;
    std::vector<std::uint32_t> open;
    if (!branches_.empty()) {
        open.push_back(0);
    }
    while (!open.empty()) {
        const std::uint32_t index = open.back();
        const Branch& branch = branches_[index];
        open.pop_back();
        if (!intersect(ray, branch.bounds, range)) {
            continue;
        }
        if (branch.count == 0) {
            open.push_back(branch.second);
            open.push_back(index + 1);
        }
        for (std::uint32_t i = 0; i < branch.count; ++i) {
            const std::size_t triangle = std::size_t{3} * order_[branch.first + i];
            const auto t = sheared.hit(mesh_, triangle);
            if (t && *t >= range.begin && *t <= range.end) {
                range.end = *t;
                nearest = MeshHit{*t, triangle};
            }
        }
    }
    return nearest;
}

std::size_t MeshTree::nearest_triangle(glm::dvec3 point, std::size_t guess) const {
    const auto squared_to_box = [&](std::uint32_t branch) {
        const Box& box = branches_[branch].bounds;
        const glm::dvec3 away = point - glm::clamp(point, box.low, box.high);
        return glm::dot(away, away);
    };
    const auto squared_to_triangle = [&](std::size_t triangle) {
        const glm::dvec3 away = point - nearest_point(triangle_corners(mesh_, triangle), point);
        return glm::dot(away, away);
    };
    struct Open {
        std::uint32_t branch;
        double squared;
    };
    std::array<Open, 64> open; // one for each level, and one
    std::size_t count = 1;
    open[0] = {0, 0.0};
    std::size_t nearest = guess;
    double squared = squared_to_triangle(guess);
    while (count > 0) {
        const Open next = open[--count];
        if (!(next.squared < squared)) {
            continue;
        }
        const Branch& branch = branches_[next.branch];
        if (branch.count == 0) {
            Open near{next.branch + 1, squared_to_box(next.branch + 1)};
            Open far{branch.second, squared_to_box(branch.second)};
            if (far.squared < near.squared) {
                std::swap(near, far);
            }
            open[count++] = far;
            open[count++] = near;
        }
        for (std::uint32_t i = 0; i < branch.count; ++i) {
            const std::size_t triangle = std::size_t{3} * order_[branch.first + i];
            if (const double found = squared_to_triangle(triangle); found < squared) {
                squared = found;
                nearest = triangle;
            }
        }
    }
    return nearest;
}

// Null if the ray misses the mesh's bounds.
std::shared_ptr<const MeshTree> MeshTrees::tree_for(const std::shared_ptr<const Mesh>& mesh,
                                                    const Ray& ray, reljef::Interval range) {
    const std::scoped_lock lock(mutex_);
    auto found = entries_.find(mesh);
    if (found == entries_.end()) {
        std::erase_if(entries_, [](const auto& entry) { return entry.first.expired(); });
        const Box bounds = bounds_of(*mesh);
        const double margin = margin_of(bounds);
        found = entries_.emplace(mesh, Entry{{bounds.low - margin, bounds.high + margin}, nullptr})
                    .first;
    }
    Entry& entry = found->second;
    if (!intersect(ray, entry.bounds, range)) {
        return nullptr;
    }
    if (entry.tree == nullptr) {
        entry.tree = std::make_shared<const MeshTree>(*mesh);
    }
    return entry.tree;
}

std::optional<MeshHit> MeshTrees::first_hit(const std::shared_ptr<const Mesh>& mesh, const Ray& ray,
                                            reljef::Interval range) {
    const auto tree = is_finite(ray) ? tree_for(mesh, ray, range) : nullptr;
    return tree != nullptr ? tree->first_hit(ray, range) : std::nullopt;
}

} // namespace reljef::scene
