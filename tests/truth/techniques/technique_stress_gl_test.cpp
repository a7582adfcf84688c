// Every technique with every option where such things break: flat and steep views, absurd scales,
// an eye in the ground, narrow and wide lenses. Small pictures, always finite.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "tests/scene/technique/terrain_techniques.h"
#include "tests/support/release_only.h"
#include "tests/terrain/chance.h"
#include "tests/truth/techniques/relief_stage.h"

namespace reljef::truth {
namespace {

using test::ReliefStage;

constexpr glm::ivec2 small{48, 36};

class TechniqueStressGlTest : public test::GlTest {};

test::ReliefSetting small_setting() {
    return {.spacing = {2.0, 2.0}, .light = scene::Light{}, .size = small};
}

bool all_finite(const HitBuffer& hits) {
    return std::all_of(hits.samples().begin(), hits.samples().end(), [](const Hit& hit) {
        return hit.is_sky() || std::isfinite(hit.col + hit.row + hit.height + hit.depth);
    });
}

// Every technique as it is, and with all options that a terrain takes.
std::vector<std::string> techniques_with_and_without() {
    std::vector<std::string> all;
    for (const scene::TechniqueInfo& info : scene::terrain_techniques()) {
        scene::Technique technique = scene::make_technique(info.id);
        all.push_back(to_string(technique));
        for (const scene::OptionInfo& option : scene::options_of(info.id)) {
            technique.options.steps =
                option.name == "steps" ? scene::StepRange{} : technique.options.steps;
            technique.options.fade =
                option.name == "fade" ? scene::Fade{0.0, 1.0, 2.0} : technique.options.fade;
            technique.options.shadow =
                option.name == "shadow" ? scene::Shadow{0.2} : technique.options.shadow;
            technique.options.smooth_edges =
                option.name == "edges" ? scene::SmoothEdges{0.05} : technique.options.smooth_edges;
            if (option.name == "depth") {
                technique.options.depth = scene::HitDepth::write;
            }
        }
        if (technique.options != scene::TechniqueOptions{}) {
            all.push_back(to_string(technique));
        }
    }
    return all;
}

void expect_finite(ReliefStage& stage, const std::string& technique, const std::string& where) {
    EXPECT_TRUE(all_finite(stage.hits(technique))) << technique << ' ' << where;
    EXPECT_EQ(stage.image(technique).cols(), small.x);
}

struct Place {
    std::string name;
    scene::Camera camera;
};

// From an elevation above the horizon, degrees.
scene::Camera at_elevation(double elevation) {
    const double a = glm::radians(elevation);
    return test::camera_at({0.0, -200.0 * std::cos(a), 200.0 * std::sin(a)}, {0.0, 0.0, 0.0});
}

std::vector<Place> grazing_places() {
    std::vector<Place> places;
    for (const double elevation : {90.0, 45.0, 10.0, 1.0, 0.1, 0.01}) {
        places.push_back({fmt::format("{} degrees", elevation), at_elevation(elevation)});
    }
    return places;
}

std::vector<Place> hard_places() {
    std::vector<Place> places;
    places.push_back({"in the ground", test::camera_at({3.0, 5.0, -9.0}, {40.0, 60.0, -9.5})});
    places.push_back({"under all of it", test::camera_at({3.0, 5.0, -40.0}, {40.0, 60.0, 0.0})});
    places.push_back({"on a sample", test::camera_at({0.0, 0.0, 1.0}, {10.0, 10.0, 0.0})});
    places.push_back({"straight up", scene::camera_from_angles({3.0, 5.0, -9.0}, 0.0, 90.0)});
    places.push_back({"straight down", scene::camera_from_angles({3.0, 5.0, 90.0}, 0.0, -90.0)});
    places.push_back({"level", scene::camera_from_angles({3.0, 5.0, 8.0}, 30.0, 0.0)});
    for (const double fov : {1e-3, 179.0}) {
        scene::Camera camera = at_elevation(30.0);
        camera.vertical_fov = fov;
        places.push_back({fmt::format("{} degrees wide", fov), camera});
    }
    return places;
}

TEST_F(TechniqueStressGlTest, AnyViewIsFinite) {
    ReliefStage stage(test::hills(65, 65, 12.0), small_setting());
    std::vector<Place> places = grazing_places();
    for (Place& place : hard_places()) {
        places.push_back(std::move(place));
    }
    for (const std::string& technique : techniques_with_and_without()) {
        for (const Place& place : places) {
            stage.look(place.camera);
            expect_finite(stage, technique, place.name);
        }
    }
}

TEST_F(TechniqueStressGlTest, ExactIsTrueAtAnyAngleAndFromAnyPlace) {
    ReliefStage stage(test::hills(65, 65, 12.0), {.size = {160, 120}});
    for (const auto& places : {grazing_places(), hard_places()}) {
        for (const Place& place : places) {
            stage.look(place.camera);
            EXPECT_LE(test::elsewhere_percent(stage.hits("exact"), stage.true_hits()), 0.1)
                << place.name;
        }
    }
}

TEST_F(TechniqueStressGlTest, AnyExaggerationIsFinite) {
    for (const double exaggeration : {1e-6, 1e-3, 1e3, 1e6}) {
        test::ReliefSetting setting = small_setting();
        setting.exaggeration = exaggeration;
        ReliefStage stage(test::hills(33, 33, 12.0), setting);
        for (const char* technique :
             {"parallax:fade=0..1", "relief:steps=8..32,fade=0..1,2,shadow=hard,edges=smooth",
              "pom:depth=write", "interval:shadow=soft",
              "exact:fade=0..1,shadow=soft,edges=smooth,depth=write", "exact:shadow=hard"}) {
            for (const scene::Pose pose : {scene::Pose::overview, scene::Pose::low}) {
                stage.look(pose);
                expect_finite(stage, technique, fmt::format("{}", exaggeration));
            }
        }
    }
}

// Any options that go with a technique.
scene::TechniqueOptions any_options(scene::TechniqueId id, test::Chance& chance) {
    scene::TechniqueOptions options;
    for (const scene::OptionInfo& option : scene::options_of(id)) {
        if (chance.one_in(2)) {
            continue;
        }
        if (option.name == "steps") {
            options.steps = scene::StepRange{4, chance.whole(4, 40)};
        } else if (option.name == "fade") {
            options.fade = scene::Fade{chance.between(0.0, 0.5), 1.0, chance.between(1.0, 5.0)};
        } else if (option.name == "shadow") {
            options.shadow = scene::Shadow{chance.one_in(2) ? 0.0 : chance.between(0.01, 1.0)};
        } else if (option.name == "edges") {
            options.smooth_edges = scene::SmoothEdges{chance.between(0.001, 0.2)};
        } else if (option.name == "depth") {
            options.depth = scene::HitDepth::write;
        }
    }
    return options;
}

bool same_hits(const HitBuffer& a, const HitBuffer& b) {
    return std::equal(a.samples().begin(), a.samples().end(), b.samples().begin(),
                      [](const Hit& x, const Hit& y) {
                          return x.col == y.col && x.row == y.row && x.depth == y.depth;
                      });
}

TEST_F(TechniqueStressGlTest, AnyOptionsGoTogetherAndShadingMovesNoHit) {
    ReliefStage stage(test::hills(65, 65, 12.0), small_setting());
    test::Chance chance(11);
    const auto catalogue = scene::terrain_techniques();
    for (int i = 0; i < test::cases(30, 60); ++i) {
        const auto index = chance.whole(0, static_cast<int>(catalogue.size()) - 1);
        scene::Technique technique =
            scene::make_technique(catalogue[static_cast<std::size_t>(index)].id);
        technique.options = any_options(technique.id(), chance);
        const std::string text = to_string(technique);
        stage.look(scene::camera_from_angles(
            {chance.between(-60.0, 60.0), chance.between(-60.0, 60.0), chance.between(0.0, 60.0)},
            chance.between(0.0, 360.0), chance.between(-80.0, 5.0)));
        expect_finite(stage, text, "by chance");
        technique.options.shadow.reset();
        technique.options.smooth_edges.reset();
        technique.options.depth = scene::HitDepth::objects;
        EXPECT_TRUE(same_hits(stage.hits(text), stage.hits(to_string(technique)))) << text;
    }
}

} // namespace
} // namespace reljef::truth
