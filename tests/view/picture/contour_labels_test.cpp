#include "engine/view/picture/contour_labels.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/scene/graph/ground_pick.h"
#include "engine/session/streaming.h"
#include "engine/view/select.h"
#include "tests/render/made_scene.h"
#include "tests/scene/streaming/streamed_samples.h"
#include "tests/session/made_session.h"

namespace reljef::view {
namespace {

constexpr glm::ivec2 labelled_picture{800, 600};
constexpr double labelled_interval = 10.0; // 50 m from label to label

// Hills of samples 8 m apart.
struct LabelledHills {
    scene::Scene scene;
    scene::TerrainNode* terrain = nullptr;
    scene::Camera* camera = nullptr;

    explicit LabelledHills(test::SampleSource source = test::SampleSource::memory,
                           double exaggeration = 1.0) {
        scene::TerrainOptions options;
        options.exaggeration = exaggeration;
        terrain = test::add_terrain(
                      scene, test::plane_heightfield(test::hills(257, 225, 150.0), {8.0, 8.0}), {},
                      options)
                      .get<scene::TerrainNode>();
        terrain->contours = labelled_interval;
        test::give_samples(*terrain, source);
        camera = scene.add_camera().get<scene::Camera>();
    }
    [[nodiscard]] const scene::TerrainSurface& surface() const { return *terrain->surface; }
    void look(glm::dvec3 eye, glm::dvec3 target) {
        camera->eye = eye;
        camera->target = target;
    }
    // From somewhere above the ground to somewhere on it.
    void look_anywhere(std::mt19937& random) {
        std::uniform_real_distribution<double> east(-900.0, 900.0);
        std::uniform_real_distribution<double> above(20.0, 1200.0);
        const glm::dvec2 eye(east(random), east(random));
        look({eye, surface().height_at(eye.x, eye.y).value_or(0.0) + above(random)},
             {east(random), east(random), 0.0});
    }
    // Of a view whose tiles are loaded.
    [[nodiscard]] FrameView selected() const {
        FrameView frame = select(scene, labelled_picture);
        while (!frame.requests.empty() && !frame.requests.front().missing.empty()) {
            session::request_tiles(frame.requests);
            EXPECT_TRUE(terrain->stream->wait({}));
            frame = select(scene, labelled_picture);
        }
        return frame;
    }
    [[nodiscard]] ContourLabels labels() const { return contour_labels(selected().list); }
    // True height of the ground under a pixel; NaN: sky.
    [[nodiscard]] double height_under(glm::dvec2 pixel) const {
        const auto hit =
            scene::pick_ground(*terrain, scene::view_ray(*camera, labelled_picture, pixel));
        return hit ? hit->sample.z : std::nan("");
    }
    // Whether the contour of a height crosses the line across a label, within `reach` pixels.
    [[nodiscard]] bool is_crossed(const ContourLabel& label, double height, double reach) const {
        const glm::dvec2 across(-label.along.y, label.along.x);
        double before = std::nan("");
        for (double offset = -reach; offset <= reach; offset += 0.25) {
            const double above = height_under(label.middle + offset * across) - height;
            if (above * before <= 0.0) { // never without ground
                return true;
            }
            before = above;
        }
        return false;
    }
};

class ContourLabelsOfSources : public testing::TestWithParam<test::SampleSource> {};
INSTANTIATE_TEST_SUITE_P(All, ContourLabelsOfSources, test::all_sources(), test::name_of_source);

// The contour passes within what a label may bend.
TEST_P(ContourLabelsOfSources, LieOnTheirVisibleContour) {
    LabelledHills hills(GetParam());
    std::mt19937 random(1);
    int checked = 0;
    constexpr int views = 40;
    for (int i = 0; i < views; ++i) {
        hills.look_anywhere(random);
        const ContourLabels found = hills.labels();
        for (const ContourLabel& label : found.labels) {
            const double height = std::stod(label.text);
            EXPECT_EQ(std::fmod(height, 5.0 * labelled_interval), 0.0) << label.text;
            EXPECT_TRUE(hills.is_crossed(label, height, 0.35 * found.digit_height + 1.0))
                << i << ": " << label.text << " at " << label.middle.x << ", " << label.middle.y;
            ++checked;
        }
    }
    EXPECT_GT(checked, 5 * views);
}

TEST(ContourLabels, AreUprightApartAndInsideThePicture) {
    LabelledHills hills;
    std::mt19937 random(2);
    for (int i = 0; i < 100; ++i) {
        hills.look_anywhere(random);
        const ContourLabels found = hills.labels();
        for (std::size_t a = 0; a < found.labels.size(); ++a) {
            const ContourLabel& label = found.labels[a];
            EXPECT_GE(label.along.x, 0.0);
            EXPECT_NEAR(glm::length(label.along), 1.0, 1e-12);
            EXPECT_GT(label.opacity, 0.0);
            EXPECT_LE(label.opacity, 1.0);
            EXPECT_GT(std::min(label.middle.x, label.middle.y), 0.5 * found.digit_height);
            EXPECT_LT(label.middle.x, labelled_picture.x - 0.5 * found.digit_height);
            EXPECT_LT(label.middle.y, labelled_picture.y - 0.5 * found.digit_height);
            for (std::size_t b = 0; b < a; ++b) {
                EXPECT_GE(glm::distance(label.middle, found.labels[b].middle),
                          8.0 * found.digit_height);
            }
        }
    }
}

// True heights, whatever the exaggeration.
TEST(ContourLabels, NameTrueHeights) {
    for (const double exaggeration : {0.5, 3.0}) {
        LabelledHills hills(test::SampleSource::memory, exaggeration);
        hills.look({0.0, -1400.0, 900.0}, {0.0, 0.0, 0.0});
        const ContourLabels found = hills.labels();
        EXPECT_GT(found.labels.size(), 5U) << exaggeration;
        for (const ContourLabel& label : found.labels) {
            EXPECT_TRUE(hills.is_crossed(label, std::stod(label.text), 0.35 * found.digit_height))
                << label.text;
        }
    }
}

TEST(ContourLabels, AreHiddenByNearerGround) {
    // A slope behind a wall that hides all of it.
    const auto heights = test::made_heights(129, 129, [](int /*col*/, int row) {
        return row > 100 && row < 104 ? 400.0 : std::max(0.0, 4.0 * (90.0 - row));
    });
    scene::Scene scene;
    auto& terrain = *test::add_terrain(scene, test::plane_heightfield(heights, {8.0, 8.0}))
                         .get<scene::TerrainNode>();
    terrain.contours = labelled_interval;
    auto& camera = *scene.add_camera(test::camera_at({0.0, -500.0, 60.0}, {0.0, 0.0, 60.0}))
                        .get<scene::Camera>();
    const auto farthest = [&] {
        double y = -1e9;
        for (const auto& label : contour_labels(select(scene, labelled_picture).list).labels) {
            const auto hit = scene::pick_ground(
                terrain, scene::view_ray(camera, labelled_picture, label.middle));
            EXPECT_NEAR(hit.value_or(scene::GroundHit{}).sample.z, std::stod(label.text), 10.0);
            y = std::max(y, hit.value_or(scene::GroundHit{}).world.y);
        }
        return y;
    };
    EXPECT_LT(farthest(), -280.0);
    camera.eye.z = 900.0;
    EXPECT_GT(farthest(), -200.0);
}

TEST(ContourLabels, KeepTheirPlacesWhileTheViewTurns) {
    LabelledHills hills;
    hills.look({0.0, -1400.0, 700.0}, {0.0, 0.0, 0.0});
    const auto places_of = [&] {
        std::vector<glm::dvec3> places;
        for (const ContourLabel& label : hills.labels().labels) {
            const auto hit = scene::pick_ground(
                *hills.terrain, scene::view_ray(*hills.camera, labelled_picture, label.middle));
            places.push_back(hit.value_or(scene::GroundHit{}).world);
        }
        return places;
    };
    const auto before = places_of();
    ASSERT_GT(before.size(), 10U);
    hills.look({5.0, -1395.0, 700.0}, {20.0, 0.0, 0.0});
    const auto after = places_of();
    const auto kept = std::ranges::count_if(before, [&](glm::dvec3 place) {
        return std::ranges::any_of(
            after, [&](glm::dvec3 other) { return glm::distance(place, other) < 25.0; });
    });
    EXPECT_GE(kept, static_cast<std::ptrdiff_t>(before.size() * 3 / 4));
}

TEST(ContourLabels, AreThereOnlyWithContoursThatPicturesShow) {
    LabelledHills hills;
    hills.look({0.0, -1400.0, 900.0}, {0.0, 0.0, 0.0});
    EXPECT_FALSE(hills.labels().labels.empty());
    hills.terrain->labels_contours = false;
    EXPECT_TRUE(hills.labels().labels.empty());
    hills.terrain->labels_contours = true;
    hills.terrain->hides_overlay = true;
    EXPECT_TRUE(hills.labels().labels.empty());
    hills.terrain->hides_overlay = false;
    hills.terrain->contours = 0.0;
    EXPECT_TRUE(hills.labels().labels.empty());
    hills.terrain->contours = labelled_interval;
    hills.terrain->material.technique = scene::Technique{scene::Texture{}};
    EXPECT_TRUE(hills.labels().labels.empty());
}

// Level ground, two rows of samples, an eye in the ground, and lines closer than pixels end soon.
TEST(ContourLabels, OddTerrainsHaveNone) {
    for (const auto& heights : {Grid<float>(65, 65, 50.0F), Grid<float>(2, 2, 0.0F)}) {
        scene::Scene scene;
        auto& terrain = *test::add_terrain(scene, test::plane_heightfield(heights, {8.0, 8.0}))
                             .get<scene::TerrainNode>();
        terrain.contours = labelled_interval;
        scene.add_camera(test::camera_at({0.0, -300.0, 200.0}, {0.0, 0.0, 0.0}));
        EXPECT_TRUE(contour_labels(select(scene, labelled_picture).list).labels.empty());
    }
    LabelledHills hills;
    hills.look({0.0, 0.0, -500.0}, {0.0, 100.0, -500.0});
    static_cast<void>(hills.labels());
    hills.look({0.0, -1400.0, 900.0}, {0.0, 0.0, 0.0});
    hills.terrain->contours = scene::min_contours;
    EXPECT_TRUE(hills.labels().labels.empty());
}

// A smaller picture that will be enlarged has the labels of the large one.
TEST(ContourLabels, OfAMagnifiedPictureAreThoseOfTheLargeOne) {
    LabelledHills hills;
    hills.look({0.0, -1400.0, 900.0}, {0.0, 0.0, 0.0});
    const ContourLabels large = hills.labels();
    const ContourLabels small = contour_labels(select(hills.scene, labelled_picture / 2).list, 2.0);
    EXPECT_DOUBLE_EQ(2.0 * small.digit_height, large.digit_height);
    ASSERT_EQ(small.labels.size(), large.labels.size());
    for (std::size_t i = 0; i < small.labels.size(); ++i) {
        EXPECT_EQ(small.labels[i].text, large.labels[i].text);
        EXPECT_LT(glm::distance(2.0 * small.labels[i].middle, large.labels[i].middle), 0.1);
    }
}

} // namespace
} // namespace reljef::view
