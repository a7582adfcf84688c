#include "engine/scene/graph/mesh_pick.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <glm/common.hpp>

namespace reljef::scene {
namespace {

constexpr std::size_t leaf_triangles = 4;

// Part of the largest coordinate, of the mesh and of the ray's origin, by which boxes are larger
// than their triangles: what rounds where a ray meets a side.
constexpr double box_margin = 1e-12;

// Larger meshes get their tree in the background: a tree takes several milliseconds.
constexpr std::size_t max_triangles_at_once = 10'000;

glm::dvec3 corner_of(const Mesh& mesh, std::size_t index) {
    return glm::dvec3(mesh.positions[mesh.indices[index]]);
}

double margin_at(glm::dvec3 place) {
    const glm::dvec3 size = glm::abs(place);
    return box_margin * std::max({size.x, size.y, size.z});
}

double margin_of(const Box& bounds) {
    return bounds.empty() ? 0.0 : std::max(margin_at(bounds.low), margin_at(bounds.high));
}

Box widened(const Box& box, double margin) {
    return box.empty() ? box : Box{box.low - margin, box.high + margin};
}

std::vector<Box> boxes_of(const Mesh& mesh) {
    const double margin = margin_of(bounds_of(mesh));
    std::vector<Box> boxes(mesh.indices.size() / 3);
    for (std::size_t triangle = 0; triangle < boxes.size(); ++triangle) {
        Box& box = boxes[triangle];
        for (std::size_t corner = 0; corner < 3; ++corner) {
            box.add(corner_of(mesh, 3 * triangle + corner));
        }
        box = widened(box, margin);
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

// Keeps the nearest of the triangles that it is given.
class NearestHit {
public:
    NearestHit(const Mesh& mesh, const Ray& ray, reljef::Interval range)
        : mesh_(mesh), ray_(ray), range_(range) {}

    void test(std::size_t triangle) {
        const auto t = ray_.hit(mesh_, triangle);
        if (t && *t >= range_.begin && *t <= range_.end) {
            range_.end = *t;
            nearest_ = MeshHit{*t, triangle};
        }
    }
    [[nodiscard]] reljef::Interval range() const { return range_; }
    [[nodiscard]] std::optional<MeshHit> nearest() const { return nearest_; }

private:
    const Mesh& mesh_;
    ShearedRay ray_;
    reljef::Interval range_;
    std::optional<MeshHit> nearest_;
};

bool may_hit(const Ray& ray) {
    return is_finite(ray) && ray.direction != glm::dvec3(0.0);
}

} // namespace

std::optional<MeshHit> first_hit(const Mesh& mesh, const Ray& ray, reljef::Interval range) {
    if (!may_hit(ray)) {
        return std::nullopt;
    }
    NearestHit hit(mesh, ray, range);
    for (std::size_t triangle = 0; triangle + 2 < mesh.indices.size(); triangle += 3) {
        hit.test(triangle);
    }
    return hit.nearest();
}

class MeshTree::Growth {
public:
    Growth(MeshTree& tree, const std::stop_token& stop)
        : tree_(tree), boxes_(boxes_of(tree.mesh_)), stop_(stop) {}

    // Halves of the triangles by their middles along the widest axis: the depth is a logarithm.
    void grow(std::size_t begin, std::size_t end) {
        auto& order = tree_.order_;
        const std::size_t index = tree_.branches_.size();
        Branch& branch = tree_.branches_.emplace_back();
        Box middles;
        for (std::size_t i = begin; i < end; ++i) {
            branch.bounds.add(boxes_[order[i]]);
            middles.add(boxes_[order[i]].center());
        }
        if (end - begin <= leaf_triangles || stop_.stop_requested()) {
            branch.first = static_cast<std::uint32_t>(begin);
            branch.count = static_cast<std::uint32_t>(end - begin);
            return;
        }
        const int axis = widest_axis(middles.size());
        const std::size_t middle = (begin + end) / 2;
        const auto at = [&](std::size_t i) {
            return order.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
            return boxes_[a].center()[axis] < boxes_[b].center()[axis];
        });
        grow(begin, middle);
        tree_.branches_[index].second = static_cast<std::uint32_t>(tree_.branches_.size());
        grow(middle, end);
    }

private:
    MeshTree& tree_;
    std::vector<Box> boxes_; // of the triangles
    const std::stop_token& stop_;
};

MeshTree::MeshTree(const Mesh& mesh, const std::stop_token& stop)
    : mesh_(mesh), order_(mesh.indices.size() / 3) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (!order_.empty()) {
        Growth(*this, stop).grow(0, order_.size());
    }
}

std::optional<MeshHit> MeshTree::first_hit(const Ray& ray, reljef::Interval range) const {
    if (!may_hit(ray)) {
        return std::nullopt;
    }
    const double margin = margin_at(ray.origin);
    NearestHit hit(mesh_, ray, range);
    std::vector<std::uint32_t> open;
    if (!branches_.empty()) {
        open.push_back(0);
    }
    while (!open.empty()) {
        const std::uint32_t index = open.back();
        const Branch& branch = branches_[index];
        open.pop_back();
        if (!intersect(ray, widened(branch.bounds, margin), hit.range())) {
            continue;
        }
        if (branch.count == 0) {
            open.push_back(branch.second);
            open.push_back(index + 1);
        }
        for (std::uint32_t i = 0; i < branch.count; ++i) {
            hit.test(std::size_t{3} * order_[branch.first + i]);
        }
    }
    return hit.nearest();
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

MeshTrees::Entry& MeshTrees::entry_for(const std::shared_ptr<const Mesh>& mesh) {
    auto found = entries_.find(mesh);
    if (found == entries_.end()) {
        std::erase_if(entries_, [](const auto& entry) { return entry.first.expired(); });
        const Box bounds = bounds_of(*mesh);
        found = entries_.emplace(mesh, Entry{.bounds = widened(bounds, margin_of(bounds))}).first;
    }
    return found->second;
}

void MeshTrees::make(const std::shared_ptr<const Mesh>& mesh, Entry& entry) {
    if (mesh->indices.size() / 3 <= max_triangles_at_once) {
        entry.tree = std::make_shared<const MeshTree>(*mesh);
    } else if (!entry.making.valid()) {
        entry.making =
            std::async(std::launch::async, [kept = mesh, stop = stop_.get_token()]() mutable {
                const auto made_of = std::move(kept); // until it is made
                return std::make_shared<const MeshTree>(*made_of, stop);
            });
    } else if (entry.making.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        entry.tree = entry.making.get();
    }
}

std::optional<MeshHit> MeshTrees::first_hit(const std::shared_ptr<const Mesh>& mesh, const Ray& ray,
                                            reljef::Interval range) {
    if (!may_hit(ray)) {
        return std::nullopt;
    }
    Tree tree;
    {
        const std::scoped_lock lock(mutex_);
        Entry& entry = entry_for(mesh);
        if (!intersect(ray, widened(entry.bounds, margin_at(ray.origin)), range)) {
            return std::nullopt;
        }
        if (entry.tree == nullptr) {
            make(mesh, entry);
        }
        tree = entry.tree;
    }
    return tree != nullptr ? tree->first_hit(ray, range) : scene::first_hit(*mesh, ray, range);
}

} // namespace reljef::scene
