#include "bench/baselines/greedy_triangulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <queue>

#include <glm/common.hpp>

#include "engine/core/check.h"

namespace reljef::bench {
namespace {

// Twice the signed area of a triangle.
std::int64_t area_of(glm::ivec2 a, glm::ivec2 b, glm::ivec2 c) {
    return static_cast<std::int64_t>(b.x - a.x) * (c.y - a.y) -
           static_cast<std::int64_t>(b.y - a.y) * (c.x - a.x);
}

// Whether `p` is within the circle through the corners of a triangle of negative area.
bool is_in_circle(glm::ivec2 a, glm::ivec2 b, glm::ivec2 c, glm::ivec2 p) {
    const std::array<std::array<std::int64_t, 2>, 3> from_p{
        {{a.x - p.x, a.y - p.y}, {b.x - p.x, b.y - p.y}, {c.x - p.x, c.y - p.y}}};
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& u = from_p[i];
        const auto& v = from_p[(i + 1) % 3];
        const auto& w = from_p[(i + 2) % 3];
        sum += (u[0] * u[0] + u[1] * u[1]) * (v[0] * w[1] - v[1] * w[0]);
    }
    return sum < 0;
}

// Half edges are numbered three a triangle, each named by where it begins; `twins_` are those on
// their other side, or none.
class GreedyMesh {
public:
    explicit GreedyMesh(GridView<const float> heights) : heights_(heights) {
        const glm::ivec2 last(heights.cols() - 1, heights.rows() - 1);
        corners_.reserve(6);
        const int first = put({last, {0, 0}, {0, last.y}}, {none, none, none}, none);
        put({glm::ivec2(0, 0), last, {last.x, 0}}, {first, none, none}, none);
    }

    void refine(double error) {
        for (push_changed(); !queue_.empty() && queue_.top().error > error; push_changed()) {
            const Candidate next = queue_.top();
            queue_.pop();
            if (next.version == versions_[static_cast<std::size_t>(next.triangle)]) {
                insert(next.triangle, next.sample);
            }
        }
    }

    [[nodiscard]] std::vector<terrain::SampleTriangle> triangles() const {
        std::vector<terrain::SampleTriangle> all;
        for (int edge = 0; edge < static_cast<int>(corners_.size()); edge += 3) {
            all.push_back({from(edge), from(edge + 1), from(edge + 2)});
        }
        return all;
    }

private:
    static constexpr int none = -1;

    struct Candidate {
        double error = 0.0;
        glm::ivec2 sample{0};
        int triangle = 0;
        int version = 0;

        bool operator<(const Candidate& other) const { return error < other.error; }
    };

    static int next(int edge) { return edge % 3 == 2 ? edge - 2 : edge + 1; }
    [[nodiscard]] glm::ivec2 from(int edge) const {
        return corners_[static_cast<std::size_t>(edge)];
    }
    [[nodiscard]] int twin(int edge) const { return twins_[static_cast<std::size_t>(edge)]; }

    // In the place of the triangle that begins at half edge `at`, or as a new one. Returns its
    // first.
    int put(const terrain::SampleTriangle& corners, const std::array<int, 3>& twins, int at) {
        if (at == none) {
            at = static_cast<int>(corners_.size());
            corners_.resize(corners_.size() + 3);
            twins_.resize(corners_.size());
            versions_.push_back(0);
        }
        for (int i = 0; i < 3; ++i) {
            const auto side = static_cast<std::size_t>(i);
            corners_[static_cast<std::size_t>(at) + side] = corners[side];
            twins_[static_cast<std::size_t>(at) + side] = twins[side];
            if (twins[side] != none) {
                twins_[static_cast<std::size_t>(twins[side])] = at + i;
            }
        }
        ++versions_[static_cast<std::size_t>(at / 3)];
        changed_.push_back(at / 3);
        return at;
    }

    void push_changed() {
        for (const int triangle : changed_) {
            const auto farthest = farthest_sample(
                heights_, {from(3 * triangle), from(3 * triangle + 1), from(3 * triangle + 2)});
            queue_.push({farthest.error, farthest.sample, triangle,
                         versions_[static_cast<std::size_t>(triangle)]});
        }
        changed_.clear();
    }

    void insert(int triangle, glm::ivec2 sample) {
        const int edge = 3 * triangle;
        for (int i = 0; i < 3; ++i) {
            if (area_of(from(edge + i), from(next(edge + i)), sample) == 0) {
                split_edge(edge + i, sample);
                return;
            }
        }
        const std::array corners{from(edge), from(edge + 1), from(edge + 2)};
        const std::array twins{twin(edge), twin(edge + 1), twin(edge + 2)};
        const int a = put({corners[0], corners[1], sample}, {twins[0], none, none}, edge);
        const int b = put({corners[1], corners[2], sample}, {twins[1], none, a + 1}, none);
        const int c = put({corners[2], corners[0], sample}, {twins[2], a + 2, b + 1}, none);
        for (const int outer : {a, b, c}) {
            legalize(outer);
        }
    }

    void split_edge(int edge, glm::ivec2 sample) {
        const int left = next(edge);
        const int right = next(left);
        const int other = twin(edge);
        const std::array ends{from(edge), from(left)};
        const glm::ivec2 apex = from(right);
        const std::array outer{twin(right), twin(left)};
        const int first = edge - edge % 3;
        if (other == none) {
            const int a = put({apex, ends[0], sample}, {outer[0], none, none}, first);
            const int b = put({ends[1], apex, sample}, {outer[1], a + 2, none}, none);
            legalize(a);
            legalize(b);
            return;
        }
        const int other_left = next(other);
        const int other_right = next(other_left);
        const glm::ivec2 other_apex = from(other_right);
        const std::array other_outer{twin(other_left), twin(other_right)};
        const int a = put({apex, ends[0], sample}, {outer[0], none, none}, first);
        const int b =
            put({ends[0], other_apex, sample}, {other_outer[0], none, a + 1}, other - other % 3);
        const int c = put({other_apex, ends[1], sample}, {other_outer[1], none, b + 1}, none);
        const int d = put({ends[1], apex, sample}, {outer[1], a + 2, c + 1}, none);
        for (const int side : {a, b, c, d}) {
            legalize(side);
        }
    }

    // Turns an edge, and those that this may have made wrong, where the circle through the corners
    // of one side's triangle holds the other's.
    void legalize(int edge) {
        const int other = twin(edge);
        if (other == none) {
            return;
        }
        const int left = next(edge);
        const int right = next(left);
        const int other_left = next(other);
        const int other_right = next(other_left);
        const std::array ends{from(edge), from(left)};
        const glm::ivec2 apex = from(right);
        const glm::ivec2 other_apex = from(other_right);
        if (!is_in_circle(apex, ends[0], ends[1], other_apex)) {
            return;
        }
        const std::array outer{twin(left), twin(right), twin(other_left), twin(other_right)};
        const int a = put({apex, other_apex, ends[1]}, {none, outer[3], outer[0]}, edge - edge % 3);
        const int b = put({other_apex, apex, ends[0]}, {a, outer[1], outer[2]}, other - other % 3);
        legalize(a + 1);
        legalize(b + 2);
    }

    GridView<const float> heights_;
    std::vector<glm::ivec2> corners_;
    std::vector<int> twins_;
    std::vector<int> versions_; // of each triangle: how often it was put
    std::vector<int> changed_;
    std::priority_queue<Candidate> queue_;
};

} // namespace

FarthestSample farthest_sample(GridView<const float> heights,
                               const terrain::SampleTriangle& triangle) {
    const auto& [a, b, c] = triangle;
    const glm::ivec2 low = glm::min(a, glm::min(b, c));
    const glm::ivec2 high = glm::max(a, glm::max(b, c));
    const std::int64_t area = area_of(a, b, c);
    const std::int64_t sign = area < 0 ? -1 : 1;
    FarthestSample farthest{a, 0.0};
    for (int row = low.y; row <= high.y; ++row) {
        for (int col = low.x; col <= high.x; ++col) {
            const std::array weights{sign * area_of(b, c, {col, row}),
                                     sign * area_of(c, a, {col, row}),
                                     sign * area_of(a, b, {col, row})};
            if (*std::min_element(weights.begin(), weights.end()) < 0) {
                continue;
            }
            double plane = 0.0;
            for (std::size_t i = 0; i < 3; ++i) {
                plane += static_cast<double>(weights[i]) * heights(triangle[i].x, triangle[i].y);
            }
            const double error =
                std::abs(heights(col, row) - plane / static_cast<double>(sign * area));
            if (error > farthest.error) {
                farthest = {{col, row}, error};
            }
        }
    }
    return farthest;
}

std::vector<terrain::SampleTriangle> greedy_triangulation(GridView<const float> heights,
                                                          double error) {
    check(heights.cols() >= 2 && heights.rows() >= 2, "a triangulation needs at least 2x2 samples");
    GreedyMesh mesh(heights);
    mesh.refine(error);
    return mesh.triangles();
}

} // namespace reljef::bench
