// The outlines of relief on meshes, drawn through a hull around it, against the exact relief.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "engine/render/residency/hull_mesh.h"
#include "tests/session/made_session.h"
#include "tests/support/release_only.h"
#include "tests/truth/techniques/tile_panel.h"

namespace reljef::truth {
namespace {

class SilhouettesGlTest : public test::GlTest {};

// Every pixel, beside the square too: the first of what the reliefs show, each in its own frame.
struct PlacedRelief {
    ReliefPlane relief;
    glm::dmat4 local_from_world{1.0};

    [[nodiscard]] std::optional<ReliefHit> first_hit(const Ray& ray) const {
        return relief.first_hit({glm::dvec3(local_from_world * glm::dvec4(ray.origin, 1.0)),
                                 glm::dvec3(local_from_world * glm::dvec4(ray.direction, 0.0))});
    }
};

std::optional<ReliefHit> first_of(const std::vector<PlacedRelief>& reliefs, const Ray& ray) {
    std::optional<ReliefHit> first;
    for (const PlacedRelief& placed : reliefs) {
        const auto met = placed.first_hit(ray);
        first = met && (!first || met->t < first->t) ? met : first;
    }
    return first;
}

TileErrors errors_everywhere(const Panel& panel, const std::vector<PlacedRelief>& reliefs,
                             const HitBuffer& hits) {
    TileErrors errors;
    for (int y = 0; y < hits.rows(); ++y) {
        for (int x = 0; x < hits.cols(); ++x) {
            const Ray ray = scene::view_ray(panel.scene.camera(), mesh_picture, {x + 0.5, y + 0.5});
            const auto first = first_of(reliefs, ray);
            if (first || !hits(x, y).is_sky()) {
                judge(hits(x, y), first, panel, errors);
            }
        }
    }
    return errors;
}

// One tile over the whole square.
Panel bordered_panel(Grid<float> heights, float offset,
                     std::shared_ptr<session::SceneRenderer> driver = panel_driver()) {
    Panel panel(std::move(heights), 1.0F, std::move(driver));
    panel.detail().border = WrapMode::discard;
    panel.detail().offset = offset;
    return panel;
}

TEST_F(SilhouettesGlTest, APlaneHasTheOutlineAndTheDepthOfItsRelief) {
    RELJEF_RELEASE_ONLY("the box is six planes");
    const auto driver = panel_driver();
    for (const MadeTile& tile : hard_tiles()) {
        for (const float offset : {tile.heights.cols() > 16 ? -1.0F : 0.0F}) {
            Panel panel = bordered_panel(tile.heights, offset, driver);
            const std::vector<PlacedRelief> relief{{PanelTruth::relief_of(panel)}};
            for (const glm::dvec3 eye : {glm::dvec3(0.3, -6.0, 2.5), glm::dvec3(-7.0, -1.0, 0.9)}) {
                panel.look(eye, {0.0, 0.0, 0.0});
                const TileErrors found =
                    errors_everywhere(panel, relief, panel.hits("exact:silhouettes=true"));
                EXPECT_GT(found.pixels, 200) << tile.name;
                EXPECT_LE(found.wrong_percent(), 0.3) << tile.name << ' ' << offset << ' ' << eye.z;
                EXPECT_LE(found.depth, 1e-3) << tile.name;
            }
        }
    }
}

// The frame of a box's side: as ReliefPlane has it, from its texture coordinates.
glm::dmat4 side_frame(const scene::Mesh& box, std::size_t first) {
    const auto vertex = [&](std::size_t i) { return box.indices[first + i]; };
    const glm::dvec3 origin(box.positions[vertex(0)]);
    const glm::dvec2 corner(box.texture_coordinates[vertex(0)]);
    const glm::dmat2 coordinates(glm::dvec2(box.texture_coordinates[vertex(1)]) - corner,
                                 glm::dvec2(box.texture_coordinates[vertex(2)]) - corner);
    const glm::dmat2x3 edges(glm::dvec3(box.positions[vertex(1)]) - origin,
                             glm::dvec3(box.positions[vertex(2)]) - origin);
    const glm::dmat2x3 along = edges * glm::inverse(coordinates);
    const glm::dvec3 middle = origin + along * (glm::dvec2(0.5) - corner);
    return {glm::dvec4(glm::normalize(along[0]), 0.0), glm::dvec4(-glm::normalize(along[1]), 0.0),
            glm::dvec4(glm::dvec3(box.normals[vertex(0)]), 0.0), glm::dvec4(middle, 1.0)};
}

TEST_F(SilhouettesGlTest, ABoxHasTheOutlinesOfItsSixSides) {
    constexpr float side = 2.0F;
    const auto driver = panel_driver();
    for (const float offset : {-0.5F, 0.0F}) {
        Panel panel = bordered_panel(noise_tile(16, 16, 21), offset, driver);
        const scene::Mesh box = scene::box_mesh(glm::vec3(side));
        panel.node->get<scene::MeshNode>()->mesh = std::make_shared<const scene::Mesh>(box);
        const auto relief = ReliefPlane::create(
            panel.detail().set->heights.view(),
            {side, panel.detail().scale, panel.detail().offset, Border::discard});
        std::vector<PlacedRelief> reliefs;
        for (std::size_t first = 0; first < box.indices.size(); first += 6) {
            reliefs.push_back({relief.value(), glm::inverse(side_frame(box, first))});
        }
        ASSERT_EQ(reliefs.size(), 6U);
        panel.look({1.7, -3.4, 1.9}, {0.0, 0.0, 0.0});
        const TileErrors found =
            errors_everywhere(panel, reliefs, panel.hits("exact:silhouettes=true"));
        EXPECT_GT(found.pixels, 5000);
        EXPECT_LE(found.wrong_percent(), 0.3) << offset;
        EXPECT_LE(found.depth, 1e-3);
    }
}

// A cube with a relief on each face, in which all is solid beneath the heights of the face that is
// nearest.
class SolidCube {
public:
    SolidCube(const Panel& panel, const scene::Mesh& box, double side)
        : detail_(panel.detail()), side_(side) {
        const auto relief = ReliefPlane::create(
            detail_.set->heights.view(), {side, detail_.scale, detail_.offset, detail_.border});
        for (std::size_t first = 0; first < box.indices.size(); first += 6) {
            faces_.push_back({relief.value(), glm::inverse(side_frame(box, first))});
        }
    }

    // Over one face after the other.
    [[nodiscard]] std::optional<ReliefHit> first_hit(const Ray& ray) const {
        const std::vector<double> ends = changes_along(ray);
        const PlacedRelief* before = nullptr;
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
            const double begin = ends[i];
            const PlacedRelief& face = nearest(ray.at(0.5 * (begin + ends[i + 1])));
            const bool is_next = before != nullptr && before != &face;
            before = &face;
            auto hit = is_next ? wall(face, ray, begin) : std::nullopt;
            if (!hit) {
                hit = face.first_hit({ray.at(begin), ray.direction});
                hit = hit && begin + hit->t <= ends[i + 1] ? hit : std::nullopt;
                if (hit) {
                    hit->t += begin;
                }
            }
            if (hit) {
                return hit;
            }
        }
        return std::nullopt;
    }

private:
    // Where two coordinates are equally far from the middle.
    [[nodiscard]] static std::vector<double> changes_along(const Ray& ray) {
        std::vector<double> ends{0.0, 100.0};
        for (const glm::ivec2 axes : {glm::ivec2(0, 1), {1, 2}, {2, 0}}) {
            for (const double sign : {-1.0, 1.0}) {
                const double away = ray.origin[axes.x] + sign * ray.origin[axes.y];
                const double t = -away / (ray.direction[axes.x] + sign * ray.direction[axes.y]);
                if (t > 0.0 && t < 100.0) {
                    ends.push_back(t);
                }
            }
        }
        std::sort(ends.begin(), ends.end());
        return ends;
    }
    [[nodiscard]] static glm::dvec3 local(const PlacedRelief& face, glm::dvec3 point) {
        return glm::dvec3(face.local_from_world * glm::dvec4(point, 1.0));
    }
    [[nodiscard]] const PlacedRelief& nearest(glm::dvec3 point) const {
        return *std::max_element(faces_.begin(), faces_.end(),
                                 [&](const PlacedRelief& one, const PlacedRelief& other) {
                                     return local(one, point).z < local(other, point).z;
                                 });
    }
    // What a ray meets that comes from over another face.
    [[nodiscard]] std::optional<ReliefHit> wall(const PlacedRelief& face, const Ray& ray,
                                                double t) const {
        const glm::dvec3 at = local(face, ray.at(t));
        ReliefHit hit{{0.5 + at.x / side_, 0.5 - at.y / side_}};
        hit.height = scene::tile_height(*detail_.set, hit.texture_coordinate, detail_.border);
        hit.t = t;
        return at.z < (hit.height + detail_.offset) * detail_.scale * side_ ? std::optional(hit)
                                                                            : std::nullopt;
    }

    const scene::SurfaceDetail& detail_;
    double side_;
    std::vector<PlacedRelief> faces_;
};

struct CubeErrors {
    TileErrors tile;
    int far_off = 0; // nothing, or a thousandth nearer or farther
};

CubeErrors cube_errors(const Panel& panel, const SolidCube& truth, const HitBuffer& hits) {
    CubeErrors errors;
    for (int y = 0; y < hits.rows(); ++y) {
        for (int x = 0; x < hits.cols(); ++x) {
            const Hit& hit = hits(x, y);
            const auto first = truth.first_hit(
                scene::view_ray(panel.scene.camera(), mesh_picture, {x + 0.5, y + 0.5}));
            if (first || !hit.is_sky()) {
                judge(hit, first, panel, errors.tile);
            }
            errors.far_off += first && std::abs(hit.depth / first->t - 1.0) > 1e-3 ? 1 : 0;
        }
    }
    return errors;
}

// Over its edges the faces' heights go on until they meet; where they differ stands a wall.
TEST_F(SilhouettesGlTest, ABoxIsClosedAtItsEdges) {
    RELJEF_RELEASE_ONLY("it is what a shader says");
    constexpr float side = 2.0F;
    const scene::Mesh box = scene::box_mesh(glm::vec3(side));
    Panel panel(noise_tile(16, 16, 21), 1.0F);
    panel.node->get<scene::MeshNode>()->mesh = std::make_shared<const scene::Mesh>(box);
    for (const float offset : {-1.0F, -0.5F, 0.0F}) {
        panel.detail().offset = offset;
        const SolidCube truth(panel, box, side);
        for (const glm::dvec3 eye : {glm::dvec3(1.7, -3.4, 1.9), glm::dvec3(0.2, -3.6, -0.3)}) {
            panel.look(eye, {0.0, 0.0, 0.0});
            const HitBuffer hits = panel.hits("exact:silhouettes=true");
            const CubeErrors found = cube_errors(panel, truth, hits);
            EXPECT_GT(found.tile.pixels, 5000);
            EXPECT_LE(found.tile.wrong_percent(), 0.3) << offset << ' ' << eye.x;
            EXPECT_LE(100.0 * found.far_off / found.tile.pixels, 0.6) << offset << ' ' << eye.x;
        }
    }
}

// Between tetrahedra nothing is lost: a closed shape has no hole, and its outline is a sphere's.
TEST_F(SilhouettesGlTest, CurvedMeshesHaveNoHolesAndTheRadiusOfTheirHeights) {
    const auto driver = panel_driver();
    for (const float height : {0.0F, 0.5F, 1.0F}) {
        Panel panel(Grid<float>(8, 8, height), 4.0F, driver);
        panel.node->get<scene::MeshNode>()->mesh =
            std::make_shared<const scene::Mesh>(scene::sphere_mesh(1.0F, 96));
        panel.detail().offset = 0.0F;
        panel.look({0.0, -4.0, 0.5}, {0.0, 0.0, 0.0});
        const double lift =
            scene::relief_height(*panel.node->get<scene::MeshNode>()->mesh, panel.detail());
        const double radius = 1.0 + static_cast<double>(height) * lift;
        int wrong = 0;
        int shown = 0;
        const HitBuffer hits = panel.hits("exact:silhouettes=true");
        for (int y = 0; y < hits.rows(); ++y) {
            for (int x = 0; x < hits.cols(); ++x) {
                const Ray ray =
                    scene::view_ray(panel.scene.camera(), mesh_picture, {x + 0.5, y + 0.5});
                const double away =
                    glm::length(glm::cross(ray.origin, ray.direction)) / glm::length(ray.direction);
                const bool meets = away < radius;
                const bool near_outline = std::abs(away - radius) < 0.02;
                wrong += !near_outline && meets == hits(x, y).is_sky() ? 1 : 0;
                shown += hits(x, y).is_sky() ? 0 : 1;
            }
        }
        EXPECT_GT(shown, 2000);
        EXPECT_EQ(wrong, 0) << height;
    }
}

TEST_F(SilhouettesGlTest, EveryShapeIsDrawnByEveryTechniqueThatFollowsARay) {
    const std::vector<scene::Mesh> shapes{scene::torus_mesh(1.0F, 0.4F, 24),
                                          scene::cylinder_mesh(1.0F, 2.0F, 24)};
    const auto driver = panel_driver();
    for (const scene::Mesh& shape : shapes) {
        Panel panel(wave_tile(16), 2.0F, driver);
        panel.node->get<scene::MeshNode>()->mesh = std::make_shared<const scene::Mesh>(shape);
        panel.detail().offset = -0.5F;
        panel.look({0.4, -4.0, 2.0}, {0.0, 0.0, 0.0});
        const HitBuffer truth = panel.hits("exact:silhouettes=true");
        for (const std::string technique : {"relief", "cone"}) {
            const HitBuffer hits =
                panel.hits(technique + (technique.find(':') == std::string::npos ? ":" : ",") +
                           "silhouettes=true");
            int differ = 0;
            for (std::size_t i = 0; i < hits.size(); ++i) {
                differ += hits.samples()[i].is_sky() != truth.samples()[i].is_sky() ? 1 : 0;
            }
            EXPECT_LT(differ, 60) << technique;
        }
    }
}

// In a hull the way to the sun is as long as in the plane that touches the mesh.
TEST_F(SilhouettesGlTest, ShadowsAreThoseOfTheRelief) {
    RELJEF_RELEASE_ONLY("it is what a shader says");
    Panel panel(hard_tiles()[4].heights, 3.0F); // cliffs, two metres wide
    panel.detail().offset = -1.0F;
    panel.scene.add_light();
    panel.look({0.3, -2.0, 2.6}, {0.1, 0.0, 0.0}); // no border in sight
    const Image lit = panel.picture("exact");
    const Image plane = panel.picture("exact:shadow=hard");
    const Image hull = panel.picture("exact:silhouettes=true,shadow=hard");
    const auto share_off = [](const Image& one, const Image& other) {
        int off = 0;
        for (std::size_t i = 0; i < one.size(); ++i) {
            off += std::abs(one.samples()[i].g - other.samples()[i].g) > 8 ? 1 : 0;
        }
        return static_cast<double>(off) / static_cast<double>(one.size());
    };
    EXPECT_GT(share_off(plane, lit), 0.1);
    EXPECT_LT(share_off(plane, hull), 0.02); // the square's border
}

// What a pixel covers of the tile is told by the mesh, not by the tetrahedra's sides, however
// flatly these are seen.
TEST_F(SilhouettesGlTest, ColoursAreAsSharpAsOnTheMesh) {
    RELJEF_RELEASE_ONLY("it is what a shader says");
    Panel panel(Grid<float>(8, 8, 0.0F), 4.0F);
    material::ReliefMaterial set;
    set.name = "striped";
    set.heights = Grid<float>(8, 8, 0.0F);
    set.color = Image(32, 32);
    for (std::size_t i = 0; i < set.color.size(); ++i) {
        set.color.samples()[i] =
            i / 8 % 2 == 0 ? Rgba8{230, 230, 230, 255} : Rgba8{20, 20, 20, 255};
    }
    panel.detail().set = std::make_shared<const material::ReliefMaterial>(
        material::completed(std::move(set), WrapMode::wrap).value());
    panel.detail().offset = 0.0F;
    panel.node->get<scene::MeshNode>()->mesh =
        std::make_shared<const scene::Mesh>(scene::sphere_mesh(1.0F, 96));
    panel.look({0.0, -1.6, 0.3}, {0.0, 0.0, 0.1}); // it fills the picture
    const Image mesh = panel.picture("exact");
    const Image hull = panel.picture("exact:silhouettes=true");
    int off = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        off += std::abs(mesh.samples()[i].g - hull.samples()[i].g) > 40 ? 1 : 0;
    }
    EXPECT_LT(off, 5);
}

// Through its opening a bowl shows its back, and that is nothing, however steep its outside is.
TEST_F(SilhouettesGlTest, NothingIsSeenThroughABowlsBack) {
    RELJEF_RELEASE_ONLY("it is what a shader says");
    Panel panel(noise_tile(16, 16, 5), 12.0F);
    panel.node->get<scene::MeshNode>()->mesh =
        std::make_shared<const scene::Mesh>(scene::bowl_mesh(1.0F));
    panel.look({0.0, -2.5, 1.0}, {0.0, 0.0, -0.3});
    const HitBuffer hits = panel.hits("exact:silhouettes=true");
    int through = 0;
    int shown = 0;
    for (int y = 0; y < hits.rows(); ++y) {
        for (int x = 0; x < hits.cols(); ++x) {
            const Ray ray = scene::view_ray(panel.scene.camera(), mesh_picture, {x + 0.5, y + 0.5});
            const glm::dvec3 way = glm::normalize(ray.direction);
            const double nearest = -glm::dot(ray.origin, way);
            const double half = 1.0 - glm::dot(ray.origin, ray.origin) + nearest * nearest;
            const double to_back = std::sqrt(std::max(half, 0.0));
            const double entry = ray.origin.z + (nearest - to_back) * way.z;
            const double exit = ray.origin.z + (nearest + to_back) * way.z;
            if (half > 0.02 && entry > 0.1 && exit < -0.1) { // off the outline and the rim
                ++through;
                shown += hits(x, y).is_sky() ? 0 : 1;
            }
        }
    }
    EXPECT_GT(through, 2000);
    EXPECT_EQ(shown, 0);
}

TEST(HullMesh, NeighboursShareTheirSidesAndPartsWithoutVolumeAreLeftOut) {
    scene::SurfaceDetail detail;
    detail.scale = 0.1F;
    const scene::Mesh plane = scene::plane_mesh(glm::vec2(2.0F));
    EXPECT_EQ(render::hull_parts(plane, detail).size(), 6U);
    double sum = 0.0;
    for (const render::HullPart& part : render::hull_parts(plane, detail)) {
        const auto from_first = [&](std::size_t i) {
            return glm::dvec3(part.corners[i]) - glm::dvec3(part.corners[0]);
        };
        const double volume =
            glm::dot(from_first(1), glm::cross(from_first(2), from_first(3))) / 6.0;
        EXPECT_GT(volume, 0.0);
        sum += volume;
    }
    const double lift = scene::relief_height(plane, detail) * (1.0 + 2.0 * scene::hull_margin);
    EXPECT_NEAR(sum, 4.0 * lift, 1e-6);
    scene::Mesh point = plane;
    std::fill(point.positions.begin(), point.positions.end(), glm::vec3(1.0F));
    EXPECT_TRUE(render::hull_parts(point, detail).empty());
}

// Over a cube they fill the shell, and know which of their sides another face's parts lie beyond.
TEST(HullMesh, FillsTheEdgesOfABox) {
    scene::SurfaceDetail detail;
    detail.scale = 0.1F;
    detail.offset = 0.0F;
    const scene::Mesh box = scene::box_mesh(glm::vec3(2.0F));
    const double lift = scene::relief_height(box, detail);
    double sum = 0.0;
    double parted = 0.0;
    for (const render::HullPart& part : render::hull_parts(box, detail)) {
        const auto from_first = [&](std::size_t i) {
            return glm::dvec3(part.corners[i]) - glm::dvec3(part.corners[0]);
        };
        sum += glm::dot(from_first(1), glm::cross(from_first(2), from_first(3))) / 6.0;
        for (const glm::vec4& normal : part.normals) {
            parted += static_cast<double>(normal.w);
        }
    }
    const double inner = 2.0 - 2.0 * scene::hull_margin * lift;
    const double outer = 2.0 + 2.0 * (1.0 + scene::hull_margin) * lift;
    EXPECT_NEAR(sum, std::pow(outer, 3.0) - std::pow(inner, 3.0), 1e-5);
    EXPECT_EQ(parted, 6.0 * 4.0 * 2.0); // two triangles over each edge of a face
}

} // namespace
} // namespace reljef::truth
