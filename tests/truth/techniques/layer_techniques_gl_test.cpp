// Sheets and layers on a mesh, against a ray through the layers; and a mesh seen from behind.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/truth/layered_plane.h"
#include "tests/truth/techniques/tile_panel.h"

namespace reljef::truth {
namespace {

class LayerTechniquesGlTest : public test::GlTest {};

std::shared_ptr<const material::ReliefMaterial> layered_set(Grid<glm::vec4> layers) {
    material::ReliefMaterial set = *made_set(Grid<float>(layers.cols(), layers.rows(), 0.5F));
    set.layers = material::LayerMap::create(std::move(layers)).value();
    return std::make_shared<const material::ReliefMaterial>(std::move(set));
}

// Thick and smooth: steps miss nothing of it.
Grid<glm::vec4> layered_waves(int side) {
    const Grid<float> waves = wave_tile(side);
    Grid<glm::vec4> layers(side, side);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const float wave = 0.2F * (waves.samples()[i] - 0.5F);
        layers.samples()[i] = {0.85F + wave, 0.6F - wave, 0.4F + wave, 0.15F - wave};
    }
    return layers;
}

LayeredPlane layers_of(const Panel& panel, material::LayerKind kind) {
    const scene::SurfaceDetail& detail = panel.detail();
    const material::LayerMap layers = material::layers_of(*detail.set, kind);
    return LayeredPlane::create(
               layers.heights().view(),
               {PanelTruth::width_of(detail), detail.scale, detail.offset, detail.border})
        .value();
}

// Whether a local ray meets the square's plane a pixel's breadth inside.
bool crosses_square(const Ray& ray) {
    const glm::dvec3 entry = ray.at(-ray.origin.z / ray.direction.z);
    return std::max(std::abs(entry.x), std::abs(entry.y)) <= 0.5 * plane_side - 0.02;
}

TileErrors layer_errors(const Panel& panel, material::LayerKind kind, const HitBuffer& hits) {
    const PanelTruth place(panel);
    const LayeredPlane truth = layers_of(panel, kind);
    TileErrors errors;
    for (int y = 0; y < hits.rows(); ++y) {
        for (int x = 0; x < hits.cols(); ++x) {
            Ray ray = place.local(
                scene::view_ray(panel.scene.camera(), mesh_picture, {x + 0.5, y + 0.5}));
            if (crosses_square(ray)) {
                ray.origin -= place.middle;
                judge(hits(x, y), truth.first_hit(ray), panel, errors);
            }
        }
    }
    return errors;
}

TEST_F(LayerTechniquesGlTest, FourLayerHitsAreThoseOfARayAgainstTheLayersFromEitherSide) {
    for (const WrapMode border : {WrapMode::wrap, WrapMode::clamp, WrapMode::discard}) {
        Panel panel(Grid<float>(32, 32, 0.5F));
        panel.detail().set = layered_set(layered_waves(32));
        panel.detail().border = border;
        panel.detail().offset = -0.5F;
        for (const glm::dvec3 eye : {glm::dvec3(0.3, -4.0, 3.0), glm::dvec3(0.3, -3.0, -4.0)}) {
            panel.look(eye, {0.1, 0.0, 0.0});
            const TileErrors found = layer_errors(panel, material::LayerKind::multi,
                                                  panel.hits("multi-layer:n=128,k=10"));
            EXPECT_GT(found.pixels, 5000);
            EXPECT_LE(found.wrong_percent(), 0.05) << "from " << eye.z;
            EXPECT_LT(found.rms(), 0.01);
            EXPECT_LE(found.depth, 1e-3);
        }
    }
}

TEST_F(LayerTechniquesGlTest, MoreStepsFindMoreOfWhatIsThin) {
    Panel panel(Grid<float>(16, 16, 0.5F));
    panel.detail().set = layered_set(layered_noise(16, 16, 31));
    double before = 100.0;
    for (const int n : {8, 32, 128, 512}) {
        const double wrong = layer_errors(panel, material::LayerKind::multi,
                                          panel.hits("multi-layer:k=8,n=" + std::to_string(n)))
                                 .wrong_percent();
        EXPECT_LE(wrong, before + 0.05) << n;
        before = wrong;
    }
    EXPECT_LT(before, 0.3);
}

TEST_F(LayerTechniquesGlTest, MultiLayerOnAHeightMapIsItsRelief) {
    Panel panel(wave_tile(32));
    const TileErrors found = tile_errors(panel, panel.hits("multi-layer:n=128,k=10"));
    EXPECT_LE(found.wrong_percent(), 0.05);
    EXPECT_LT(found.rms(), 0.01);
}

// Wires 3 texels wide every 8, thick in their middle.
Grid<float> wire_tile() {
    Grid<float> heights(32, 32, 0.0F);
    for (int row = 0; row < 32; ++row) {
        for (int col = 0; col < 32; ++col) {
            const int off = std::min(col % 8, row % 8);
            heights(col, row) = off == 1 ? 1.0F : (off < 3 ? 0.6F : 0.0F);
        }
    }
    return heights;
}

TEST_F(LayerTechniquesGlTest, ALatticesHolesAreHolesAndItsWiresAreNot) {
    Panel panel(wire_tile());
    panel.detail().offset = -0.5F;
    for (const glm::dvec3 eye :
         {glm::dvec3(0.1, -0.2, 6.0), glm::dvec3(0.3, -3.0, 3.0), glm::dvec3(0.2, -0.1, -6.0)}) {
        panel.look(eye, {0.1, 0.0, 0.0});
        const HitBuffer hits = panel.hits("lattice:n=64,k=8");
        const TileErrors found = layer_errors(panel, material::LayerKind::symmetric, hits);
        EXPECT_LE(found.wrong_percent(), 0.1) << "from " << eye.z;
        const auto holes = std::count_if(hits.samples().begin(), hits.samples().end(),
                                         [](const Hit& hit) { return hit.is_sky(); });
        EXPECT_GT(holes, 1000);
        EXPECT_GT(found.compared, 2000);
    }
}

// Seen from beneath the back is what the front would be if the two changed places.
TEST_F(LayerTechniquesGlTest, DualLayersBackFaceIsTheOtherMap) {
    material::ReliefMaterial set = *made_set(wave_tile(32));
    set.back_heights = noise_tile(32, 32, 33);
    material::ReliefMaterial turned = *made_set(noise_tile(32, 32, 33));
    turned.back_heights = wave_tile(32);
    Panel panel(wave_tile(32));
    panel.detail().offset = -0.5F;
    panel.detail().set = std::make_shared<const material::ReliefMaterial>(set);
    panel.look({0.2, -3.0, -4.0}, {0.1, 0.2, 0.0});
    const HitBuffer back = panel.hits("dual-layer:n=64,k=8");
    EXPECT_LE(layer_errors(panel, material::LayerKind::dual, back).wrong_percent(), 0.5);
    panel.detail().set = std::make_shared<const material::ReliefMaterial>(turned);
    panel.look({0.2, -3.0, 4.0}, {0.1, 0.2, 0.0});
    const HitBuffer front = panel.hits("dual-layer:n=64,k=8");
    int different = 0;
    for (int y = 0; y < front.rows(); ++y) {
        for (int x = 0; x < front.cols(); ++x) {
            const Hit& one = front(x, y);
            const Hit& other = back(x, front.rows() - 1 - y); // mirrored in the plane
            const bool same =
                one.is_sky() == other.is_sky() &&
                (one.is_sky() || (std::abs(one.col - other.col) < 0.05F &&
                                  std::abs(one.height + other.height - 1.0F) < 0.01F));
            different += same ? 0 : 1;
        }
    }
    EXPECT_LT(different, 100);
}

Grid<float> inverted(Grid<float> heights) {
    for (float& height : heights.samples()) {
        height = 1.0F - height;
    }
    return heights;
}

// A mesh seen from behind, and the mirrored mesh with the inverted heights from before; both lit
// from the eye's side, by nothing else.
std::pair<Panel, Panel> mirrored_panels() {
    std::pair<Panel, Panel> panels(Panel(wave_tile(32)), Panel(inverted(wave_tile(32))));
    panels.first.detail().offset = -0.3F;
    panels.second.detail().offset = -0.7F;
    panels.first.look({0.3, -4.0, -3.0}, {0.1, 0.0, 0.0});
    panels.second.look({0.3, -4.0, 3.0}, {0.1, 0.0, 0.0});
    const scene::Light light{
        .azimuth = 250.0, .altitude = 35.0, .color = glm::vec3(1.0F), .ambient = glm::vec3(0.0F)};
    scene::Light mirrored = light;
    mirrored.altitude = -light.altitude;
    panels.first.scene.add_light(mirrored);
    panels.second.scene.add_light(light);
    return panels;
}

constexpr std::array two_sided_techniques{"parallax",
                                          "parallax-limited",
                                          "parallax-iterated",
                                          "steep",
                                          "relief",
                                          "interval",
                                          "pom",
                                          "cone",
                                          "exact"};

TEST_F(LayerTechniquesGlTest, FrontAndBackAreMirrorImages) {
    const auto panels = mirrored_panels();
    for (const std::string id : two_sided_techniques) {
        const HitBuffer back = panels.first.hits(id + ":sides=two");
        const HitBuffer front = panels.second.hits(id + ":sides=two");
        int shown = 0;
        for (int y = 0; y < front.rows(); ++y) {
            for (int x = 0; x < front.cols(); ++x) {
                const Hit& one = front(x, y);
                const Hit& other = back(x, front.rows() - 1 - y);
                ASSERT_EQ(one.is_sky(), other.is_sky()) << id << ' ' << x << ' ' << y;
                if (!one.is_sky()) {
                    ++shown;
                    ASSERT_NEAR(one.col, other.col, 0.01) << id; // a bracket of the steps
                    ASSERT_NEAR(one.row, other.row, 0.01) << id;
                    ASSERT_NEAR(one.height, 1.0F - other.height, 1e-3) << id;
                    ASSERT_NEAR(one.depth, other.depth, 1e-3) << id;
                }
            }
        }
        EXPECT_GT(shown, 5000) << id;
    }
}

TEST_F(LayerTechniquesGlTest, BothSidesAreLitAlike) {
    const auto panels = mirrored_panels();
    for (const char* technique : {"relief:sides=two", "exact:sides=two,shadow=hard",
                                  "relief:sides=two,shadow=soft,edges=smooth"}) {
        const Image back = panels.first.picture(technique);
        const Image front = panels.second.picture(technique);
        int different = 0;
        int lit = 0;
        for (int y = 0; y < front.rows(); ++y) {
            for (int x = 0; x < front.cols(); ++x) {
                const Rgba8 one = front(x, y);
                const Rgba8 other = back(x, front.rows() - 1 - y);
                lit += one.r > 40 ? 1 : 0;
                different += std::abs(one.r - other.r) > 2 ? 1 : 0;
            }
        }
        EXPECT_GT(lit, 3000) << technique;
        EXPECT_LT(different, 30) << technique;
    }
}

TEST_F(LayerTechniquesGlTest, WithoutTwoSidesNothingIsSeenFromBehind) {
    Panel panel(wave_tile(32));
    panel.look({0.3, -4.0, -3.0}, {0.1, 0.0, 0.0});
    const HitBuffer hits = panel.hits("relief");
    EXPECT_TRUE(std::all_of(hits.samples().begin(), hits.samples().end(),
                            [](const Hit& hit) { return hit.is_sky(); }));
}

// A layer lies in the shadow of the one above it, and its back is lit from behind.
TEST_F(LayerTechniquesGlTest, TheUpperLayerThrowsAShadowOnTheLower) {
    Grid<glm::vec4> layers(32, 32, glm::vec4(0.9F, 0.9F, 0.3F, 0.0F));
    for (int row = 0; row < 32; ++row) {
        for (int col = 0; col < 16; ++col) {
            layers(col, row) = {1.0F, 0.8F, 0.3F, 0.0F};
        }
    }
    Panel panel(Grid<float>(32, 32, 0.5F), 1.0F);
    panel.detail().set = layered_set(std::move(layers));
    panel.detail().scale = 0.3F;
    panel.look({0.0, 0.0, 6.0}, {0.0, 0.001, 0.0});
    panel.scene.add_light(
        {.azimuth = 270.0, .altitude = 45.0, .color = glm::vec3(1.0F), .ambient = glm::vec3(0.0F)});
    // Lower by 0.7 of 1.8 m, so the shadow's edge lies 1.26 m to the east of the upper's.
    const auto lit_share = [&](const std::string& technique) {
        const Image picture = panel.picture(technique);
        int lit = 0;
        int dark = 0;
        for (int x = mesh_picture.x / 2; x < mesh_picture.x; ++x) {
            const Rgba8 color = picture(x, mesh_picture.y / 2);
            lit += color.r > 60 ? 1 : 0;
            dark += color.r < 10 && color.a > 0 ? 1 : 0;
        }
        return static_cast<double>(dark) / (lit + dark);
    };
    const double unshadowed = lit_share("multi-layer");
    EXPECT_LT(unshadowed, 0.4); // beyond the square nothing is drawn: it is dark, too
    EXPECT_GT(lit_share("multi-layer:shadow=hard"), unshadowed + 0.15);
}

// Cones over a tile and its copies lead to the surface, in few steps.
TEST_F(LayerTechniquesGlTest, ConesOverATileLeadToItsSurfaceBeyondEveryBorder) {
    for (const auto& [border, technique] :
         {std::pair{WrapMode::wrap, "cone:n=128,k=8,step=0"},
          std::pair{WrapMode::wrap, "cone:relaxed=0,n=256,step=0"},
          std::pair{WrapMode::clamp, "cone:n=128,k=8,step=0"},
          std::pair{WrapMode::discard, "cone:n=128,k=8,step=0"}}) {
        Panel panel(wave_tile(32));
        panel.detail().border = border;
        const TileErrors found = tile_errors(panel, panel.hits(technique));
        EXPECT_LE(found.wrong_percent(), 0.1) << technique << static_cast<int>(border);
        EXPECT_LT(found.rms(), 0.05) << technique << static_cast<int>(border);
    }
    Panel panel(noise_tile(16, 16, 35));
    const TileErrors found = tile_errors(panel, panel.hits("cone:n=64,step=0"));
    EXPECT_LE(found.wrong_percent(), 2.0);
}

} // namespace
} // namespace reljef::truth
