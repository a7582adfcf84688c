// The promise of auto:error=PX with costs that make it choose triangles, rays, and both.
#include <utility>

#include <gtest/gtest.h>

#include "engine/render/driver.h"
#include "engine/view/choice/ray_error.h"
#include "engine/view/choice/typical_search.h"
#include "engine/view/error_view.h"
#include "tests/gl/gl_fixture.h"
#include "tests/session/made_session.h"
#include "tests/truth/techniques/error_promise.h"

namespace reljef::truth {
namespace {

class AutomaticErrorGlTest : public test::GlTest {};

constexpr view::TechniqueCosts free_rays{.frame_ms = 0.0,
                                         .triangle_ns = 100.0,
                                         .touched_pixel_ns = 0.0,
                                         .covered_pixel_ns = 1.0,
                                         .rays_ms = 0.0,
                                         .ray_pixel_ns = 0.0};
// A triangle for each ten rays: near tiles have fewer.
constexpr view::TechniqueCosts like_rays{.frame_ms = 0.0,
                                         .triangle_ns = 1000.0,
                                         .touched_pixel_ns = 0.0,
                                         .covered_pixel_ns = 0.0,
                                         .rays_ms = 0.0,
                                         .ray_pixel_ns = 100.0};

Promise automatic_over(terrain::Heightfield heightfield, int poses, unsigned seed,
                       const view::TechniqueCosts& costs, ChanceCamera any_camera = chance_camera) {
    return promise_over(std::move(heightfield), {.poses = poses,
                                                 .seed = seed,
                                                 .terrain = {},
                                                 .technique = "auto:error={}",
                                                 .any_camera = any_camera,
                                                 .costs = costs});
}

terrain::Heightfield nine_tiles() {
    return test::plane_heightfield(test::hills(380, 361, 60.0), {10, 10});
}

// Triangles are cheap over the plain, and rays over the hills.
terrain::Heightfield plain_before_hills() {
    Grid<float> heights = test::hills(380, 361, 60.0);
    for (int row = 200; row < heights.rows(); ++row) {
        std::ranges::fill(heights.row(row), 0.0F);
    }
    return test::plane_heightfield(std::move(heights), {10, 10});
}

// A city of towers up to 140 m high.
terrain::Heightfield towers() {
    return test::plane_heightfield(test::made_heights(300, 300, [](int col, int row) {
        const bool tower = (col / 9 * 7 + row / 11 * 5) % 4 == 0 && col % 9 > 2 && row % 11 > 3;
        return tower ? 140.0 : 0.0;
    }));
}

TEST_F(AutomaticErrorGlTest, NoPixelIsFartherOffWhateverDrawsIt) {
    const Promise rays = automatic_over(nine_tiles(), 30, 1, free_rays);
    expect_kept(rays);
    EXPECT_GT(rays.by_rays, 20);
    const Promise both = automatic_over(plain_before_hills(), 90, 2, like_rays);
    expect_kept(both);
    EXPECT_GT(both.by_both, 10);
    const Promise usual = automatic_over(nine_tiles(), 30, 3, {});
    expect_kept(usual);
    EXPECT_EQ(usual.by_both + usual.by_rays + usual.as_triangles, 30);
}

TEST_F(AutomaticErrorGlTest, NorNearTheGround) {
    expect_kept(automatic_over(nine_tiles(), 40, 4, free_rays, camera_near_the_ground));
    expect_kept(automatic_over(nine_tiles(), 40, 5, like_rays, camera_near_the_ground));
}

// Rays take the walls that triangles miss, seen edge-on from a step away.
TEST_F(AutomaticErrorGlTest, NorBetweenTowersByRays) {
    const Promise rays = automatic_over(towers(), 30, 6, free_rays);
    EXPECT_GT(rays.pixels, 100000);
    EXPECT_EQ(rays.violations, 0);
    EXPECT_EQ(rays.holes, 0);
    EXPECT_GT(rays.by_rays, 20); // the others are so near that triangles state what they keep
}

TEST_F(AutomaticErrorGlTest, NorOnTheEllipsoidWhereItDrawsTrianglesAlone) {
    const Promise promise =
        automatic_over(test::geographic_heightfield(test::hills(161, 140, 600.0), 46.0, 7.0, 0.004),
                       15, 7, free_rays);
    expect_kept(promise);
    EXPECT_EQ(promise.as_triangles, 15);
}

// The largest error of hits by `exact`, as a share of its proven bound at their distances.
double share_of_bound(terrain::Heightfield heightfield, unsigned seed, ChanceCamera any_camera) {
    test::Chance chance(seed);
    scene::Scene scene;
    scene::Node& node = test::add_terrain(scene, std::move(heightfield));
    scene::Node& camera = scene.add_camera();
    node.get<scene::TerrainNode>()->material.technique =
        scene::make_technique(scene::TechniqueId::exact);
    session::SceneRenderer driver = test::must(test::make_renderer(picture));
    const auto& surface = test::surface_of(node);
    double largest = 0.0;
    for (int i = 0; i < 20; ++i) {
        *camera.get<scene::Camera>() = any_camera(chance, surface);
        const HitBuffer hits = test::must(driver.draw_hits(scene));
        const view::RayError bound(scene.camera(), picture, surface, view::steepest(surface),
                                   glm::dvec3(0.0));
        const SurfaceView seen{surface.heightfield().heights.view(), surface.placement(),
                               node.world_from_local(), scene.camera()};
        for (int y = 0; y < picture.y; ++y) {
            for (int x = 0; x < picture.x; ++x) {
                const Hit& hit = hits(x, y);
                if (shows_terrain(hit)) {
                    const double allowed = bound.at(double{hit.depth});
                    const double found = reprojection_error(seen, picture, {x, y}, hit);
                    largest =
                        allowed > view::max_error ? largest : std::max(largest, found / allowed);
                }
            }
        }
    }
    return largest;
}

// Pixels of a picture by a search, and how the search in doubles differs.
struct Searched {
    int pixels = 0; // that show terrain in either
    int others = 0; // whose place is another one
    int within = 0; // of the picture, within a pixel of error
    int within_in_doubles = 0;

    [[nodiscard]] double share(int count) const { return static_cast<double>(count) / pixels; }
};

view::ProbeRay probe_at(const view::DrawList& list, const scene::TerrainSurface& surface,
                        glm::dvec2 pixel) {
    const Ray ray = scene::view_ray(list.camera, list.size, pixel);
    const auto hit = surface.pick(ray);
    return {ray, pixel, hit ? std::optional(hit->sample) : std::nullopt};
}

// Over some views of a terrain.
Searched searched_over(terrain::Heightfield heightfield, const scene::Technique& technique) {
    test::Chance chance(21);
    scene::Scene scene;
    scene::Node& node = test::add_terrain(scene, std::move(heightfield));
    node.get<scene::TerrainNode>()->material.technique = technique;
    scene::Node& camera = scene.add_camera();
    session::SceneRenderer driver = test::must(test::make_renderer(picture));
    const auto& surface = test::surface_of(node);
    Searched searched;
    for (int i = 0; i < 8; ++i) {
        *camera.get<scene::Camera>() = chance_camera(chance, surface);
        view::DrawList list;
        list.camera = scene.camera();
        list.size = picture;
        const view::TypicalSearch search({list.camera, list.size}, surface);
        const HitBuffer hits = test::must(driver.draw_hits(scene));
        for (int pixel = 0; pixel < picture.x * picture.y; pixel += 7) {
            const glm::ivec2 at(pixel % picture.x, pixel / picture.x);
            const glm::dvec2 center = glm::dvec2(at) + 0.5;
            const view::ProbeRay probe = probe_at(list, surface, center);
            const auto place = search.find(technique, probe).place;
            const Hit& hit = hits(at.x, at.y);
            if (!place && !shows_terrain(hit)) {
                continue;
            }
            ++searched.pixels;
            const bool both = place && shows_terrain(hit);
            searched.others += both && glm::distance(*place, hit.place()) < 0.1 ? 0 : 1;
            searched.within +=
                shows_terrain(hit) && search.is_within(probe, hit.place(), 1.0) ? 1 : 0;
            searched.within_in_doubles += place && search.is_within(probe, *place, 1.0) ? 1 : 0;
        }
    }
    return searched;
}

// What probes tell holds for the picture only if they search as it is drawn.
TEST_F(AutomaticErrorGlTest, TypicalSearchesFindWhatIsDrawn) {
    for (const terrain::Heightfield& heightfield : {nine_tiles(), towers()}) {
        for (const scene::Technique& technique : view::typical_searches()) {
            const Searched searched = searched_over(heightfield, technique);
            EXPECT_GT(searched.pixels, 3000);
            if (technique.id() != scene::TechniqueId::interval) {
                // Floats decide otherwise where a step ends on the surface. Graphics processors
                // weigh heights by 8 bits, which moves places of parallax by over a tenth of a
                // sample.
                const bool is_weighed_coarsely =
                    technique.id() == scene::TechniqueId::parallax && draws_on_gpu();
                EXPECT_LE(searched.share(searched.others), is_weighed_coarsely ? 0.06 : 0.005)
                    << scene::to_string(technique);
                continue;
            }
            // The picture begins at beams, the probes at what is known of them.
            EXPECT_NEAR(searched.share(searched.within), searched.share(searched.within_in_doubles),
                        0.02)
                << scene::to_string(technique);
        }
    }
}

TEST_F(AutomaticErrorGlTest, RoundingOfRaysIsWithinItsBoundAtAnyDistance) {
    const auto expect_within = [](const terrain::Heightfield& heightfield, unsigned seed) {
        for (const ChanceCamera any : {chance_camera, camera_near_the_ground}) {
            const double share = share_of_bound(heightfield, seed, any);
            EXPECT_LE(share, 1.0) << seed;
            EXPECT_GT(share, 0.0001) << "a bound that says nothing";
        }
    };
    expect_within(nine_tiles(), 11);
    expect_within(towers(), 12);
    expect_within(test::plane_heightfield(test::hills(200, 161, 3000.0), {90, 90}), 13);
    expect_within(test::plane_heightfield(test::hills(400, 20, 0.1), {500, 500}), 14);
    expect_within(test::plane_heightfield(test::hills(65, 65, 5000.0), {0.1, 0.1}), 15);
}

} // namespace
} // namespace reljef::truth
