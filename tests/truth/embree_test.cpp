// Embree against the same surface. Heights f(col) + g(row) leave every bilinear cell a plane, so
// its two triangles are the cell itself.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/ray_cast.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::truth {
namespace {

// Whole numbers below 128: floats hold every vertex exactly.
Grid<float> planar_cells(int cols, int rows, unsigned seed) {
    test::Chance chance(seed);
    std::array<int, 128> by_col{};
    std::array<int, 128> by_row{};
    for (int i = 0; i < 128; ++i) {
        by_col[static_cast<std::size_t>(i)] = chance.whole(0, 12);
        by_row[static_cast<std::size_t>(i)] = chance.whole(0, 12);
    }
    return test::made_heights(cols, rows, [&](int col, int row) {
        return by_col[static_cast<std::size_t>(col)] + by_row[static_cast<std::size_t>(row)];
    });
}

class EmbreeSurface {
public:
    explicit EmbreeSurface(const Grid<float>& heights)
        : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_.get())) {
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        set_vertices(geometry, heights);
        set_triangles(geometry, heights.cols(), heights.rows());
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_.get(), geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_.get());
    }

    [[nodiscard]] std::optional<double> first_hit(glm::vec3 origin, glm::vec3 direction) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit query{};
        query.ray.org_x = origin.x;
        query.ray.org_y = origin.y;
        query.ray.org_z = origin.z;
        query.ray.dir_x = direction.x;
        query.ray.dir_y = direction.y;
        query.ray.dir_z = direction.z;
        query.ray.tfar = std::numeric_limits<float>::infinity();
        query.ray.mask = ~0U;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_.get(), &context, &query);
        return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::nullopt
                                                           : std::optional<double>(query.ray.tfar);
    }

private:
    static void set_vertices(RTCGeometry geometry, const Grid<float>& heights) {
        auto* vertex = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    3 * sizeof(float), heights.size()));
        for (int row = 0; row < heights.rows(); ++row) {
            for (int col = 0; col < heights.cols(); ++col) {
                *vertex++ = static_cast<float>(col);
                *vertex++ = static_cast<float>(row);
                *vertex++ = heights(col, row);
            }
        }
    }

    static void set_triangles(RTCGeometry geometry, int cols, int rows) {
        const auto cells = static_cast<std::size_t>((cols - 1) * (rows - 1));
        auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), 2 * cells));
        for (int row = 0; row + 1 < rows; ++row) {
            for (int col = 0; col + 1 < cols; ++col) {
                const auto first = static_cast<unsigned>(row * cols + col);
                const auto below = first + static_cast<unsigned>(cols);
                for (const unsigned corner :
                     {first, first + 1, below, first + 1, below + 1, below}) {
                    *index++ = corner;
                }
            }
        }
    }

    struct Release {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };
    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> scene_;
};

// Embree computes in floats: coordinates relative to the ray's origin, below 256, are rounded by at
// most 2^-17 each, and edge products of them in the robust test add a few of these: a hit may lie
// 32 of them off the surface. A ray lifted by that much meets a heightfield later, a lowered one
// earlier: Embree's answer must lie between. A shift of the origin sideways is one of height by the
// steepest slope, 12 to each axis.
constexpr double off_surface = 32.0 * 0x1p-17 * 12.0;

TEST(Embree, AgreesOnTriangulatedCells) {
    test::Chance chance(21);
    int hits = 0;
    for (unsigned field = 0; field < 5; ++field) {
        const Grid<float> heights = planar_cells(chance.whole(2, 100), chance.whole(2, 100), field);
        const terrain::MinMaxPyramid pyramid(heights.view());
        const EmbreeSurface embree(heights);
        for (int i = 0; i < 20000; ++i) {
            // All above, inwards, to somewhere below: floats as they are.
            const glm::vec3 from(chance.between(0.0, heights.cols() - 1),
                                 chance.between(0.0, heights.rows() - 1),
                                 chance.between(25.0, 90.0));
            const glm::vec3 to(chance.between(0.0, heights.cols() - 1),
                               chance.between(0.0, heights.rows() - 1),
                               chance.between(-40.0, -1.0));
            const glm::vec3 way = to - from;
            const auto exact = [&](double lift) {
                return terrain::first_hit(
                    heights.view(), pyramid,
                    {glm::dvec3(from) + glm::dvec3(0.0, 0.0, lift), glm::dvec3(way)}, {0.0, 1.0});
            };
            const auto hit = embree.first_hit(from, way);
            const auto early = exact(-off_surface);
            const auto late = exact(off_surface);
            ASSERT_TRUE(hit && early && late) << field << ' ' << i;
            ASSERT_GE(*hit, early->t - 0x1p-20);
            ASSERT_LE(*hit, late->t + 0x1p-20);
            hits += late->t - early->t < 1e-2 ? 1 : 0;
        }
    }
    EXPECT_GT(hits, 90000) << "the bounds are tight for nearly all";
}

} // namespace
} // namespace reljef::truth
