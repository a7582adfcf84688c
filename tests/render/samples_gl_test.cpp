// Several samples a pixel: pictures come closer to what a pixel's area shows.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "engine/material/relief_material.h"
#include "engine/render/passes/sample_target.h"
#include "engine/scene/graph/terrain_base.h"
#include "engine/scene/technique/technique.h"
#include "engine/view/sample_count.h"
#include "tests/render/driver_fixture.h"

namespace reljef::render {
namespace {

TEST(SamplePlans, TakeAsManySamplesAtOnceAsTheRendererCan) {
    const std::array software{1, 4};
    const std::array hardware{1, 2, 4, 8};
    EXPECT_EQ(plan_samples(1, software).value(), (SamplePlan{1, 1}));
    EXPECT_EQ(plan_samples(2, software).value(), (SamplePlan{1, 2}));
    EXPECT_EQ(plan_samples(4, software).value(), (SamplePlan{4, 1}));
    EXPECT_EQ(plan_samples(8, software).value(), (SamplePlan{4, 2}));
    EXPECT_EQ(plan_samples(16, software).value(), (SamplePlan{4, 4}));
    EXPECT_EQ(plan_samples(8, hardware).value(), (SamplePlan{8, 1}));
    EXPECT_EQ(plan_samples(16, hardware).value(), (SamplePlan{8, 2}));
}

TEST(SamplePlans, MoreThanFourPassesAreRefused) {
    const std::array one{1};
    EXPECT_EQ(plan_samples(4, one).value(), (SamplePlan{1, 4}));
    const auto refused = plan_samples(16, one);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message,
              "picture with 16 samples a pixel: expected at most 4 with this renderer");
}

TEST(SamplePlans, PassesShareThePixelsRowsAndColumnsEvenly) {
    for (const int at_once : {1, 4, 8}) {
        for (const int passes : {1, 2, 4}) {
            std::set<double> columns;
            std::set<double> rows;
            glm::dvec2 sum(0.0);
            for (int pass = 0; pass < passes; ++pass) {
                const glm::dvec2 shift = pass_shift({at_once, passes}, pass);
                EXPECT_LT(std::max(std::abs(shift.x), std::abs(shift.y)), 0.5 / at_once);
                EXPECT_EQ(shift * 256.0, glm::round(shift * 256.0));
                columns.insert(std::floor((shift.x * at_once + 0.5) * passes));
                rows.insert(std::floor((shift.y * at_once + 0.5) * passes));
                sum += shift;
            }
            EXPECT_EQ(sum, glm::dvec2(0.0)) << "the picture does not move";
            EXPECT_EQ(columns.size(), static_cast<std::size_t>(passes));
            EXPECT_EQ(rows.size(), static_cast<std::size_t>(passes));
        }
    }
}

// The largest error of a pixel's share that a straight edge leaves, by the samples: by trying.
double error_of(int samples) {
    return samples < 4 ? 0.5 : samples == 4 ? 0.31 : samples == 8 ? 0.28 : 0.24;
}

// Where a half-plane's edge runs over the picture, pixels right and down.
struct Edge {
    glm::dvec2 normal{1.0, 0.0}; // out of the half-plane, unit length
    double distance = 0.0;       // from the upper left corner

    [[nodiscard]] double outside(glm::dvec2 place) const {
        return glm::dot(normal, place) - distance;
    }

    // Share of a pixel's square that lies in the half-plane.
    [[nodiscard]] double coverage(glm::dvec2 corner) const {
        const std::array<glm::dvec2, 4> square{corner, corner + glm::dvec2(1.0, 0.0), corner + 1.0,
                                               corner + glm::dvec2(0.0, 1.0)};
        std::vector<glm::dvec2> left;
        for (std::size_t i = 0; i < square.size(); ++i) {
            const glm::dvec2 from = square[i];
            const glm::dvec2 to = square[(i + 1) % square.size()];
            if (outside(from) <= 0.0) {
                left.push_back(from);
            }
            if ((outside(from) < 0.0) != (outside(to) < 0.0)) {
                const double part = outside(from) / (outside(from) - outside(to));
                left.push_back(from + part * (to - from));
            }
        }
        double area = 0.0;
        for (std::size_t i = 0; i < left.size(); ++i) {
            const glm::dvec2 a = left[i];
            const glm::dvec2 b = left[(i + 1) % left.size()];
            area += 0.5 * (a.x * b.y - b.x * a.y);
        }
        return std::abs(area);
    }
};

constexpr glm::ivec2 small{64, 48};

// A white half-plane seen from above, a pixel a metre.
Scene half_plane(const Edge& edge) {
    const glm::dvec2 middle = 0.5 * glm::dvec2(small);
    const glm::dvec2 on_edge = edge.distance * edge.normal - middle;
    const glm::dvec2 along(-edge.normal.y, edge.normal.x);
    constexpr double reach = 200.0;
    scene::Mesh mesh;
    for (const glm::dvec2 corner : {on_edge - reach * along, on_edge + reach * along,
                                    on_edge + reach * along - reach * edge.normal,
                                    on_edge - reach * along - reach * edge.normal}) {
        mesh.positions.emplace_back(corner.x, -corner.y, 0.0);
        mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
        mesh.texture_coordinates.emplace_back(0.0F);
    }
    mesh.indices = {0, 2, 1, 0, 3, 2};
    if (glm::cross(mesh.positions[2] - mesh.positions[0], mesh.positions[1] - mesh.positions[0]).z <
        0.0F) {
        mesh.indices = {0, 1, 2, 0, 2, 3};
    }
    Scene scene;
    scene::Material white;
    white.color = glm::vec3(1.0F);
    scene.add_mesh(std::move(mesh), white);
    Camera camera = camera_at({0.0, 0.0, 10.0}, {0.0, 0.0, 0.0});
    camera.projection = scene::ProjectionKind::orthographic;
    camera.view_height = small.y;
    scene.add_camera(camera);
    return scene;
}

class SamplesGlTest : public DriverGlTest {
protected:
    static session::SceneRenderer driver_of(int samples, glm::ivec2 picture = size) {
        return test::must(session::SceneRenderer::create(
            {.opengl =
                 render::DriverOptions{.size = picture, .shader_dir = {}, .samples = samples}}));
    }
    static Image drawn(const Scene& scene, int samples, glm::ivec2 picture = size) {
        session::SceneRenderer made = driver_of(samples, picture);
        test::must(made.draw(scene));
        return made.read_color();
    }
};

// What the pixels that an edge runs through are brighter, in linear light, than the shares of them
// that it leaves.
struct EdgeErrors {
    int pixels = 0;
    double sum = 0.0;
    double most = 0.0;   // of their absolute values
    double beside = 0.0; // the most elsewhere, where there should be none
};

void add_errors(const Image& picture, const Edge& edge, EdgeErrors& errors) {
    for (int row = 0; row < picture.rows(); ++row) {
        for (int col = 0; col < picture.cols(); ++col) {
            const double share = edge.coverage({col, row});
            const double error = linear_from_rgba8(picture(col, row)).r - share;
            if (share > 0.0 && share < 1.0) {
                ++errors.pixels;
                errors.sum += error;
                errors.most = std::max(errors.most, std::abs(error));
            } else {
                errors.beside = std::max(errors.beside, std::abs(error));
            }
        }
    }
}

TEST_F(SamplesGlTest, AnEdgeIsAsBrightAsTheShareOfThePixelInLinearLight) {
    for (const int samples : {2, 4, 8, 16}) {
        session::SceneRenderer made = driver_of(samples, small);
        EdgeErrors errors;
        // Over many edges any places of the samples are right in the mean.
        for (int i = 0; i < 24; ++i) {
            const double angle = 0.1 + 0.26 * i;
            const glm::dvec2 normal(std::cos(angle), std::sin(angle));
            const Edge edge{normal, glm::dot(normal, glm::dvec2(31.3 + 0.07 * i, 23.6))};
            const Scene scene = half_plane(edge);
            test::must(made.draw(scene));
            add_errors(made.read_color(), edge, errors);
        }
        EXPECT_GT(errors.pixels, 300);
        EXPECT_LE(errors.most, error_of(samples) + 0.02) << samples;
        EXPECT_NEAR(errors.sum / errors.pixels, 0.0, 0.02) << samples;
        EXPECT_LE(errors.beside, 1e-6) << samples;
    }
}

// Root mean square of what the colours, in linear light, are off the mean of many small pixels.
double error_against(const Image& picture, const Image& fine) {
    const int times = fine.cols() / picture.cols();
    double squares = 0.0;
    for (int row = 0; row < picture.rows(); ++row) {
        for (int col = 0; col < picture.cols(); ++col) {
            glm::dvec3 sum(0.0);
            for (int down = 0; down < times; ++down) {
                for (int right = 0; right < times; ++right) {
                    sum += glm::dvec3(
                        linear_from_rgba8(fine(col * times + right, row * times + down)));
                }
            }
            const glm::dvec3 off =
                glm::dvec3(linear_from_rgba8(picture(col, row))) - sum / (1.0 * times * times);
            squares += glm::dot(off, off);
        }
    }
    return std::sqrt(squares / (picture.cols() * picture.rows()));
}

constexpr int fine_times = 8;

// Whatever draws a scene: more samples come closer to the mean of many.
void expect_closer_with_samples(const Scene& scene, const std::string& what) {
    const auto drawn = [&](int samples, glm::ivec2 picture) {
        session::SceneRenderer made = test::must(session::SceneRenderer::create(
            {.opengl =
                 render::DriverOptions{.size = picture, .shader_dir = {}, .samples = samples}}));
        test::must(made.draw(scene));
        return made.read_color();
    };
    constexpr glm::ivec2 picture{96, 72};
    const Image fine = drawn(1, picture * fine_times);
    const double one = error_against(drawn(1, picture), fine);
    EXPECT_GT(one, 0.01) << what;
    EXPECT_LT(error_against(drawn(2, picture), fine), 0.85 * one) << what;
    EXPECT_LT(error_against(drawn(4, picture), fine), 0.55 * one) << what;
    EXPECT_LT(error_against(drawn(8, picture), fine), 0.5 * one) << what;
    EXPECT_LT(error_against(drawn(16, picture), fine), 0.45 * one) << what;
}

TEST_F(SamplesGlTest, OutlinesOfATerrainAreSmoothWithEveryTechnique) {
    Scene scene;
    Node& terrain = test::add_terrain(scene, test::plane_heightfield(test::hills(101, 101, 25.0)),
                                      Image(101, 101, Rgba8{230, 230, 230, 255}));
    Camera camera = camera_at({-80.0, -90.0, 25.0}, {0.0, 0.0, 5.0});
    scene.add_camera(camera);
    for (const std::string technique : {"polygons", "texture", "exact", "relief:n=64,k=8",
                                        "interval:n=128,k=4", "exact:depth=write"}) {
        const auto parsed = scene::parse_technique(technique);
        ASSERT_TRUE(parsed) << parsed.error().message;
        terrain.get<scene::TerrainNode>()->material.technique = *parsed;
        expect_closer_with_samples(scene, technique);
    }
}

// Waves that reach from the highest to the lowest heights; half of them of another colour.
std::shared_ptr<const material::ReliefMaterial> waves(Rgba8 front = {230, 230, 230, 255}) {
    constexpr int side = 32;
    material::ReliefMaterial set;
    set.name = "made";
    set.heights = Grid<float>(side, side);
    const double step = 2.0 * std::acos(-1.0) / side;
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            set.heights(col, row) =
                static_cast<float>(0.5 + 0.5 * std::sin(step * col) * std::cos(step * row));
        }
    }
    set.color = Image(4, 4, Rgba8{230, 230, 230, 255});
    for (int col = 0; col < 4; ++col) {
        set.color(col, 0) = set.color(col, 1) = front;
    }
    set.scale = 0.2F;
    return std::make_shared<const material::ReliefMaterial>(
        material::completed(std::move(set), material::WrapMode::wrap).value());
}

TEST_F(SamplesGlTest, OutlinesOfMeshesAreSmoothWithEveryTechnique) {
    Scene scene;
    scene::Material material;
    material.detail.set = waves();
    material.detail.scale = 0.2F;
    material.detail.repeats = glm::vec2(6.0F, 3.0F);
    Node& node = scene.add_mesh(scene::sphere_mesh(1.0F), material);
    scene.add_camera(camera_at({0.3, -2.2, 0.7}, {0.0, 0.0, 0.0}));
    for (const std::string technique :
         {"normal", "displacement", "relief:n=32,k=8", "exact:silhouettes=true"}) {
        const auto parsed = scene::parse_technique(technique);
        ASSERT_TRUE(parsed) << parsed.error().message;
        node.get<scene::MeshNode>()->material.technique = *parsed;
        expect_closer_with_samples(scene, technique);
    }
}

TEST_F(SamplesGlTest, EachSampleOfASurfaceThatIsLookedForHasARayOfItsOwn) {
    // The mesh that carries the tile fills the picture: only rays meet edges.
    Scene scene;
    scene::Material material;
    material.detail.set = waves({20, 40, 60, 255});
    material.detail.scale = 0.4F;
    material.detail.repeats = glm::vec2(12.0F);
    material.technique = scene::parse_technique("exact").value();
    scene.add_mesh(scene::plane_mesh(glm::vec2(100.0F)), material);
    Camera camera = camera_at({3.0, -15.0, 9.0}, {0.0, 0.0, 0.0});
    camera.vertical_fov = 30.0;
    scene.add_camera(camera);
    constexpr glm::ivec2 picture{96, 72};
    const Image fine = drawn(scene, 1, picture * fine_times);
    const double one = error_against(drawn(scene, 1, picture), fine);
    EXPECT_GT(one, 0.01);
    EXPECT_LT(error_against(drawn(scene, 4, picture), fine), 0.6 * one);
}

// Rays begin where the beam of their block of pixels may first meet something: a beam that did not
// hold all samples' rays would pass over what these meet.
TEST_F(SamplesGlTest, BeamsHoldTheRaysOfAllSamples) {
    Scene scene;
    Image stripes(200, 200, Rgba8{230, 230, 230, 255});
    for (int row = 0; row < 200; ++row) {
        for (int col = row % 4; col < 200; col += 4) {
            stripes(col, row) = {20, 40, 60, 255};
        }
    }
    Node& terrain = test::add_terrain(
        scene, test::plane_heightfield(test::random_heights(200, 200, 0.0F, 30.0F, 9)), stripes);
    scene.add_camera(camera_at({-60.0, -70.0, 230.0}, {0.0, 0.0, 15.0}));
    auto& technique = terrain.get<scene::TerrainNode>()->material.technique;
    for (const int samples : {1, 2, 4, 16}) {
        technique = scene::parse_technique("exact").value();
        const Image with_beams = drawn(scene, samples);
        technique = scene::parse_technique("exact:fade=1..1,1").value(); // the same without them
        const Image without = drawn(scene, samples);
        int others = 0;
        for (std::size_t i = 0; i < without.size(); ++i) {
            const int off = with_beams.samples()[i].r - without.samples()[i].r;
            others += std::abs(off) > 2 ? 1 : 0;
        }
        EXPECT_LE(others, 2) << samples; // rounding
    }
}

std::vector<glm::vec4> numbers_of(const HitBuffer& hits) {
    std::vector<glm::vec4> numbers;
    for (const Hit& hit : hits.samples()) {
        numbers.emplace_back(hit.col, hit.row, hit.height, hit.depth);
    }
    return numbers;
}

TEST_F(SamplesGlTest, HitsAreThoseOfThePixelsCentresWhateverTheSamples) {
    World world;
    auto& technique = world.terrain->get<scene::TerrainNode>()->material.technique;
    for (const std::string name : {"polygons", "exact"}) {
        technique = scene::parse_technique(name).value();
        session::SceneRenderer one = driver();
        const auto expected = numbers_of(test::must(one.draw_hits(world.scene)));
        for (const int samples : {4, 8, view::automatic_samples}) {
            session::SceneRenderer made = driver_of(samples);
            EXPECT_EQ(numbers_of(test::must(made.draw_hits(world.scene))), expected)
                << name << samples;
            test::must(made.draw(world.scene));
            EXPECT_EQ(numbers_of(test::must(made.draw_hits(world.scene))), expected)
                << name << samples;
        }
    }
}

TEST_F(SamplesGlTest, TheSameViewGivesTheSamePictureAgain) {
    World world;
    for (const int samples : {1, 2, 4, 16}) {
        session::SceneRenderer made = driver_of(samples);
        const view::FrameStats stats = test::must(made.draw(world.scene));
        const Image first = made.read_color();
        const view::FrameStats again = test::must(made.draw(world.scene));
        EXPECT_EQ(again.skipped.selections_unchanged, 1);
        EXPECT_EQ(again.triangles, stats.triangles);
        EXPECT_EQ(made.read_color(), first) << samples;
        for (const Rgba8& pixel : first.samples()) {
            ASSERT_EQ(pixel.a, 255);
        }
    }
}

TEST_F(SamplesGlTest, AutomaticIsFourForTrianglesAndOneForRays) {
    World world;
    auto& technique = world.terrain->get<scene::TerrainNode>()->material.technique;
    technique = scene::parse_technique("polygons").value();
    EXPECT_EQ(drawn(world.scene, view::automatic_samples), drawn(world.scene, 4));
    technique = scene::parse_technique("exact").value();
    EXPECT_EQ(drawn(world.scene, view::automatic_samples), drawn(world.scene, 1));
    auto& node = *world.terrain->get<scene::TerrainNode>();
    const scene::TerrainSurface& surface = *node.surface;
    scene::MeshNode walls;
    walls.mesh = std::make_shared<const scene::Mesh>(
        scene::terrain_base(surface, scene::block_bottom(surface)).value());
    node.base = std::make_shared<const scene::MeshNode>(walls);
    EXPECT_EQ(drawn(world.scene, view::automatic_samples), drawn(world.scene, 1))
        << "walls below rays";
    world.scene.add_mesh(scene::sphere_mesh(20.0F));
    EXPECT_EQ(drawn(world.scene, view::automatic_samples), drawn(world.scene, 4));
}

TEST_F(SamplesGlTest, AResizedOneHasItsSamples) {
    World world;
    for (const int samples : {4, 8}) {
        session::SceneRenderer made = driver_of(samples, {100, 50});
        test::must(made.draw(world.scene));
        ASSERT_TRUE(made.resize(size));
        test::must(made.draw(world.scene));
        EXPECT_EQ(made.read_color(), drawn(world.scene, samples));
    }
}

TEST_F(SamplesGlTest, OtherNumbersAreAnError) {
    for (const int samples : {-1, 3, 5, 32}) {
        const auto made = Driver::create({.size = size, .shader_dir = {}, .samples = samples});
        ASSERT_FALSE(made);
        EXPECT_EQ(made.error().message, "picture with " + std::to_string(samples) +
                                            " samples a pixel: expected 1, 2, 4, 8 or 16");
    }
}

// Of a plane that is seen all but edge-on, a pixel shows metres or, beyond its far border, where
// the pixel's centre may lie, any distance.
TEST_F(SamplesGlTest, PartlyCoveredPixelsShowNothingFromBeyondTheBorder) {
    Scene scene;
    scene::Material white;
    white.color = glm::vec3(1.0F);
    scene.add_mesh(scene::plane_mesh(glm::vec2(1000.0F)), white);
    Node& camera = scene.add_camera();
    scene::Sky black{.zenith = glm::vec3(0.0F), .horizon = glm::vec3(0.0F)};
    constexpr double border = 1000.0; // metres from the eye, and the plane's width more
    constexpr double a_pixel = 0.0228;
    session::SceneRenderer made = driver_of(4, small);
    int partly = 0;
    for (double part = 0.0; part < 1.0; part += 0.1) {
        *camera.get<Camera>() =
            camera_at({0.0, -500.0, 1.0}, {0.0, 0.0, 1.0 + part * a_pixel * 500.0});
        black.visibility = 0.0;
        scene.set_sky(black);
        test::must(made.draw(scene));
        const Image clear = made.read_color();
        black.visibility = 10.0 * border;
        scene.set_sky(black);
        test::must(made.draw(scene));
        const Image hazy = made.read_color();
        const double left = std::exp(-scene::extinction(black) * 1.2 * border);
        for (std::size_t i = 0; i < clear.size(); ++i) {
            const float share = linear_from_rgba8(clear.samples()[i]).r;
            const float seen = linear_from_rgba8(hazy.samples()[i]).r;
            ASSERT_LE(seen, share + 0.01);
            ASSERT_GE(seen, share * left - 0.01) << "of " << share << " at " << part;
            partly += share > 0.0F && share < 1.0F ? 1 : 0;
        }
    }
    EXPECT_GT(partly, 100);
}

} // namespace
} // namespace reljef::render
